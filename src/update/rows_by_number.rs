//! [`RowsByNumber`]: the index of each body's row.

use std::ops::Deref;

use crate::simd::ROW;

/// Rows that are found by their body's number: one row per body, or two rings whose length is a
/// power of two. The first ring has the rows of moving bodies, the second those of static ones.
#[derive(Clone, Copy, Debug)]
pub struct RowsByNumber<'a> {
    rows: &'a [[f32; ROW]],
    /// Mask of the bits of a body's number that select its row.
    bits: u32,
    /// The first number of a static body.
    still: u32,
    /// The start of the second ring.
    second: u32,
}

impl<'a> RowsByNumber<'a> {
    /// One row per body.
    #[must_use]
    pub fn all(rows: &'a [[f32; ROW]]) -> Self {
        Self { rows, bits: u32::MAX, still: u32::MAX, second: 0 }
    }

    /// Two rings of equal length. Bodies with numbers below `moving` have their rows in the first
    /// one.
    #[must_use]
    pub fn in_rings(rows: &'a [[f32; ROW]], moving: usize) -> Self {
        let ring = rows.len() / 2;
        debug_assert!(ring.is_power_of_two(), "{ring}");
        Self { rows, bits: ring as u32 - 1, still: moving as u32, second: ring as u32 }
    }

    /// The index of a body's row.
    #[inline(always)]
    #[must_use]
    pub fn find(&self, body: u32) -> u32 {
        let ring = if body >= self.still { self.second } else { 0 };
        (body & self.bits) + ring
    }
}

impl Deref for RowsByNumber<'_> {
    type Target = [[f32; ROW]];
    #[inline(always)]
    fn deref(&self) -> &[[f32; ROW]] {
        self.rows
    }
}
