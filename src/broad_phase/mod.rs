//! Pair finders: who hands which candidate pairs to the strategy's first volume test.
//!
//! A finder arranges bodies in slots so that the candidates of a slot are contiguous runs of other slots; the test loads
//! columns in slot order and never sees how the run was found. Every pair of two bodies that are not both static and that
//! the first test would report must be in some run exactly once; static–static pairs must be in none.

use std::ops::Range;

use crate::simd::Lanes;

mod all_pairs;

pub use all_pairs::AllPairs;

/// The strategy's first volume test: takes runs of candidates.
pub trait RunTest {
    /// Slot `i` against each slot of `run`.
    fn run<L: Lanes>(&mut self, l: L, i: usize, run: Range<usize>);
}
