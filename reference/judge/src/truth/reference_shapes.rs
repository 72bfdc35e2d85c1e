//! The culler's shapes and bodies as the reference takes them: plain numbers, nothing shared.

use sdop_reference as reference;

use sdop::bodies::Bodies;
use sdop::rounding::pose::norm;
use sdop::rounding::slab::{SLAB_FLOOR, SLAB_MARGIN};
use sdop::rounding::{U, down, exp2, up};
use sdop::settings::Overlap;
use sdop::volume::{DirectionSet, Hull, OrDop, Shape};

/// What the reference refuses to judge.
pub use reference::InvalidInput;

/// Shapes as the culler and as the reference knows them, in one order.
#[derive(Clone, Debug, Default)]
pub struct Shapes {
    /// The shapes as built.
    pub built: Vec<Shape>,
    /// The same numbers for the reference, with each shape's oriented box.
    pub judged: Vec<reference::Shape>,
    /// The same shapes, as much wider as the rounding margins may make a report: balls by r·15u +
    /// 2⁻⁶⁸ (the bound that [`inflate_radius`](sdop::rounding::sphere::inflate_radius) states),
    /// slabs by twice their margin.
    pub widened: Vec<reference::Shape>,
}

impl Shapes {
    /// Hands every shape's numbers to the reference.
    ///
    /// # Errors
    /// Numbers that the reference refuses: a shape that [`Shape::build`] made has none.
    pub fn new(built: Vec<Shape>) -> Result<Self, InvalidInput> {
        let all = |margins: f64| -> Result<Vec<_>, _> {
            built.iter().map(|s| shape(s, margins)).collect()
        };
        Ok(Self { judged: all(0.0)?, widened: all(1.0)?, built })
    }

    /// The bodies as the reference takes them.
    ///
    /// # Errors
    /// A pose outside the contract.
    pub fn bodies(&self, bodies: &Bodies) -> Result<Vec<reference::Body<'_>>, InvalidInput> {
        let body = |i| body(&self.judged, bodies, i);
        (0..bodies.len()).map(body).collect()
    }

    /// One body, widened.
    ///
    /// # Errors
    /// A pose outside the contract.
    pub fn widened_body(
        &self,
        bodies: &Bodies,
        i: u32,
    ) -> Result<reference::Body<'_>, InvalidInput> {
        body(&self.widened, bodies, i as usize)
    }
}

/// A body as the reference takes it.
pub(crate) fn body<'a>(
    shapes: &'a [reference::Shape],
    bodies: &Bodies,
    i: usize,
) -> Result<reference::Body<'a>, InvalidInput> {
    Ok(reference::Body {
        shape: &shapes[bodies.shape[i] as usize],
        pose: reference::Pose::new(bodies.rotation[i], bodies.translation[i])?,
        dynamic: bodies.dynamic[i],
    })
}

/// The shape grown by a contact margin, rounded inward: what a culler must at least take it for.
/// Vertices stay as they are.
pub(crate) fn grown(shape: &Shape, margin: f32) -> Result<reference::Shape, InvalidInput> {
    let by = f64::from(margin);
    let ball = reference::Ball {
        centre: shape.ball.centre,
        radius: down(f64::from(shape.ball.radius) + by),
    };
    let slabs = |ordop: &OrDop| moved_slabs(ordop, by, [up, down]);
    let vertices = shape.vertices.clone();
    let obb = shape.obb(&Hull::of(&shape.vertices));
    reference::Shape::new(ball, slabs(&shape.ordop), vertices, shape.triangles.clone())?
        .with_obb(&slabs(&obb))
}

/// The shape, wider by a multiple of the margins.
fn shape(shape: &Shape, margins: f64) -> Result<reference::Shape, InvalidInput> {
    let radius = f64::from(shape.ball.radius);
    let wider = radius + margins * (15.0 * U * radius + exp2(-69));
    let ball = reference::Ball {
        centre: shape.ball.centre,
        radius: if margins > 0.0 { up(wider) } else { shape.ball.radius },
    };
    let reach = f64::from(shape.reach) + norm(shape.ball.centre);
    let by = margins * 2.0 * (SLAB_MARGIN * reach + SLAB_FLOOR);
    let slabs = |ordop: &OrDop| slabs(ordop, by);
    let vertices = shape.vertices.clone();
    let obb = shape.obb(&Hull::of(&shape.vertices));
    reference::Shape::new(ball, slabs(&shape.ordop), vertices, shape.triangles.clone())?
        .with_obb(&slabs(&obb))
}

/// The slabs in the reference's terms, each end further out by `by` times its direction's length.
pub(crate) fn slabs(ordop: &OrDop, by: f64) -> reference::Slabs {
    moved_slabs(ordop, by, [down, up])
}

/// The same, with the lower and the upper ends rounded as given.
fn moved_slabs(ordop: &OrDop, by: f64, rounded: [fn(f64) -> f32; 2]) -> reference::Slabs {
    let lengths = ordop.directions.coefficients().iter();
    let lengths = lengths.map(|&c| norm(ordop.basis.direction(c)));
    let moved = |ends: &[f32], sign: f64, rounded: fn(f64) -> f32| -> Vec<f32> {
        let moved = ends.iter().zip(lengths.clone());
        moved
            .map(|(&end, length)| match by * length {
                0.0 => end,
                further => rounded(f64::from(end) + sign * further),
            })
            .collect()
    };
    reference::Slabs {
        directions: directions(ordop.directions),
        basis: ordop.basis.columns,
        lo: moved(&ordop.lo, -1.0, rounded[0]),
        hi: moved(&ordop.hi, 1.0, rounded[1]),
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
