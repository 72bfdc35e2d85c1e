//! The exact answers to a claim, and what shows that one of them is right.

use sdop_reference as reference;
use sdop_reference::exact::common::{self, Point};
use sdop_reference::exact::{meeting, ordop, sphere};

use super::case::Frame;
use super::claim::Claim;
use crate::contestant::WorldBox;
use crate::ours::judged::{InvalidInput, slabs};
use sdop::volume::{Hull, Shape};

/// Judges pairs of one claim.
#[derive(Clone, Debug)]
pub struct Truth {
    claim: Claim,
    shapes: Vec<reference::Shape>,
}

impl Truth {
    /// Takes over the shapes' numbers.
    ///
    /// # Errors
    /// Numbers that the reference refuses.
    pub fn new(claim: Claim, shapes: &[Shape]) -> Result<Self, InvalidInput> {
        let shapes = shapes.iter().map(|shape| judged(claim, shape));
        Ok(Self {
            claim,
            shapes: shapes.collect::<Result<_, _>>()?,
        })
    }

    /// Whether the claim holds of two bodies of a frame.
    ///
    /// # Errors
    /// A pose outside the contract.
    pub fn pair(&self, frame: &Frame, [i, j]: [u32; 2]) -> Result<bool, InvalidInput> {
        if self.claim == Claim::Aabb {
            return Ok(boxes_meet(
                &frame.boxes[i as usize],
                &frame.boxes[j as usize],
            ));
        }
        let (a, b) = (self.body(frame, i)?, self.body(frame, j)?);
        Ok(match self.claim {
            Claim::Sphere => sphere::overlap(&a, &b).value,
            Claim::OrDop => ordop::overlap(&a, &b, reference::Overlap::Full).value,
            Claim::Hull | Claim::Mesh => near(&a, &b) && meeting::overlap(&a, &b).meets,
            Claim::Aabb => false, // above
        })
    }

    /// The pairs i < j of a frame, not both static, of which the claim holds, sorted.
    ///
    /// # Errors
    /// A pose outside the contract.
    pub fn pairs(&self, frame: &Frame) -> Result<Vec<[u32; 2]>, InvalidInput> {
        let mut pairs = Vec::new();
        for (i, j) in reference::broad_phase::all_pairs(&frame.bodies.dynamic) {
            if self.pair(frame, [i, j])? {
                pairs.push([i, j]);
            }
        }
        Ok(pairs)
    }

    /// A point that both bodies share; `None` when the claim doesn't hold of them.
    #[must_use]
    pub fn common_point(&self, frame: &Frame, [i, j]: [u32; 2]) -> Option<Point> {
        if self.claim == Claim::Aabb {
            let (a, b) = (&frame.boxes[i as usize], &frame.boxes[j as usize]);
            return boxes_meet(a, b).then(|| Point::of([0, 1, 2].map(|axis| a[axis].max(b[axis]))));
        }
        let (a, b) = (self.body(frame, i).ok()?, self.body(frame, j).ok()?);
        match self.claim {
            Claim::Sphere => common::of_balls(&a, &b),
            Claim::OrDop => common::of_slabs(&a, &b),
            Claim::Hull | Claim::Mesh => common::of_meshes(&a, &b),
            Claim::Aabb => None,
        }
    }

    fn body(&self, frame: &Frame, i: u32) -> Result<reference::Body<'_>, InvalidInput> {
        let (bodies, i) = (&frame.bodies, i as usize);
        Ok(reference::Body {
            shape: &self.shapes[bodies.shape[i] as usize],
            pose: reference::Pose::new(bodies.rotation[i], bodies.translation[i])?,
            dynamic: bodies.dynamic[i],
        })
    }
}

/// Closed boxes share a point: no rounding in it.
#[must_use]
pub fn boxes_meet(a: &WorldBox, b: &WorldBox) -> bool {
    (0..3).all(|axis| a[axis] <= b[axis + 3] && b[axis] <= a[axis + 3])
}

/// Can two meshes meet at all? Not when their origins are further apart than both reaches on some
/// axis; √3 and the ulps are in the factor 2.
fn near(a: &reference::Body<'_>, b: &reference::Body<'_>) -> bool {
    let (ta, tb) = (a.pose.translation(), b.pose.translation());
    let reach = 2.0 * (a.shape.mesh().reach + b.shape.mesh().reach);
    (0..3).all(|axis| (ta[axis] - tb[axis]).abs() <= reach)
}

/// The numbers that a claim is about; or-DOPs are expensive to prepare and left trivial for the
/// others.
fn judged(claim: Claim, shape: &Shape) -> Result<reference::Shape, InvalidInput> {
    let ball = reference::Ball {
        centre: shape.ball.centre,
        radius: shape.ball.radius,
    };
    let slabs = match claim {
        Claim::OrDop => slabs(&shape.ordop, 0.0),
        _ => reference::Slabs {
            directions: reference::DirectionSet::K6,
            basis: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            lo: vec![0.0; 3],
            hi: vec![0.0; 3],
        },
    };
    let triangles = match claim {
        Claim::Hull => hull_triangles(shape),
        _ => shape.triangles.clone(),
    };
    let vertices = shape.vertices.clone();
    reference::Shape::new(ball, slabs, vertices, triangles)
}

/// A closed surface around the hull. Coplanar vertices have a hull without an inside: every point
/// of it is in a triangle with the first vertex (Carathéodory).
fn hull_triangles(shape: &Shape) -> Vec<[u32; 3]> {
    let hull = Hull::of(&shape.vertices);
    if !hull.facets.is_empty() {
        return hull.facets;
    }
    let n = shape.vertices.len() as u32;
    (0..n)
        .flat_map(|i| (i..n).map(move |j| [0, i, j]))
        .collect()
}
