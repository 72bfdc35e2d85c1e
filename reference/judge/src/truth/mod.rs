//! The exact answers to a claim, and what shows that one of them is right; [`answers`] are those to
//! every volume that a strategy compares.

pub mod answers;
pub mod compare;
pub mod naive;
pub mod reference_shapes;

pub use answers::{Answers, Predicate};
pub use compare::{ListCount, compare};
pub use reference_shapes::Shapes;

use sdop_reference as reference;
use sdop_reference::exact::common::{self, Point};
use sdop_reference::exact::{meeting, ordop, period, sphere};
use sdop_reference::{WidePose, wide};

use reference_shapes::{InvalidInput, body, slabs};

use crate::case::Frame;
use crate::claim::Claim;
use crate::contestant::WorldBox;
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
        Ok(Self { claim, shapes: shapes.collect::<Result<_, _>>()? })
    }

    /// What it decides.
    #[must_use]
    pub fn claim(&self) -> Claim {
        self.claim
    }

    /// Whether the claim holds of two bodies of a frame. For bodies with parts, it has to hold of
    /// any part of one and any part of the other: of their balls for the claim `sphere`, of their
    /// meshes for others about posed shapes.
    ///
    /// # Errors
    /// A pose outside the contract.
    pub fn pair(&self, frame: &Frame, [i, j]: [u32; 2]) -> Result<bool, InvalidInput> {
        if let Some(meet) = self.by_boxes(frame, [i, j]) {
            return Ok(meet);
        }
        let has_parts =
            |body: u32| frame.parts.as_ref().is_some_and(|p| !p[body as usize].is_empty());
        if has_parts(i) || has_parts(j) {
            return Ok(self.meeting_parts(frame, [i, j])?.is_some());
        }
        let (a, b) = (self.body(frame, i)?, self.body(frame, j)?);
        Ok(match self.claim {
            Claim::Sphere => sphere::overlap(&a, &b).value,
            Claim::OrDop => ordop::overlap(&a, &b, reference::Overlap::Full).value,
            _ => {
                let [one, other] = [&a, &b].map(|body| (body.shape, body.pose.translation()));
                near(one, other) && meeting::overlap(&a, &b).meets
            }
        })
    }

    /// The first parts of two bodies of which the claim holds.
    fn meeting_parts(
        &self,
        frame: &Frame,
        pair: [u32; 2],
    ) -> Result<Option<[PosedPart<'_>; 2]>, InvalidInput> {
        let posed = |i: u32| -> Result<Vec<PosedPart<'_>>, InvalidInput> {
            let parts = frame.posed_parts(i as usize)?.into_iter();
            Ok(parts.map(|(shape, pose)| (&self.shapes[shape as usize], pose)).collect())
        };
        let (first, second) = (posed(pair[0])?, posed(pair[1])?);
        for a in &first {
            for b in &second {
                let (one, other) = ((a.0, &a.1), (b.0, &b.1));
                let meet = match self.claim {
                    Claim::Sphere => wide::balls_overlap(one, other).value,
                    _ => {
                        near((a.0, a.1.translation()), (b.0, b.1.translation()))
                            && wide::meet(one, other).meets
                    }
                };
                if meet {
                    return Ok(Some([*a, *b]));
                }
            }
        }
        Ok(None)
    }

    /// What the given boxes decide; `None` for a claim about posed shapes.
    fn by_boxes(&self, frame: &Frame, pair: [u32; 2]) -> Option<bool> {
        let [a, b] = pair.map(|body| &frame.boxes[body as usize]);
        let margins = || pair.map(|body| frame.margins.as_ref().map_or(0.0, |m| m[body as usize]));
        match self.claim {
            Claim::Aabb | Claim::Order | Claim::Restore => Some(boxes_meet(a, b)),
            Claim::Filter => Some(boxes_meet(a, b) && !self.parts(frame, pair)),
            Claim::Margin => Some(boxes_near(a, b, margins())),
            Claim::Periodic => Some(!images(a, b, frame.periods.unwrap_or_default()).is_empty()),
            Claim::Sphere | Claim::OrDop | Claim::Hull | Claim::Mesh | Claim::Parts => None,
        }
    }

    /// Whether the frame's filter parts a pair i < j, so that it must not be reported.
    #[must_use]
    pub fn parts(&self, frame: &Frame, pair: [u32; 2]) -> bool {
        let filter = frame.filter.as_ref().filter(|_| self.claim == Claim::Filter);
        filter.is_some_and(|filter| filter.parts(pair))
    }

    /// The pairs i < j of a frame, not both static, of which the claim holds, sorted.
    ///
    /// # Errors
    /// A pose outside the contract.
    pub fn pairs(&self, frame: &Frame) -> Result<Vec<[u32; 2]>, InvalidInput> {
        let mut pairs = Vec::new();
        let mut decide = |pair| -> Result<(), InvalidInput> {
            pairs.extend(self.pair(frame, pair)?.then_some(pair));
            Ok(())
        };
        match self.bounds(frame) {
            Some(bounds) => near_pairs(&bounds).into_iter().try_for_each(|pair| {
                let moves = pair.iter().any(|&body| frame.bodies.dynamic[body as usize]);
                if moves { decide(pair) } else { Ok(()) }
            })?,
            None => {
                let mut all = reference::broad_phase::all_pairs(&frame.bodies.dynamic);
                all.try_for_each(|(i, j)| decide([i, j]))?;
            }
        }
        pairs.sort_unstable();
        Ok(pairs)
    }

    /// For a large set, intervals along each axis; those of bodies that meet overlap.
    /// They only save time. `None` for a small set, and where boxes have images.
    fn bounds(&self, frame: &Frame) -> Option<Vec<[[f64; 2]; 3]>> {
        let has_periods = frame.periods.is_some_and(|periods| periods != [None; 3]);
        if frame.bodies.len() < LARGE || has_periods {
            return None;
        }
        let of_parts = |i: usize| {
            let parts = frame.parts.as_ref().map_or(&[][..], |parts| &parts[i]);
            parts.iter().map(|part| {
                let offset = part.rotation_and_translation().1;
                reach(&self.shapes[part.shape as usize])
                    + 2.0 * offset.map(f64::abs).iter().sum::<f64>()
            })
        };
        let bound = |i: usize| {
            let shape = &self.shapes[frame.bodies.shape[i] as usize];
            let reach = of_parts(i).fold(reach(shape), f64::max);
            let margin = 2.0 * f64::from(frame.margins.as_ref().map_or(0.0, |margins| margins[i]));
            [0, 1, 2].map(|axis| match self.claim.is_of_boxes() {
                true => {
                    let [lo, hi] = [axis, axis + 3].map(|end| f64::from(frame.boxes[i][end]));
                    [lo - margin, hi + margin]
                }
                false => {
                    let t = f64::from(frame.bodies.translation[i][axis]);
                    [t - reach, t + reach]
                }
            })
        };
        Some((0..frame.bodies.len()).map(bound).collect())
    }

    /// A point that both bodies share; `None` when the claim doesn't hold of them. In space that
    /// repeats, it is a point of the first body and of an image of the second.
    #[must_use]
    pub fn common_point(&self, frame: &Frame, [i, j]: [u32; 2]) -> Option<Point> {
        if self.claim.is_of_boxes() {
            let (a, b) = (&frame.boxes[i as usize], &frame.boxes[j as usize]);
            if let (Claim::Periodic, Some(periods)) = (self.claim, frame.periods) {
                return period::common_point(corners(a), corners(b), periods);
            }
            // Boxes within their margins need not share any.
            return boxes_meet(a, b).then(|| Point::of([0, 1, 2].map(|axis| a[axis].max(b[axis]))));
        }
        if frame.parts.is_some() {
            let [a, b] = self.meeting_parts(frame, [i, j]).ok()??;
            return wide::common_point((a.0, &a.1), (b.0, &b.1));
        }
        let (a, b) = (self.body(frame, i).ok()?, self.body(frame, j).ok()?);
        match self.claim {
            Claim::Sphere => common::of_balls(&a, &b),
            Claim::OrDop => common::of_slabs(&a, &b),
            _ => common::of_meshes(&a, &b),
        }
    }

    fn body(&self, frame: &Frame, i: u32) -> Result<reference::Body<'_>, InvalidInput> {
        body(&self.shapes, &frame.bodies, i as usize)
    }
}

/// A part's shape and its exact pose in the world.
type PosedPart<'a> = (&'a reference::Shape, WidePose);

/// Closed boxes share a point: no rounding in it.
#[must_use]
pub fn boxes_meet(a: &WorldBox, b: &WorldBox) -> bool {
    (0..3).all(|axis| a[axis] <= b[axis + 3] && b[axis] <= a[axis + 3])
}

/// The numbers of periods along each axis by which the second of two closed boxes is moved where
/// it shares a point with the first one, in exact arithmetic.
#[must_use]
pub fn images(a: &WorldBox, b: &WorldBox, periods: [Option<f64>; 3]) -> Vec<[i64; 3]> {
    period::meeting_images(corners(a), corners(b), periods)
}

fn corners(ends: &WorldBox) -> [[f64; 3]; 2] {
    let [x0, y0, z0, x1, y1, z1] = ends.map(f64::from);
    [[x0, y0, z0], [x1, y1, z1]]
}

/// Closed boxes, each grown by a margin in real arithmetic, share a point.
#[must_use]
pub fn boxes_near(a: &WorldBox, b: &WorldBox, [by_a, by_b]: [f32; 2]) -> bool {
    let apart = |lo: f32, hi: f32| is_positive([lo, -hi, -by_a, -by_b]);
    (0..3).all(|axis| !apart(a[axis], b[axis + 3]) && !apart(b[axis], a[axis + 3]))
}

/// Whether a sum is above zero, decided exactly: as an expansion of f64, in which no sum of f32
/// overflows or underflows (Shewchuk's, smallest part first).
fn is_positive(terms: [f32; 4]) -> bool {
    let mut parts: Vec<f64> = Vec::new();
    for term in terms {
        let mut sum = f64::from(term);
        for part in &mut parts {
            let (x, y) = (sum, *part);
            sum = x + y;
            let of_y = sum - x;
            *part = (x - (sum - of_y)) + (y - of_y);
        }
        parts.push(sum);
    }
    let leading = parts.iter().rev().find(|part| **part != 0.0);
    leading.is_some_and(|part| *part > 0.0)
}

/// Can two meshes meet at all? Not when their origins are further apart than corners of cubes of
/// both reaches are; the rounding is in the factor 1.75, which is above √3.
fn near((a, ta): (&reference::Shape, [f64; 3]), (b, tb): (&reference::Shape, [f64; 3])) -> bool {
    let reach = 1.75 * (a.mesh().reach + b.mesh().reach);
    let apart = [0, 1, 2].map(|axis| (ta[axis] - tb[axis]).abs());
    let square = apart.iter().map(|x| x * x).sum::<f64>();
    // Squares of the least and the greatest sizes are not finite numbers.
    let is_sound = (1e-100..1e100).contains(&square) && (1e-100..1e100).contains(&(reach * reach));
    apart.iter().all(|x| *x <= reach) && (!is_sound || square <= reach * reach)
}

/// Bodies of a set in which not every pair is decided exactly.
const LARGE: usize = 2048;

/// The pairs i < j whose intervals have a point in common along each axis.
fn near_pairs(bounds: &[[[f64; 2]; 3]]) -> Vec<[u32; 2]> {
    let mut order: Vec<usize> = (0..bounds.len()).collect();
    order.sort_by(|&a, &b| bounds[a][0][0].total_cmp(&bounds[b][0][0]));
    let mut pairs = Vec::new();
    for (at, &i) in order.iter().enumerate() {
        for &j in order[at + 1..].iter().take_while(|&&j| bounds[j][0][0] <= bounds[i][0][1]) {
            let meet = |axis: usize| {
                let [[lo, hi], [other_lo, other_hi]] = [i, j].map(|body: usize| bounds[body][axis]);
                lo <= other_hi && other_lo <= hi
            };
            if meet(1) && meet(2) {
                pairs.push([i.min(j) as u32, i.max(j) as u32]);
            }
        }
    }
    pairs
}

/// No point of a shape, whichever volume is meant, is further from its origin along an axis.
fn reach(shape: &reference::Shape) -> f64 {
    let ball = &shape.ball;
    let [x, y, z] = ball.centre.map(|x| f64::from(x.abs()));
    let ball = x + y + z + f64::from(ball.radius);
    // Slab ends are in lengths of the basis vectors.
    let basis = shape.slabs.basis[0].map(f64::from);
    let length = basis.iter().map(|x| x * x).sum::<f64>().sqrt();
    let ends = shape.slabs.lo.iter().chain(&shape.slabs.hi).map(|end| f64::from(end.abs()));
    let slabs = ends.fold(0.0, f64::max) / length;
    2.0 * ball.max(slabs).max(shape.mesh().reach) // a cube's corner is √3 times as far
}

/// The numbers that a claim is about; or-DOPs are expensive to prepare and left trivial for the
/// others.
fn judged(claim: Claim, shape: &Shape) -> Result<reference::Shape, InvalidInput> {
    let ball = reference::Ball { centre: shape.ball.centre, radius: shape.ball.radius };
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
    (0..n).flat_map(|i| (i..n).map(move |j| [0, i, j])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_exact_to_one_bit() {
        let tiny = f32::from_bits(1);
        for (terms, positive) in [
            ([1.0, -1.0, 0.0, 0.0], false),
            ([1.0, tiny, -1.0, 0.0], true),
            ([1.0, -tiny, -1.0, 0.0], false),
            ([f32::MAX, 1.0, -f32::MAX, -1.0_f32.next_down()], true),
            ([f32::MAX, tiny, -1.0, -f32::MAX], false),
            ([0.1, 0.2, -0.3, 0.0], f64::from(0.1_f32) + f64::from(0.2_f32) > f64::from(0.3_f32)),
            ([0.0; 4], false),
        ] {
            assert_eq!(is_positive(terms), positive, "{terms:?}");
            assert!(!positive || !is_positive(terms.map(|x| -x)), "{terms:?}");
        }
    }

    /// At their margins' distance boxes are near, one ulp further they are not.
    #[test]
    fn margins_have_their_exact_reach() {
        let first = [0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        let beside = |x: f32| [x, 0.0, 0.0, x + 1.0, 1.0, 1.0];
        let margins = [0.25, 0.5];
        assert!(boxes_near(&first, &beside(1.75), margins));
        assert!(!boxes_near(&first, &beside(1.75_f32.next_up()), margins));
        // 0.1 and 0.2 reach less far than their rounded sum does.
        let exact = f64::from(0.1_f32) + f64::from(0.2_f32);
        let rounded = 0.1_f32 + 0.2;
        let from_zero = [-1.0, 0.0, 0.0, 0.0, 1.0, 1.0];
        let near = boxes_near(&from_zero, &beside(rounded), [0.1, 0.2]);
        assert_eq!(near, f64::from(rounded) <= exact);
    }

    /// In a large set, of which not every pair is decided, or-DOPs of a short basis meet as alone.
    #[test]
    fn large_sets_have_the_pairs_of_small_ones() -> Result<(), InvalidInput> {
        let slabs = reference::Slabs {
            directions: reference::DirectionSet::K6,
            basis: [[0.25, 0.0, 0.0], [0.0, 0.25, 0.0], [0.0, 0.0, 0.25]],
            lo: vec![-0.25; 3],
            hi: vec![0.25; 3],
        };
        let ball = reference::Ball { centre: [0.0; 3], radius: 0.0 };
        let shape = reference::Shape::new(ball, slabs, vec![[0.0; 3]; 3], vec![[0, 1, 2]])?;
        let mut bodies = sdop::bodies::Bodies::default();
        for i in 0..LARGE {
            bodies.push(
                0,
                true,
                [0.0, 0.0, 0.0, 1.0],
                [if i < 2 { 2.0 } else { 8.0 } * i as f32, 0.0, 0.0],
            );
        }
        let frame = Frame { bodies, boxes: vec![[0.0; 6]; LARGE], ..Frame::default() };
        let truth = Truth { claim: Claim::OrDop, shapes: vec![shape] };
        assert!(truth.pair(&frame, [0, 1])?);
        assert_eq!(truth.pairs(&frame)?, [[0, 1]]);
        Ok(())
    }
}
