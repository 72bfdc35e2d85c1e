//! The culler's shapes and bodies as the reference takes them: plain numbers, nothing shared.

use sdop_reference as reference;

use crate::scene::bodies::Bodies;
use crate::scene::settings::Overlap;
use crate::volume::{DirectionSet, Hull, OrDop, Shape};

/// What the reference refuses to judge.
pub use reference::InvalidInput;

/// Shapes as the culler and as the reference knows them, in one order.
#[derive(Clone, Debug)]
pub struct Shapes {
    /// As built.
    pub built: Vec<Shape>,
    /// The same numbers for the reference, with each shape's oriented box.
    pub judged: Vec<reference::Shape>,
}

impl Shapes {
    /// Hands every shape's numbers to the reference.
    ///
    /// # Errors
    /// Numbers that the reference refuses: a shape that [`Shape::build`] made has none.
    pub fn new(built: Vec<Shape>) -> Result<Self, InvalidInput> {
        let judged = built.iter().map(shape).collect::<Result<_, _>>()?;
        Ok(Self { built, judged })
    }

    /// The bodies as the reference takes them.
    ///
    /// # Errors
    /// A pose outside the contract.
    pub fn bodies(&self, bodies: &Bodies) -> Result<Vec<reference::Body<'_>>, InvalidInput> {
        (0..bodies.len())
            .map(|i| {
                Ok(reference::Body {
                    shape: &self.judged[bodies.shape[i] as usize],
                    pose: reference::Pose::new(bodies.rotation[i], bodies.translation[i])?,
                    dynamic: bodies.dynamic[i],
                })
            })
            .collect()
    }
}

fn shape(shape: &Shape) -> Result<reference::Shape, InvalidInput> {
    let ball = reference::Ball {
        centre: shape.ball.centre.to_array(),
        radius: shape.ball.radius,
    };
    let vertices = shape.vertices.iter().map(|v| v.to_array()).collect();
    let obb = shape.obb(&Hull::of(&shape.vertices));
    reference::Shape::new(ball, slabs(&shape.ordop), vertices, shape.triangles.clone())?
        .with_obb(&slabs(&obb))
}

fn slabs(ordop: &OrDop) -> reference::Slabs {
    reference::Slabs {
        directions: directions(ordop.directions),
        basis: ordop.basis.columns.map(|column| column.to_array()),
        lo: ordop.lo.clone(),
        hi: ordop.hi.clone(),
    }
}

/// The same direction set in the reference's terms.
pub fn directions(directions: DirectionSet) -> reference::DirectionSet {
    match directions {
        DirectionSet::K6 => reference::DirectionSet::K6,
        DirectionSet::K14 => reference::DirectionSet::K14,
        DirectionSet::K18 => reference::DirectionSet::K18,
        DirectionSet::K26 => reference::DirectionSet::K26,
    }
}

/// The same overlap test in the reference's terms.
pub fn overlap(overlap: Overlap) -> reference::Overlap {
    match overlap {
        Overlap::OneSided => reference::Overlap::OneSided,
        Overlap::TwoSided => reference::Overlap::TwoSided,
        Overlap::Full => reference::Overlap::Full,
    }
}
