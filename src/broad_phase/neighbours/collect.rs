//! Building a list of neighbours from the grid's candidates: the pairs whose grown volumes touch.

use std::ops::Range;

use super::Volume;
use super::chunk::Chunk;
use super::effort::{CANDIDATES_PER_REPORT, SearchEffort};
use crate::broad_phase::{
    BLOCK_BODIES, BallTest, Block, FirstTest, MOST_CANDIDATES, SlotBodies, SlotTest,
};
use crate::rounding::skin::Reach;
use crate::rounding::{cube, sphere};
use crate::simd::{Lanes, MAX_WIDTH};

/// Balls, or the cubes that they stand for, each grown by a skin.
#[derive(Clone, Copy)]
pub struct GrownBalls<'a> {
    /// The balls, not grown.
    pub slots: SlotBodies<'a>,
    /// How the seekers' balls and the targets' balls are grown.
    pub by: [Reach; 2],
    /// The volume that balls stand for.
    pub volume: Volume,
}

impl BallTest for GrownBalls<'_> {
    #[inline(always)]
    fn slots(&self) -> SlotBodies<'_> {
        self.slots
    }

    #[inline(always)]
    fn apart<L: Lanes>(&self, l: L, between: [L::F; 3], [mine, theirs]: [L::F; 2]) -> L::M {
        let s = self.by[0].of_lanes(l, mine) + self.by[1].of_lanes(l, theirs);
        match self.volume {
            Volume::Ball => sphere::apart(l, between, s),
            Volume::Cube => cube::apart(l, between, s),
        }
    }
}

/// Tests the grid's candidates and keeps the neighbours, until there are more of either than the
/// list's limits allow.
pub struct Collector<'a, T> {
    test: &'a T,
    chunk: &'a mut Chunk,
    effort: &'a SearchEffort,
    /// Pairs and candidates that are not yet added to the shared effort.
    pairs: u64,
    candidates: u64,
    hits: [u32; MOST_CANDIDATES + MAX_WIDTH],
}

impl<'a, T: SlotTest> Collector<'a, T> {
    #[inline(always)]
    pub fn new(test: &'a T, chunk: &'a mut Chunk, effort: &'a SearchEffort) -> Self {
        Self {
            test,
            chunk,
            effort,
            pairs: 0,
            candidates: 0,
            hits: [0; MOST_CANDIDATES + MAX_WIDTH],
        }
    }

    /// Whether the search has exceeded its limits.
    #[inline(always)]
    fn is_over(&self) -> bool {
        self.effort.is_over_with(self.pairs, self.candidates)
    }

    /// Keeps the neighbours found by a test of `candidates` candidates.
    #[inline(always)]
    fn keep(&mut self, found: usize, candidates: usize) {
        self.chunk.append(&self.hits[..found]);
        self.pairs += found as u64;
        self.candidates += candidates as u64;
        if self.candidates >= CANDIDATES_PER_REPORT {
            self.finish();
        }
    }

    /// Adds the counts to the effort of all threads.
    #[inline(always)]
    pub fn finish(&mut self) {
        self.effort.add(self.pairs, self.candidates);
        (self.pairs, self.candidates) = (0, 0);
    }
}

impl<T: SlotTest> FirstTest for Collector<'_, T> {
    #[inline(always)]
    fn run<L: Lanes>(&mut self, l: L, i: usize, run: Range<usize>) {
        let holds = |first: usize| (first..first + BLOCK_BODIES).contains(&i);
        let first = match self.chunk.first().filter(|&first| holds(first)) {
            Some(first) => first,
            None => {
                self.chunk.open(i);
                i
            }
        };
        let lane = (i - first) as u32;
        let mut start = run.start;
        while start < run.end && !self.is_over() {
            let end = run.end.min(start + MOST_CANDIDATES);
            let found = self.test.run(l, i, start..end, &mut self.hits);
            for hit in &mut self.hits[..found] {
                *hit = *hit << 4 | lane;
            }
            self.keep(found, end - start);
            start = end;
        }
    }

    #[inline(always)]
    fn block<L: Lanes>(&mut self, l: L, block: &Block<'_>) {
        if self.is_over() {
            return;
        }
        if self.chunk.first() != Some(block.first()) {
            self.chunk.open(block.first());
        }
        let found = self.test.block(l, block, &mut self.hits);
        self.keep(found, block.codes().len());
    }
}

#[cfg(test)]
mod tests {
    use super::super::list::NeighbourList;
    use super::*;
    use crate::broad_phase::Slots;
    use crate::simd::{Kernel, Tier, dispatch};

    /// Passes runs of slots to a list.
    struct PassRuns<'a, 's>(Collector<'a, GrownBalls<'s>>, &'a [(usize, Range<usize>)]);

    impl Kernel for PassRuns<'_, '_> {
        type Output = ();
        fn run<L: Lanes>(mut self, l: L) {
            for (i, run) in self.1 {
                self.0.run(l, *i, run.clone());
            }
            self.0.finish();
        }
    }

    /// Collects the pairs of a list.
    struct ListedPairs(Vec<(usize, usize)>);

    impl FirstTest for ListedPairs {
        fn run<L: Lanes>(&mut self, _: L, _: usize, _: Range<usize>) {
            unreachable!("a list has blocks alone");
        }
        fn block<L: Lanes>(&mut self, _: L, block: &Block<'_>) {
            let pair = |&code: &u32| (block.first() + (code & 15) as usize, (code >> 4) as usize);
            self.0.extend(block.codes().iter().map(pair));
        }
    }

    struct FindPairs<'a>(&'a NeighbourList, &'a mut ListedPairs);

    impl Kernel for FindPairs<'_> {
        type Output = ();
        fn run<L: Lanes>(self, l: L) {
            self.0.find(l, 0..1, self.1);
        }
    }

    /// Runs of any length from any slots are kept in their order.
    #[test]
    fn runs_keep_their_order() {
        let len = 3 * MOST_CANDIDATES;
        // One in sixteen is far away, so that hits don't come in whole vectors.
        let is_far = |slot: usize| slot % 16 == 7;
        let ball = |slot| [if is_far(slot) { 9.0 } else { 1.0 }, 1.0, 1.0, 1.0];
        let slots = Slots { balls: (0..len + MAX_WIDTH).map(ball).collect(), ..Slots::default() };
        // Sixteen slots from the first one on share an entry; another before or after them opens
        // one.
        let runs = [
            (5, 6..len),
            (6, 7..9),
            (20, 40..41),
            (21, 30..30),
            (22, 30..64),
            (60, 61..61 + MOST_CANDIDATES),
            (37, 1..3),
        ];
        let all = runs.iter().flat_map(|(i, run)| run.clone().map(|j| (*i, j)));
        let seen = all.clone().count() as u64;
        let expected: Vec<_> = all.filter(|&(_, j)| !is_far(j)).collect();
        let test =
            GrownBalls { slots: slots.arranged(), by: [Reach::NONE; 2], volume: Volume::Ball };
        for tier in Tier::available() {
            let mut chunk = Chunk::default();
            let effort = SearchEffort::unlimited();
            dispatch(tier, PassRuns(Collector::new(&test, &mut chunk, &effort), &runs));
            assert_eq!((chunk.len(), effort.tested()), (expected.len(), seen));
            let mut read = ListedPairs(Vec::new());
            dispatch(tier, FindPairs(&NeighbourList::of(chunk), &mut read));
            assert!(read.0 == expected, "{tier}");
        }
    }
}
