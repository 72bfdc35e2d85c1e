//! Boxes alone, for cullers of boxes: the bodies are points at their centres.

use rand::{Rng, RngExt};

use super::exact_touches::WholeTurn;
use super::{CatalogueError, DrawnCase};
use crate::case::Frame;
use crate::contestant::WorldBox;
use crate::draw::forms::Form;
use sdop::bodies::Bodies;
use sdop::volume::{Axes, DirectionSet, Shape};

/// What the boxes are like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoxKind {
    /// On a lattice: neighbours touch exactly.
    Grid,
    /// Each end an ulp or none from another box's.
    Ulp,
    /// Without a volume.
    Flat,
    /// Subnormal, and up to 2⁶⁰.
    Range,
    /// Corner to corner in the direction of both diagonals, whose lengths are whole numbers: balls
    /// around the boxes touch exactly where the boxes do.
    Oblique,
}

/// Draws `count` boxes of a kind, in one frame.
pub fn boxes(kind: BoxKind, count: usize, rng: &mut impl Rng) -> Result<DrawnCase, CatalogueError> {
    let mut boxes: Vec<WorldBox> = Vec::new();
    for n in 0..count {
        let drawn = match kind {
            BoxKind::Grid => from_ends(|_| {
                let lo = rng.random_range(-3..3);
                [lo as f32, (lo + rng.random_range(1..=2)) as f32]
            }),
            BoxKind::Ulp if n % 2 == 1 => beside(&boxes[n - 1], rng),
            BoxKind::Ulp => from_ends(|_| {
                let lo = rng.random_range(-4.0..4.0_f32);
                [lo, lo + rng.random_range(0.1..1.0)]
            }),
            BoxKind::Flat => from_ends(|_| {
                let lo = [-1.0, -0.0, 0.0, 1.0][rng.random_range(0..4)];
                let hi = [-0.0, 0.0, 1.0, 1.0][rng.random_range(0..4)];
                if lo <= hi { [lo, hi] } else { [lo, lo] }
            }),
            BoxKind::Range => {
                let scale = [1e-45, 1e-39, 1e-20, 1.0, 1e9, 2.5e17][rng.random_range(0..6)];
                from_ends(|_| {
                    let lo = rng.random_range(-2.0..2.0_f32) * scale;
                    [lo, lo + rng.random_range(0.0..2.0) * scale]
                })
            }
            BoxKind::Oblique if n % 2 == 1 => corner_to_corner(&boxes[n - 1], rng),
            BoxKind::Oblique => {
                let half = WholeTurn::draw(rng).matrix[0];
                from_ends(|axis| {
                    let lo = rng.random_range(-(1 << 20)..1 << 20);
                    [lo as f32, (lo + 2 * half[axis].abs()) as f32]
                })
            }
        };
        boxes.push(drawn);
    }
    let fixed = |i: usize| i % 5 == 4;
    let dynamic = (0..boxes.len()).map(|i| !fixed(i)).collect();
    let (shape, frame) = of_boxes(boxes, dynamic)?;
    Ok(DrawnCase { shapes: vec![shape], frames: vec![frame] })
}

fn from_ends(mut ends: impl FnMut(usize) -> [f32; 2]) -> WorldBox {
    let [[x0, x1], [y0, y1], [z0, z1]] = [0, 1, 2].map(&mut ends);
    [x0, y0, z0, x1, y1, z1]
}

/// A box that begins where another ends on one axis: touching, an ulp inside or an ulp apart.
fn beside(other: &WorldBox, rng: &mut impl Rng) -> WorldBox {
    let mut next = *other;
    let axis = rng.random_range(0..3);
    let end = other[axis + 3];
    next[axis] = [end, end.next_up(), end.next_down()][rng.random_range(0..3)];
    next[axis + 3] = next[axis] + rng.random_range(0.1..1.0_f32);
    next
}

/// A box of the same aspect at a corner of another: it touches that, or is an ulp away or inside.
fn corner_to_corner(other: &WorldBox, rng: &mut impl Rng) -> WorldBox {
    let scale = [1.0, 0.5, 2.0][rng.random_range(0..3)];
    let mut next = from_ends(|axis| {
        let [lo, hi] = [other[axis], other[axis + 3]];
        let side = scale * (hi - lo);
        if rng.random() { [hi, hi + side] } else { [lo - side, lo] }
    });
    let end = rng.random_range(0..6);
    next[end] = [next[end], next[end].next_up(), next[end].next_down()][rng.random_range(0..3)];
    next
}

/// The frame of boxes alone, and the one point that all of their bodies are made of.
///
/// # Errors
/// None: the point is a constant.
pub fn of_boxes(
    boxes: Vec<WorldBox>,
    dynamic: Vec<bool>,
) -> Result<(Shape, Frame), CatalogueError> {
    // Nothing is drawn: the point has no size.
    let mut rng = <rand_chacha::ChaCha8Rng as rand::SeedableRng>::seed_from_u64(0);
    let point = Form { radius: None, ..Form::of("point", [0.0; 2]) };
    let point = point.shape(DirectionSet::K18, Axes::Model, &mut rng)?;
    let mut bodies = Bodies::default();
    for (ends, dynamic) in boxes.iter().zip(dynamic) {
        let centre = [0, 1, 2].map(|axis| ends[axis] / 2.0 + ends[axis + 3] / 2.0);
        bodies.push(0, dynamic, [0.0, 0.0, 0.0, 1.0], centre);
    }
    let frame = Frame { bodies, boxes, ..Frame::default() };
    Ok((point, frame))
}
