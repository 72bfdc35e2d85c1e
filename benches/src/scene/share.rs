//! The bodies of a scene that a process holds: all, or the share of one rank.

use std::ops::Range;

use crate::effects::runs;
use sdop::bodies::Bodies;

/// A run of a scene's bodies, by their numbers in the whole scene.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Share {
    /// The numbers of the bodies that are held.
    pub held: Range<usize>,
    /// How many bodies the whole scene has.
    pub all: usize,
    /// The runs of bodies of the whole scene that may move.
    pub moving: Vec<Range<usize>>,
}

impl Share {
    /// The share of a process that holds the whole scene.
    #[must_use]
    pub fn whole(bodies: &Bodies) -> Self {
        Self::of_rank(0, 1, bodies.len(), runs(&bodies.dynamic))
    }

    /// The share of `rank` of `ranks` equal ones; where `all` can't be divided, they differ by one.
    #[must_use]
    pub fn of_rank(rank: usize, ranks: usize, all: usize, moving: Vec<Range<usize>>) -> Self {
        // Fewer than 2³¹ bodies and 2³² ranks.
        let start = |rank: usize| (all as u64 * rank as u64 / ranks as u64) as usize;
        Self { held: start(rank)..start(rank + 1), all, moving }
    }

    /// The part of a run of bodies that is held, counted from the run's first body.
    pub(super) fn within(&self, run: &Range<usize>) -> Range<usize> {
        let clamp = |number: usize| number.clamp(run.start, run.end) - run.start;
        clamp(self.held.start)..clamp(self.held.end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Shares follow one another and differ by one.
    #[test]
    fn shares_differ_by_at_most_one() {
        for (all, ranks) in [(0, 1), (1, 3), (10, 3), (16, 8), (7, 7)] {
            let mut next = 0;
            for rank in 0..ranks {
                let share = Share::of_rank(rank, ranks, all, Vec::new());
                assert_eq!(share.held.start, next);
                assert!((all / ranks..=all.div_ceil(ranks)).contains(&share.held.len()));
                next = share.held.end;
            }
            assert_eq!(next, all);
        }
    }

    /// A run is held as far as the share goes.
    #[test]
    fn run_is_clipped_to_its_share() {
        let share = Share::of_rank(1, 3, 30, Vec::new());
        assert_eq!(share.within(&(0..30)), 10..20);
        assert_eq!(share.within(&(15..18)), 0..3);
        assert_eq!(share.within(&(18..40)), 0..2);
        assert!(share.within(&(0..10)).is_empty() && share.within(&(20..30)).is_empty());
    }
}
