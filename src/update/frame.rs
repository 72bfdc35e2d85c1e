//! What is known of each shape that bodies are posed in.

use std::ops::Deref;

use super::row::{O, Q, S, SHAPE, T};
use crate::rounding::pose::{over_norm, rotate, rotation, world_axes};
use crate::rounding::sphere::{inflate_radius, world_ball};
use crate::rounding::up;
use crate::simd::ROW;
use crate::volume::{Basis, Shape};

/// Where the basis begins in a shape's record, column by column.
pub const BASIS: usize = 0;
/// Where the centre of its ball begins.
pub const CENTRE: usize = 9;
/// Where one over the length of each of the basis' columns begins, a number of f64 as the sum of
/// three of f32.
pub const UNIT: usize = 12;

/// The frames of all shapes.
#[derive(Clone, Debug, Default)]
pub struct Frames {
    frames: Vec<ShapeFrame>,
    /// What or-DOPs are turned by: records that are read as columns, a vector of shapes at a time.
    pub(super) records: Vec<[f32; ROW]>,
    /// Whether some ball's centre isn't its body's origin.
    some_eccentric: bool,
}

impl Frames {
    /// Adds the next shape's.
    pub fn push(&mut self, frame: ShapeFrame) {
        self.records.push(frame.record());
        self.some_eccentric |= frame.inflated.is_none();
        self.frames.push(frame);
    }

    /// Puts another in the place of one.
    pub(crate) fn set(&mut self, number: usize, frame: ShapeFrame) {
        self.records[number] = frame.record();
        self.some_eccentric |= frame.inflated.is_none();
        self.frames[number] = frame;
    }

    /// Keeps the first ones, and no room for more.
    pub(crate) fn shrink_to(&mut self, len: usize) {
        self.records.truncate(len);
        self.frames.truncate(len);
        self.records.shrink_to_fit();
        self.frames.shrink_to_fit();
        self.some_eccentric = self.frames.iter().any(|frame| frame.inflated.is_none());
    }

    /// Whether the centre of each body's ball is its origin.
    pub(super) fn are_centred(&self) -> bool {
        !self.some_eccentric
    }
}

impl Deref for Frames {
    type Target = [ShapeFrame];
    fn deref(&self) -> &[ShapeFrame] {
        &self.frames
    }
}

impl FromIterator<ShapeFrame> for Frames {
    fn from_iter<I: IntoIterator<Item = ShapeFrame>>(frames: I) -> Self {
        let mut all = Self::default();
        frames.into_iter().for_each(|frame| all.push(frame));
        all
    }
}

/// The numbers of a shape from which a body's volumes are updated, in the body frame.
#[derive(Clone, Debug)]
pub struct ShapeFrame {
    /// The shape, and how far it is grown beyond its vertices.
    pub(super) shape: u32,
    pub(super) margin: f32,
    centre: [f32; 3],
    radius: f32,
    /// R, if the ball's centre is the body's origin: no pose changes it then.
    pub(super) inflated: Option<f32>,
    pub(super) reach: f32,
    /// Column by column.
    basis: [[f32; 3]; 3],
}

impl ShapeFrame {
    /// Of a shape whose or-DOP has the axes `basis`.
    #[must_use]
    pub fn new(shape: &Shape, basis: &Basis) -> Self {
        let frame = Self {
            shape: 0,
            margin: shape.rounding,
            centre: shape.ball.centre,
            radius: 0.0,
            inflated: None,
            reach: shape.reach,
            basis: basis.columns,
        };
        frame.with_radius(shape.ball.radius)
    }

    /// The same with another radius about the ball's centre.
    #[must_use]
    pub fn with_radius(self, radius: f32) -> Self {
        let centred = self.centre == [0.0; 3];
        Self {
            radius,
            inflated: centred.then(|| inflate_radius(radius)),
            ..self
        }
    }

    /// The same with the number of its shape, to whose hull world-aligned volumes are fitted.
    #[must_use]
    pub fn numbered(self, shape: u32) -> Self {
        Self { shape, ..self }
    }

    /// The number of its shape's hull.
    pub(crate) fn hull(&self) -> u32 {
        self.shape
    }

    /// The same, grown by `margin` all around.
    #[must_use]
    pub fn grown(&self, margin: f32) -> Self {
        let grow = |size: f32| up(f64::from(size) + f64::from(margin));
        let frame = Self {
            margin: if self.margin == 0.0 {
                margin
            } else {
                grow(self.margin)
            },
            reach: grow(self.reach),
            ..*self
        };
        frame.with_radius(grow(self.radius))
    }

    /// The ball's radius, not inflated.
    #[must_use]
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// The ball's centre, body frame.
    #[must_use]
    pub fn centre(&self) -> [f32; 3] {
        self.centre
    }

    /// An upper bound on the distance of the shape's points from the body origin.
    #[must_use]
    pub fn reach(&self) -> f32 {
        self.reach
    }

    /// Basis, centre and unit.
    fn record(&self) -> [f32; ROW] {
        let mut record = [0.0; ROW];
        record[BASIS..CENTRE].copy_from_slice(self.basis.as_flattened());
        record[CENTRE..UNIT].copy_from_slice(&self.centre);
        // Lengths are in (1/2, 1], so each part takes 24 bits of what the ones before it leave, and
        // none is left of 53.
        let mut rest = over_norm(self.basis[0]);
        for part in &mut record[UNIT..UNIT + 3] {
            *part = rest as f32;
            rest -= f64::from(*part);
        }
        record
    }

    /// The or-DOP's row of a body in this shape, whose slabs are in the table of number `table`.
    #[must_use]
    pub fn row(&self, table: u32, q: [f32; 4], t: [f32; 3]) -> [f32; ROW] {
        let (turn, mut row) = (rotation(q), [0.0; ROW]);
        row[Q..Q + 9].copy_from_slice(world_axes(&turn, self.basis).as_flattened());
        row[T..T + 3].copy_from_slice(&t);
        if self.centre != [0.0; 3] {
            row[O..O + 3].copy_from_slice(&rotate(&turn, self.centre).map(|x| x as f32));
        }
        row[S] = f32::from_bits(SHAPE + table);
        row
    }

    /// Inflated world sphere (x, y, z, R) of a body in this shape.
    #[inline]
    #[must_use]
    pub fn sphere(&self, q: [f32; 4], t: [f32; 3]) -> [f32; 4] {
        let (centre, inflated) = match self.inflated {
            Some(inflated) => (t, inflated),
            None => {
                let (centre, radius) = world_ball(&rotation(q), t, self.centre, self.radius);
                (centre, inflate_radius(radius))
            }
        };
        [centre[0], centre[1], centre[2], inflated]
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;

    #[test]
    fn a_record_has_the_unit_to_the_bit() {
        for (x, y, z, w) in [(0, 0, 0, 1), (1, 2, 3, 4), (-5, 7, 0, 11), (1, 0, 0, 1000)] {
            let basis = Basis::from_integer_quaternion([x, y, z, w]).unwrap();
            let frame = ShapeFrame {
                shape: 0,
                margin: 0.0,
                centre: [1.0, -2.0, 3.0],
                radius: 0.0,
                inflated: None,
                reach: 0.0,
                basis: basis.columns,
            };
            let record = frame.record();
            assert_eq!(record[..9], *frame.basis.as_flattened());
            assert_eq!(record[9..12], frame.centre);
            let [high, middle, low] = [12, 13, 14].map(|part| f64::from(record[part]));
            assert_eq!(high + middle + low, over_norm(frame.basis[1]));
        }
    }
}
