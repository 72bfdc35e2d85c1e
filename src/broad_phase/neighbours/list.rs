//! The list itself: a chunk for each part of the grid's work, codes as in a [`Block`], sixteen
//! slots an entry.

use std::ops::Range;

use super::Volume;
use super::collect::{Collect, Grown};
use super::effort::Effort;
use crate::broad_phase::{Block, EndSlots, FirstTest, Grid, MOST_CANDIDATES, SlotTest, bytes};
use crate::rounding::skin::{Reach, Skin};
use crate::simd::{Kernel, Lanes, MAX_WIDTH, dispatch};
use crate::threads::Executor;

/// Pairs a body that a list with the widest skin may hold, and a few more for small scenes: crowds
/// are bound by what is reported, and there a list would take more memory than all the rest.
const PAIRS_PER_BODY: usize = 8;
const FEW_PAIRS: u64 = 256;

/// Candidates that the search for a list may test: this many times those of the grid without a
/// skin, and some per body. What a skin adds is less ([`policy`](super::policy)), unless its floor
/// is wider than the bodies.
const GROWTH_OF_CANDIDATES: u64 = 3;
const CANDIDATES_PER_BODY: u64 = 48;

/// Room that a list is given, in lengths of its own.
const ROOM: f64 = 1.5;

/// What must touch, grown by the skin, for a pair to be listed.
#[derive(Clone, Copy)]
pub enum Near<'a> {
    /// Balls, or what they stand for.
    Balls(Volume),
    /// Boxes, which have been grown.
    Ends(&'a EndSlots),
}

/// What a list may hold, and what its search may test.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Pairs.
    pub pairs: u64,
    /// Candidates.
    pub candidates: u64,
}

impl Limits {
    /// For a list of so many bodies, where the widest skin brings `spare` times the pairs and the
    /// grid without a skin has so many candidates.
    fn of(bodies: usize, candidates: u64, spare: f64) -> Self {
        let pairs = (PAIRS_PER_BODY * bodies) as f64 / spare;
        Self {
            pairs: pairs as u64 + FEW_PAIRS,
            candidates: GROWTH_OF_CANDIDATES * candidates + CANDIDATES_PER_BODY * bodies as u64,
        }
    }
}

/// What became of the search for a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The list is complete.
    Complete,
    /// There is no list: it would hold too many pairs, or its search would test too many
    /// candidates.
    Abandoned,
}

/// The list of all parts.
#[derive(Clone, Debug, Default)]
pub struct List {
    chunks: Vec<Chunk>,
    parts: usize,
    len: usize,
    /// Candidates that the search has tested, or its limit if it was abandoned.
    tested: u64,
}

/// The neighbours that one part of the grid's work has found.
#[derive(Clone, Debug, Default)]
pub struct Chunk {
    /// Codes of all entries, and a vector of whatever codes behind them.
    codes: Vec<u32>,
    len: usize,
    /// The slot of lane 0, and where the entry's codes end.
    entries: Vec<(u32, u32)>,
    /// By how much more room is made than is needed.
    spare: f64,
}

impl List {
    /// Makes the list of a grid that has just been arranged, whose bodies have so many candidates
    /// without a skin. There is room for as many pairs as the widest skin will bring, `spare` times
    /// those of this one, so that another skin allocates nothing. The search ends as soon as it
    /// exceeds its limits; whether it does depends on no thread.
    pub fn make(
        &mut self,
        executor: Executor<'_>,
        (grid, candidates): (&Grid, u64),
        (skin, spare): (Skin, f64),
        near: Near<'_>,
    ) -> Outcome {
        self.parts = grid.parts();
        if self.chunks.len() < self.parts {
            self.chunks.resize(self.parts, Chunk::default());
        }
        let effort = Effort::new(Limits::of(grid.bodies(), candidates, spare));
        let chunks = &mut self.chunks[..self.parts];
        executor.pool.each(chunks, |part, chunk| {
            chunk.clear();
            chunk.spare = spare;
            if effort.is_over() {
                return;
            }
            let make = Make {
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
            return Outcome::Abandoned;
        }
        self.len = self.chunks[..self.parts].iter().map(Chunk::len).sum();
        Outcome::Complete
    }

    /// Pairs in it.
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

    /// The slot of lane 0 of the entry that is being written, if there is one.
    #[inline(always)]
    pub fn first(&self) -> Option<usize> {
        self.entries.last().map(|&(first, _)| first as usize)
    }

    /// Opens an entry, in place of the last one if that is empty.
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

    /// Closes the list, with room for those that follow it.
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

/// Room for more: `spare` times what is needed by now, and half as much beyond that.
#[inline(always)]
fn reserve<T>(column: &mut Vec<T>, more: usize, spare: f64) {
    let needed = column.len() + more;
    if column.capacity() < needed {
        let room = (ROOM * spare * needed as f64) as usize;
        column.reserve_exact(room.max(needed) - column.len());
    }
}

/// Lists breathe from one to the next: a column that was filled to the brim would be allocated anew
/// by the next one.
fn leave_room<T>(column: &mut Vec<T>, spare: f64) {
    let [least, room] = [1.0, ROOM].map(|times| (times * spare * column.len() as f64) as usize);
    if column.capacity() < least {
        column.reserve_exact(room - column.len());
    }
}

struct Make<'a> {
    grid: &'a Grid,
    part: usize,
    near: Near<'a>,
    skin: Skin,
    chunk: &'a mut Chunk,
    effort: &'a Effort,
}

impl Kernel for Make<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        match self.near {
            Near::Balls(volume) => {
                let still = Skin::share(0.0);
                let moves = self.grid.moves(self.part);
                let by = moves.map(|moves| Reach::with_skin(if moves { self.skin } else { still }));
                let slots = self.grid.slots().arranged();
                self.collect(l, &Grown { slots, by, volume });
            }
            Near::Ends(ends) => self.collect(l, ends),
        }
    }
}

impl Make<'_> {
    #[inline(always)]
    fn collect<L: Lanes>(self, l: L, test: &impl SlotTest) {
        let mut collect = Collect::new(test, self.chunk, self.effort);
        self.grid.find(l, self.part..self.part + 1, &mut collect);
        collect.finish();
        self.chunk.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    impl List {
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

    #[test]
    fn a_column_that_is_full_gets_room_of_one_and_a_half_times_what_is_needed() {
        for (spare, more, room) in [(1.0, 1, 151), (2.0, 1, 303), (1.0, 20, 180), (0.5, 1, 101)] {
            let mut column = hundred(100);
            reserve(&mut column, more, spare);
            assert_eq!(column.capacity(), room, "{spare}, {more}");
        }
        let mut column = hundred(120);
        reserve(&mut column, 20, 2.0);
        assert_eq!(column.capacity(), 120, "what fits moves nothing");
    }

    #[test]
    fn a_list_leaves_room_for_the_next_one_where_it_has_none_to_spare() {
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

    #[test]
    fn bytes_are_those_of_all_chunks_used_or_not() {
        let mut list = List::default();
        assert_eq!(list.bytes(), 0);
        list.chunks = Vec::with_capacity(5);
        list.chunks.resize(2, Chunk::default());
        list.chunks[0].codes = Vec::with_capacity(10);
        list.chunks[1].codes = Vec::with_capacity(100);
        list.chunks[1].entries = Vec::with_capacity(1_000);
        assert_eq!(list.bytes(), 5 * size_of::<Chunk>() + 8_440);
    }
}
