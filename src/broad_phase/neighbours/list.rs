//! [`NeighbourList`]: one chunk per part of the grid's work, with codes as in a [`Block`] and one
//! entry per sixteen slots.

use std::ops::Range;

use super::Volume;
use super::chunk::Chunk;
use super::collect::{Collector, GrownBalls};
use super::effort::{SearchEffort, SearchLimits};
use crate::broad_phase::{Block, EndSlots, FirstTest, Grid, MOST_CANDIDATES, SlotTest, bytes};
use crate::rounding::skin::{Reach, Skin};
use crate::simd::{Kernel, Lanes, dispatch};
use crate::threads::Executor;

/// The volumes that must touch, grown by the skin, for a pair to be listed.
#[derive(Clone, Copy)]
pub enum ListedVolume<'a> {
    /// Balls, or what they stand for.
    Balls(Volume),
    /// Boxes, already grown.
    Ends(&'a EndSlots),
}

/// The result of the search for a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SearchOutcome {
    /// The list is complete.
    Complete,
    /// There is no list: it would hold too many pairs, or its search would test too many
    /// candidates.
    Abandoned,
}

/// The list of all parts.
#[derive(Clone, Debug, Default)]
pub struct NeighbourList {
    chunks: Vec<Chunk>,
    parts: usize,
    len: usize,
    /// Candidates that the search has tested, or its limit if it was abandoned.
    tested: u64,
}

impl NeighbourList {
    /// Builds the list of a grid that has just been arranged and has `candidates` candidates
    /// without a skin. There is room for `spare` times the pairs of this skin, as many as the
    /// widest skin will give, so that another skin allocates nothing. The search ends as soon as it
    /// exceeds its limits; whether it does is independent of threads.
    pub fn make(
        &mut self,
        executor: Executor<'_>,
        (grid, candidates): (&Grid, u64),
        (skin, spare): (Skin, f64),
        near: ListedVolume<'_>,
    ) -> SearchOutcome {
        self.parts = grid.parts();
        if self.chunks.len() < self.parts {
            self.chunks.resize(self.parts, Chunk::default());
        }
        let effort = SearchEffort::new(SearchLimits::of(grid.bodies(), candidates, spare));
        let chunks = &mut self.chunks[..self.parts];
        executor.pool.each(chunks, |part, chunk| {
            chunk.clear();
            chunk.spare = spare;
            if effort.is_over() {
                return;
            }
            let make = BuildList { grid, part, near, skin, chunk, effort: &effort };
            dispatch(executor.tier, make);
        });
        effort.check(executor.pool.threads());
        self.tested = effort.tested();
        if effort.is_over() {
            return SearchOutcome::Abandoned;
        }
        self.len = self.chunks[..self.parts].iter().map(Chunk::len).sum();
        SearchOutcome::Complete
    }

    /// The number of pairs.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Candidates that the search for it has tested; the limit, if it was abandoned.
    pub fn tested(&self) -> u64 {
        self.tested
    }

    pub fn bytes(&self) -> usize {
        let chunk = |chunk: &Chunk| bytes(&chunk.codes) + bytes(&chunk.entries);
        bytes(&self.chunks) + self.chunks.iter().map(chunk).sum::<usize>()
    }

    pub fn parts(&self) -> usize {
        self.parts
    }

    #[inline(always)]
    pub fn find<L: Lanes>(&self, l: L, parts: Range<usize>, test: &mut impl FirstTest) {
        for chunk in &self.chunks[parts] {
            let mut start = 0;
            for &(first, end) in &chunk.entries {
                while start < end as usize {
                    let len = (end as usize - start).min(MOST_CANDIDATES);
                    test.block(l, &Block::new(first as usize, &chunk.codes[start..], len));
                    start += len;
                }
            }
        }
    }
}

struct BuildList<'a> {
    grid: &'a Grid,
    part: usize,
    near: ListedVolume<'a>,
    skin: Skin,
    chunk: &'a mut Chunk,
    effort: &'a SearchEffort,
}

impl Kernel for BuildList<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        match self.near {
            ListedVolume::Balls(volume) => {
                let still = Skin::share(0.0);
                let moves = self.grid.moves(self.part);
                let by = moves.map(|moves| Reach::with_skin(if moves { self.skin } else { still }));
                let slots = self.grid.slots().arranged();
                self.collect(l, &GrownBalls { slots, by, volume });
            }
            ListedVolume::Ends(ends) => self.collect(l, ends),
        }
    }
}

impl BuildList<'_> {
    #[inline(always)]
    fn collect<L: Lanes>(self, l: L, test: &impl SlotTest) {
        let mut collect = Collector::new(test, self.chunk, self.effort);
        self.grid.find(l, self.part..self.part + 1, &mut collect);
        collect.finish();
        self.chunk.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    impl NeighbourList {
        /// A list with a single part.
        pub(in crate::broad_phase) fn of(mut chunk: Chunk) -> Self {
            chunk.close();
            Self { parts: 1, len: chunk.len(), tested: 0, chunks: vec![chunk] }
        }
    }
}
