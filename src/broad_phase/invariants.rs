//! Checks of every finder in debug builds, and therefore in tests, in every small frame: each pair
//! is a candidate at most once, and each pair whose cubes meet exactly once, unless both bodies are
//! static.
//!
//! The checks use cubes because some first tests compare world-aligned volumes, and finders then
//! use the cubes around the balls. A list of neighbours knows whether that is so, and whether it
//! was built from the boxes themselves.

use std::ops::Range;

use super::{Block, FirstTest, GivenBoxes, PairFinder, Volume};
use crate::bodies::Places;
use crate::simd::{Kernel, Lanes, Tier, dispatch};

/// The most bodies of a frame that is checked, because the check compares all pairs.
const MOST_BODIES: usize = 64;

/// 1 + 4u: the ratio of distance to the sum of radii up to which balls may be reported.
const MOST_REPORTED_RATIO: f64 = 1.0 + 4.0 * crate::rounding::U;

impl PairFinder {
    /// Checks the candidates of a frame that has just been arranged, without allocating.
    pub(super) fn check(
        &self,
        tier: Tier,
        places: &Places,
        balls: &[[f32; 4]],
        boxes: Option<GivenBoxes<'_>>,
    ) {
        let n = places.len();
        if n > MOST_BODIES {
            return;
        }
        let (slots, by_place) = (self.own_slots().arranged(), self.slots_are_places());
        let ball = |slot: usize| {
            if by_place { balls[slot] } else { slots.ball(slot) }
        };
        let finite = |slot| ball(slot).iter().all(|x| x.is_finite());
        if !(0..n).all(finite) {
            return; // outside the contract
        }
        let seen = dispatch(tier, RecordCandidates { finder: self });
        let of_boxes = boxes.filter(|_| self.is_by_boxes());
        let meet = |i, j| match of_boxes {
            None => self.meet(ball(i), ball(j)),
            Some(GivenBoxes { all, .. }) => {
                let [a, b] = [i, j].map(|slot| &all[slots.names[slot] as usize]);
                a.meets(b)
            }
        };
        // Slots of moving bodies come first, as their places do.
        for i in 0..n {
            let fixed = seen.0[i] & u64::MAX.checked_shl(places.moving as u32).unwrap_or(0);
            assert!(i < places.moving || fixed == 0, "static slots are candidates: {i}");
            for j in i + 1..n {
                let may_lack = i >= places.moving || !meet(i, j);
                assert!(may_lack || seen.has(i, j), "slots {i} and {j} meet and are no candidates");
            }
        }
    }

    fn is_by_boxes(&self) -> bool {
        matches!(self, Self::Neighbours(finder) if finder.is_by_boxes())
    }

    /// Whether the cubes around two balls meet, or the balls if only those are reported.
    fn meet(&self, a: [f32; 4], b: [f32; 4]) -> bool {
        let [a, b] = [a, b].map(|ball| ball.map(f64::from));
        let apart: [f64; 3] = std::array::from_fn(|axis| (a[axis] - b[axis]).abs());
        let reach = (a[3] + b[3]) * MOST_REPORTED_RATIO;
        match self {
            Self::Neighbours(finder) if finder.volume() == Volume::Ball => {
                reach >= 0.0 && apart.iter().map(|d| d * d).sum::<f64>() <= reach * reach
            }
            _ => apart.iter().all(|&d| d <= reach),
        }
    }
}

/// Marks the candidates of all parts.
struct RecordCandidates<'a> {
    finder: &'a PairFinder,
}

impl Kernel for RecordCandidates<'_> {
    type Output = SeenPairs;
    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> SeenPairs {
        let mut seen = SeenPairs([0; MOST_BODIES]);
        self.finder.find(l, 0..self.finder.parts(), &mut seen);
        seen
    }
}

/// Pairs of slots: bit j of number i for i < j.
struct SeenPairs([u64; MOST_BODIES]);

impl SeenPairs {
    fn has(&self, i: usize, j: usize) -> bool {
        self.0[i.min(j)] >> i.max(j) & 1 == 1
    }

    fn take(&mut self, i: usize, j: usize) {
        assert!(!self.has(i, j) && i != j, "slots {i} and {j} are candidates twice");
        self.0[i.min(j)] |= 1 << i.max(j);
    }
}

impl FirstTest for SeenPairs {
    #[inline(always)]
    fn run<L: Lanes>(&mut self, _: L, i: usize, run: Range<usize>) {
        run.for_each(|j| self.take(i, j));
    }

    #[inline(always)]
    fn block<L: Lanes>(&mut self, _: L, block: &Block<'_>) {
        for &code in block.codes() {
            self.take(block.first() + (code & 15) as usize, (code >> 4) as usize);
        }
    }
}
