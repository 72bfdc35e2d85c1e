//! Balls by place and in slot order.

use std::ops::{Deref, DerefMut};

use super::bytes;
use crate::simd::MAX_WIDTH;

/// World balls (x, y, z, R) by place, followed by a vector of finite entries, so that tests can
/// read whole vectors.
#[derive(Clone, Debug)]
pub struct Balls {
    padded: Vec<[f32; 4]>,
}

impl Default for Balls {
    fn default() -> Self {
        Self::new(0)
    }
}

impl Balls {
    /// `len` balls of radius 0 at the origin.
    #[must_use]
    pub fn new(len: usize) -> Self {
        let padded = vec![[0.0; 4]; len + MAX_WIDTH];
        Self { padded }
    }

    /// Resizes to `len` balls. New ones have radius 0 at the origin.
    pub fn resize(&mut self, len: usize) {
        resize(&mut self.padded, len, [0.0; 4]);
    }
}

impl Deref for Balls {
    type Target = [[f32; 4]];
    fn deref(&self) -> &[[f32; 4]] {
        &self.padded[..self.padded.len() - MAX_WIDTH]
    }
}

impl DerefMut for Balls {
    fn deref_mut(&mut self) -> &mut [[f32; 4]] {
        let len = self.len();
        &mut self.padded[..len]
    }
}

/// World balls (x, y, z, R) in slot order, padded by [`MAX_WIDTH`] finite entries, with the names
/// of their bodies.
#[derive(Clone, Debug, Default)]
pub struct Slots {
    /// The balls as the first test takes them.
    pub balls: Vec<[f32; 4]>,
    /// The same as columns, for finders whose runs are long; otherwise empty.
    pub columns: [Vec<f32>; 4],
    /// The name of each slot's body.
    pub names: Vec<u32>,
}

impl Slots {
    /// Room for `slots` slots.
    pub(super) fn resize(&mut self, slots: usize) {
        resize(&mut self.balls, slots, [0.0; 4]);
        resize(&mut self.names, slots, 0);
    }

    pub(super) fn bytes(&self) -> usize {
        let columns = self.columns.iter().map(bytes).sum::<usize>();
        bytes(&self.balls) + columns + bytes(&self.names)
    }

    /// The bodies of a frame that has these balls.
    pub(crate) fn arranged(&self) -> SlotBodies<'_> {
        SlotBodies { balls: &self.balls, columns: &self.columns, names: &self.names }
    }

    /// The bodies of a frame in which places have the order of slots, so that `balls` by place are
    /// those in slot order.
    pub(super) fn followed<'a>(&'a self, balls: &'a Balls) -> SlotBodies<'a> {
        let balls = &balls.padded;
        SlotBodies { balls, ..self.arranged() }
    }
}

/// The bodies of a frame in slot order: [`Slots`], or the balls by place.
#[derive(Clone, Copy, Debug)]
pub struct SlotBodies<'a> {
    /// The balls as the first test takes them.
    pub balls: &'a [[f32; 4]],
    /// The same as columns, for finders whose runs are long; otherwise empty.
    pub columns: &'a [Vec<f32>; 4],
    /// The name of each slot's body.
    pub names: &'a [u32],
}

impl SlotBodies<'_> {
    /// The ball in a slot.
    #[inline(always)]
    #[must_use]
    pub fn ball(&self, slot: usize) -> [f32; 4] {
        let [x, y, z, r] = self.columns;
        if x.is_empty() { self.balls[slot] } else { [x[slot], y[slot], z[slot], r[slot]] }
    }
}

/// Room for `len` entries and [`MAX_WIDTH`] empty ones.
fn resize<T: Copy>(column: &mut Vec<T>, len: usize, empty: T) {
    column.resize(len + MAX_WIDTH, empty);
    // Former entries may be padding now.
    column[len..].fill(empty);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Behind the slots is a vector of finite entries.
    #[test]
    fn slots_are_padded_with_finite_entries() {
        let (mut slots, mut balls) = (Slots::default(), Balls::new(7));
        assert_eq!((balls.len(), balls.padded.len()), (7, 7 + MAX_WIDTH));
        for len in [0, 1, 5, 40, 3] {
            slots.resize(len);
            balls.resize(len);
            assert_eq!(balls.len(), len);
            assert_eq!([slots.balls.len(), slots.names.len()], [len + MAX_WIDTH; 2]);
            for padded in [slots.arranged(), slots.followed(&balls)] {
                assert_eq!(padded.balls[len..], [[0.0; 4]; MAX_WIDTH]);
                assert_eq!(padded.names[len..], [0; MAX_WIDTH]);
            }
            slots.balls.fill([f32::NAN; 4]);
            slots.names.fill(u32::MAX);
            balls.fill([f32::NAN; 4]);
        }
    }
}
