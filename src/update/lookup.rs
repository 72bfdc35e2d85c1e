//! Where each body's row stands.

use std::ops::Deref;

use crate::simd::ROW;

/// Rows that are found by their body's number: one a body, or two rings of a power of two, of which
/// the first has rows of bodies that move, the second those of the others.
#[derive(Clone, Copy, Debug)]
pub struct RowsByNumber<'a> {
    rows: &'a [[f32; ROW]],
    /// The bits of a body's number that its row's has.
    bits: u32,
    /// From this number on, bodies don't move.
    still: u32,
    /// Where their ring begins.
    second: u32,
}

impl<'a> RowsByNumber<'a> {
    /// A row for each body.
    #[must_use]
    pub fn all(rows: &'a [[f32; ROW]]) -> Self {
        Self {
            rows,
            bits: u32::MAX,
            still: u32::MAX,
            second: 0,
        }
    }

    /// Two rings, equally long. The bodies of the numbers below `moving` have their rows in the
    /// first one.
    #[must_use]
    pub fn in_rings(rows: &'a [[f32; ROW]], moving: usize) -> Self {
        let ring = rows.len() / 2;
        debug_assert!(ring.is_power_of_two(), "{ring}");
        Self {
            rows,
            bits: ring as u32 - 1,
            still: moving as u32,
            second: ring as u32,
        }
    }

    /// Where a body's row stands.
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
