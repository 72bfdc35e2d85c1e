//! The pair tests, one file per volume: columns or rows in, surviving pairs out.
//!
//! Every test rejects by a strict `>` on conservatively inflated volumes, so touching is reported and NaN never culls.
//! A test counts when a candidate pair is handed to it; padding lanes never count.

pub mod boxes;
pub mod intervals;
pub mod ordop;
pub mod sphere;

use std::ops::Range;

use crate::broad_phase::Block;
use crate::simd::Lanes;

/// A first volume test: candidates in the two forms that pair finders hand out, hits as a list.
pub trait SlotTest {
    /// Lists the slots of `run` that may touch slot `i` at the front of `hits`, which has room for the run and a vector
    /// more. Returns their number.
    fn run<L: Lanes>(&self, l: L, i: usize, run: Range<usize>, hits: &mut [u32]) -> usize;

    /// Lists the codes of the block's pairs that may touch at the front of `hits`, which has room for the block and a
    /// vector more. Returns their number.
    fn block<L: Lanes>(&self, l: L, block: &Block<'_>, hits: &mut [u32]) -> usize;
}

#[cfg(test)]
mod whole_vectors;
