//! The paper's finder: every one of the N(N−1)/2 pairs, less the S(S−1)/2 static ones.

use super::RunTest;
use crate::simd::Lanes;

/// Slots with the dynamic bodies first, so that every dynamic slot's run is all slots behind it.
#[derive(Clone, Debug)]
pub struct AllPairs {
    order: Vec<u32>,
    dynamic: usize,
}

impl AllPairs {
    /// Arranges the bodies once: which of them are dynamic doesn't change within a run.
    #[must_use]
    pub fn new(dynamic: &[bool]) -> Self {
        let bodies = 0..dynamic.len() as u32;
        let (moving, fixed): (Vec<u32>, Vec<u32>) =
            bodies.partition(|&body| dynamic[body as usize]);
        let count = moving.len();
        let order = moving.into_iter().chain(fixed).collect();
        Self {
            order,
            dynamic: count,
        }
    }

    /// Which body stands in each slot.
    #[must_use]
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// Hands every candidate to `test`.
    #[inline(always)]
    pub fn find<L: Lanes>(&self, l: L, test: &mut impl RunTest) {
        for i in 0..self.dynamic {
            test.run(l, i, i + 1..self.order.len());
        }
    }
}
