//! [`NeighbourList`]: one chunk per part of the grid's work, with codes as in a [`Block`] and one
//! entry per sixteen slots.

use std::ops::Range;

use super::Volume;
use super::collect::{Collector, GrownBalls};
use super::effort::SearchEffort;
use crate::broad_phase::{Block, EndSlots, FirstTest, Grid, MOST_CANDIDATES, SlotTest, bytes};
use crate::rounding::skin::{Reach, Skin};
use crate::simd::{Kernel, Lanes, MAX_WIDTH, dispatch};
use crate::threads::Executor;

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

/// Capacity of a list relative to its length.
const CAPACITY_FACTOR: f64 = 1.5;

/// The volumes that must touch, grown by the skin, for a pair to be listed.
#[derive(Clone, Copy)]
pub enum ListedVolume<'a> {
    /// Balls, or what they stand for.
    Balls(Volume),
    /// Boxes, already grown.
    Ends(&'a EndSlots),
}

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
    fn of(bodies: usize, candidates: u64, spare: f64) -> Self {
        let pairs = (PAIRS_PER_BODY * bodies) as f64 / spare;
        Self {
            pairs: pairs as u64 + SPARE_PAIRS,
            candidates: GROWTH_OF_CANDIDATES * candidates + CANDIDATES_PER_BODY * bodies as u64,
        }
    }
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

/// The neighbours found by one part of the grid's work.
#[derive(Clone, Debug, Default)]
pub struct Chunk {
    /// The codes of all entries, followed by a vector of arbitrary codes.
    codes: Vec<u32>,
    len: usize,
    /// For each entry, the slot of lane 0 and the end of its codes.
    entries: Vec<(u32, u32)>,
    /// The capacity to allocate, relative to the need.
    spare: f64,
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
            let make = BuildList {
                grid,
                part,
                near,
                skin,
                chunk,
                effort: &effort,
            };
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

impl Chunk {
    fn clear(&mut self) {
        self.codes.clear();
        self.entries.clear();
        self.len = 0;
    }

    /// The slot of lane 0 of the open entry, if there is one.
    #[inline(always)]
    pub fn first(&self) -> Option<usize> {
        self.entries.last().map(|&(first, _)| first as usize)
    }

    /// Opens an entry, replacing the last one if that is empty.
    #[inline(always)]
    pub fn open(&mut self, first: usize) {
        if self
            .entries
            .last()
            .is_some_and(|&(_, end)| end as usize == self.len)
        {
            let before = self.entries.len().checked_sub(2);
            let start = before.map_or(0, |before| self.entries[before].1 as usize);
            if start == self.len {
                self.entries.pop();
            }
        }
        reserve(&mut self.entries, 1, 1.0);
        self.entries.push((first as u32, self.len as u32));
    }

    /// Appends codes to the open entry.
    #[inline(always)]
    pub fn append(&mut self, codes: &[u32]) {
        reserve(&mut self.codes, codes.len() + MAX_WIDTH, self.spare);
        self.codes.extend_from_slice(codes);
        self.len += codes.len();
        if let Some((_, end)) = self.entries.last_mut() {
            *end = self.len as u32;
        }
    }

    /// Completes the list, and reserves room for the following ones.
    fn close(&mut self) {
        reserve(&mut self.codes, MAX_WIDTH, self.spare);
        self.codes.resize(self.len + MAX_WIDTH, 0);
        leave_room(&mut self.codes, self.spare);
        leave_room(&mut self.entries, 1.0);
    }

    /// How many pairs it holds.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.len
    }
}

/// Reserves room: `spare` times what is needed so far, and half as much again.
#[inline(always)]
fn reserve<T>(column: &mut Vec<T>, more: usize, spare: f64) {
    let needed = column.len() + more;
    if column.capacity() < needed {
        let room = (CAPACITY_FACTOR * spare * needed as f64) as usize;
        column.reserve_exact(room.max(needed) - column.len());
    }
}

/// Reserves room in a full column, because the next list may be slightly longer and would allocate.
fn leave_room<T>(column: &mut Vec<T>, spare: f64) {
    let [least, room] =
        [1.0, CAPACITY_FACTOR].map(|times| (times * spare * column.len() as f64) as usize);
    if column.capacity() < least {
        column.reserve_exact(room - column.len());
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
        /// Of one part.
        pub(in crate::broad_phase) fn of(mut chunk: Chunk) -> Self {
            chunk.close();
            Self {
                parts: 1,
                len: chunk.len,
                tested: 0,
                chunks: vec![chunk],
            }
        }
    }

    /// Numbers with room for more of them.
    fn hundred(room: usize) -> Vec<u32> {
        let mut column = Vec::with_capacity(room);
        column.extend([0; 100]);
        column
    }

    /// A column that is full gets room of one and a half times what is needed.
    #[test]
    fn full_column_grows_by_half() {
        for (spare, more, room) in [(1.0, 1, 151), (2.0, 1, 303), (1.0, 20, 180), (0.5, 1, 101)] {
            let mut column = hundred(100);
            reserve(&mut column, more, spare);
            assert_eq!(column.capacity(), room, "{spare}, {more}");
        }
        let mut column = hundred(120);
        reserve(&mut column, 20, 2.0);
        assert_eq!(column.capacity(), 120, "what fits moves nothing");
    }

    /// A list leaves room for the next one where it has none to spare.
    #[test]
    fn full_list_leaves_room() {
        for (capacity, spare, room) in [
            (100, 1.0, 100),
            (199, 2.0, 300),
            (200, 2.0, 200),
            (300, 2.0, 300),
        ] {
            let mut column = hundred(capacity);
            leave_room(&mut column, spare);
            assert_eq!(column.capacity(), room, "{capacity}, {spare}");
        }
    }

    #[test]
    fn entries_without_neighbours_are_overwritten() {
        let mut chunk = Chunk {
            spare: 1.0,
            ..Chunk::default()
        };
        assert_eq!(chunk.first(), None);
        for (first, codes) in [
            (0, &[][..]),
            (16, &[7, 8]),
            (32, &[]),
            (48, &[]),
            (64, &[9]),
        ] {
            chunk.open(first);
            assert_eq!(chunk.first(), Some(first));
            chunk.append(codes);
        }
        chunk.open(80);
        chunk.close();
        assert_eq!(chunk.entries, [(16, 2), (64, 3), (80, 3)]);
        assert_eq!((chunk.len(), &chunk.codes[..3]), (3, &[7, 8, 9][..]));
        assert_eq!(chunk.codes.len(), 3 + MAX_WIDTH);
    }

    /// Bytes are those of all chunks used or not.
    #[test]
    fn bytes_count_all_chunks() {
        let mut list = NeighbourList::default();
        assert_eq!(list.bytes(), 0);
        list.chunks = Vec::with_capacity(5);
        list.chunks.resize(2, Chunk::default());
        list.chunks[0].codes = Vec::with_capacity(10);
        list.chunks[1].codes = Vec::with_capacity(100);
        list.chunks[1].entries = Vec::with_capacity(1_000);
        assert_eq!(list.bytes(), 5 * size_of::<Chunk>() + 8_440);
    }
}
