//! [`SearchEffort`]: what the search for a list has found and tested so far, on all threads
//! together, and when it ends.

use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// The most pairs per body of a list with the widest skin, apart from a constant for small scenes.
/// In denser crowds the reported pairs dominate the time, and a list would take more memory than
/// everything else.
const PAIRS_PER_BODY: usize = 8;
const SPARE_PAIRS: u64 = 256;

/// The limit of candidates that the search for a list may test: this many times those of the grid
/// without a skin, plus some per body. Skins stay below it ([`policy`](super::policy)), unless the
/// skin's floor exceeds the bodies' size.
const GROWTH_OF_CANDIDATES: u64 = 3;
const CANDIDATES_PER_BODY: u64 = 48;

/// The limits of a list and of the search for it.
#[derive(Clone, Copy, Debug)]
pub struct SearchLimits {
    /// Pairs.
    pub pairs: u64,
    /// Candidates.
    pub candidates: u64,
}

impl SearchLimits {
    /// The limits for a list of `bodies` bodies, for which the widest skin gives `spare` times as
    /// many pairs and the grid without a skin has `candidates` candidates.
    pub fn of(bodies: usize, candidates: u64, spare: f64) -> Self {
        let pairs = (PAIRS_PER_BODY * bodies) as f64 / spare;
        Self {
            pairs: pairs as u64 + SPARE_PAIRS,
            candidates: GROWTH_OF_CANDIDATES * candidates + CANDIDATES_PER_BODY * bodies as u64,
        }
    }
}

/// Candidates after which a thread adds its counts to those of all.
pub const CANDIDATES_PER_REPORT: u64 = 1024;

/// Counts of all threads. They only grow, so whether the search exceeds its limits does not depend
/// on threads. By how much it does: up to [`CANDIDATES_PER_REPORT`] and one part of the work per
/// thread.
#[derive(Debug)]
pub struct SearchEffort {
    limits: SearchLimits,
    pairs: AtomicU64,
    candidates: AtomicU64,
}

impl SearchEffort {
    /// Counts of zero, with these limits.
    pub fn new(limits: SearchLimits) -> Self {
        Self { limits, pairs: AtomicU64::new(0), candidates: AtomicU64::new(0) }
    }

    /// Adds a thread's counts.
    pub fn add(&self, pairs: u64, candidates: u64) {
        self.pairs.fetch_add(pairs, Relaxed);
        self.candidates.fetch_add(candidates, Relaxed);
    }

    /// Whether the shared counts plus these, which are not yet added, exceed the limits.
    #[inline(always)]
    pub fn is_over_with(&self, pairs: u64, candidates: u64) -> bool {
        self.pairs.load(Relaxed) + pairs > self.limits.pairs
            || self.candidates.load(Relaxed) + candidates > self.limits.candidates
    }

    /// Whether the search has to end.
    pub fn is_over(&self) -> bool {
        self.is_over_with(0, 0)
    }

    /// Candidates tested. An abandoned search counts as its limit, on any number of threads.
    pub fn tested(&self) -> u64 {
        if self.is_over() { self.limits.candidates } else { self.candidates.load(Relaxed) }
    }

    /// Checks in debug builds that no thread went on beyond the limits.
    pub fn check(&self, threads: usize) {
        let slack = threads as u64
            * (CANDIDATES_PER_REPORT + 2 * crate::broad_phase::MOST_CANDIDATES as u64);
        debug_assert!(
            self.pairs.load(Relaxed) <= self.limits.pairs + slack
                && self.candidates.load(Relaxed) <= self.limits.candidates + slack,
            "the search for a list ends at its limits"
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    impl SearchEffort {
        /// The effort of a search that never ends early.
        pub fn unlimited() -> Self {
            Self::new(SearchLimits { pairs: u64::MAX, candidates: u64::MAX })
        }
    }

    /// An effort is over beyond either limit.
    #[test]
    fn search_ends_beyond_either_limit() {
        let limits = SearchLimits { pairs: 10, candidates: 100 };
        for (pairs, candidates, over) in [(10, 100, false), (11, 50, true), (5, 101, true)] {
            let effort = SearchEffort::new(limits);
            assert_eq!(effort.is_over_with(pairs, candidates), over);
            effort.add(pairs - 1, candidates - 1);
            assert!(!effort.is_over() && effort.tested() == candidates - 1);
            assert_eq!(effort.is_over_with(1, 1), over);
            effort.add(1, 1);
            assert_eq!(effort.is_over(), over);
            assert_eq!(effort.tested(), 100.min(candidates).max(if over { 100 } else { 0 }));
        }
    }

    #[test]
    #[cfg_attr(debug_assertions, should_panic(expected = "ends at its limits"))]
    fn a_search_without_end_is_noticed() {
        let limits = SearchLimits { pairs: 10, candidates: 100 };
        let effort = SearchEffort::new(limits);
        effort.add(0, 100_000);
        effort.check(4);
    }
}
