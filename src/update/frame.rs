//! [`ShapeFrame`]: the numbers of a shape from which a body's volumes are updated.

use std::ops::Deref;

use super::row::{O, Q, S, SHAPE, T};
use crate::rounding::pose::{over_norm, rotate, rotation, world_axes};
use crate::rounding::sphere::{inflate_radius, world_ball};
use crate::rounding::up;
use crate::simd::ROW;
use crate::volume::{Basis, Shape};

/// Index of the basis in a shape's record, column by column.
pub const BASIS: usize = 0;
/// Index of the ball's centre in a shape's record.
pub const CENTRE: usize = 9;
/// Index of the inverse length of the basis' columns in a shape's record: an f64 as the sum of
/// three f32.
pub const INVERSE_LENGTHS: usize = 12;

/// The frames of all shapes.
#[derive(Clone, Debug, Default)]
pub struct ShapeFrames {
    frames: Vec<ShapeFrame>,
    /// The records for or-DOP updates, which are read as columns, a vector of shapes at a time.
    pub(super) records: Vec<[f32; ROW]>,
    /// Whether some shape's ball centre is not its body's origin.
    some_eccentric: bool,
}

impl ShapeFrames {
    /// Appends the frame of the next shape.
    pub fn push(&mut self, frame: ShapeFrame) {
        self.records.push(frame.record());
        self.some_eccentric |= frame.inflated.is_none();
        self.frames.push(frame);
    }

    /// Replaces the frame of a shape.
    pub(crate) fn set(&mut self, number: usize, frame: ShapeFrame) {
        self.records[number] = frame.record();
        self.some_eccentric |= frame.inflated.is_none();
        self.frames[number] = frame;
    }

    /// Keeps the first `len` frames, and frees other memory.
    pub(crate) fn shrink_to(&mut self, len: usize) {
        self.records.truncate(len);
        self.frames.truncate(len);
        self.records.shrink_to_fit();
        self.frames.shrink_to_fit();
        self.some_eccentric = self.frames.iter().any(|frame| frame.inflated.is_none());
    }

    /// Whether the centre of every ball is its body's origin.
    pub(super) fn are_centred(&self) -> bool {
        !self.some_eccentric
    }
}

impl Deref for ShapeFrames {
    type Target = [ShapeFrame];
    fn deref(&self) -> &[ShapeFrame] {
        &self.frames
    }
}

impl FromIterator<ShapeFrame> for ShapeFrames {
    fn from_iter<I: IntoIterator<Item = ShapeFrame>>(frames: I) -> Self {
        let mut all = Self::default();
        frames.into_iter().for_each(|frame| all.push(frame));
        all
    }
}

/// The numbers of a shape, in the body frame, from which a body's volumes are updated.
#[derive(Clone, Debug)]
pub struct ShapeFrame {
    /// The number of the shape.
    pub(super) shape: u32,
    pub(super) margin: f32,
    pub(super) centre: [f32; 3],
    pub(super) radius: f32,
    /// The inflated radius R, if the ball's centre is the body's origin. No pose changes it then.
    pub(super) inflated: Option<f32>,
    pub(super) reach: f32,
    /// Column by column.
    basis: [[f32; 3]; 3],
}

impl ShapeFrame {
    /// The frame of a shape whose or-DOP has the axes `basis`.
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

    /// The frame with another radius about the ball's centre.
    #[must_use]
    pub fn with_radius(self, radius: f32) -> Self {
        let centred = self.centre == [0.0; 3];
        Self { radius, inflated: centred.then(|| inflate_radius(radius)), ..self }
    }

    /// The frame with the number of the hull to which world-aligned volumes are fitted.
    #[must_use]
    pub fn numbered(self, shape: u32) -> Self {
        Self { shape, ..self }
    }

    /// The number of the shape's hull.
    pub(crate) fn hull(&self) -> u32 {
        self.shape
    }

    /// The frame grown by `margin` on all sides.
    #[must_use]
    pub fn grown(&self, margin: f32) -> Self {
        let grow = |size: f32| up(f64::from(size) + f64::from(margin));
        let frame = Self {
            margin: if self.margin == 0.0 { margin } else { grow(self.margin) },
            reach: grow(self.reach),
            ..*self
        };
        frame.with_radius(grow(self.radius))
    }

    /// The ball's radius, without inflation.
    #[must_use]
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// The ball's centre in the body frame.
    #[must_use]
    pub fn centre(&self) -> [f32; 3] {
        self.centre
    }

    /// An upper bound on the distance of the shape's points from the body origin.
    #[must_use]
    pub fn reach(&self) -> f32 {
        self.reach
    }

    /// The record: basis, centre and inverse length.
    fn record(&self) -> [f32; ROW] {
        let mut record = [0.0; ROW];
        record[BASIS..CENTRE].copy_from_slice(self.basis.as_flattened());
        record[CENTRE..INVERSE_LENGTHS].copy_from_slice(&self.centre);
        // Lengths are in (1/2, 1], so each part takes 24 bits of the rest, and three parts take all
        // 53.
        let mut rest = over_norm(self.basis[0]);
        for part in &mut record[INVERSE_LENGTHS..INVERSE_LENGTHS + 3] {
            *part = rest as f32;
            rest -= f64::from(*part);
        }
        record
    }

    /// The or-DOP row of a body of this shape, whose slabs are in the table number `table`.
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

    /// The inflated world sphere (x, y, z, R) of a body of this shape.
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

    /// A record has the unit to the bit.
    #[test]
    fn shape_record_is_exact() {
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
