//! [`Block`]: the short candidate runs of sixteen neighbouring slots, packed so that they fill
//! vectors.
//!
//! At 1.5 sphere partners per body a run has one candidate on average. One vector per run would
//! leave 15 of 16 lanes idle (90 cycles per body, measured). Packed, the runs of sixteen bodies
//! fill five vectors (19 cycles).

use std::ops::Range;

use crate::simd::{Lanes, MAX_WIDTH};

/// Slots whose candidates share a block.
pub const BLOCK_BODIES: usize = MAX_WIDTH;

/// Candidates that are written at once. The next run overwrites the surplus.
const CODES_PER_STORE: usize = 8;

/// The longest run that is copied into a block; longer ones fill vectors by themselves.
const LONGEST_WRITTEN: usize = 2 * CODES_PER_STORE;

/// Short runs that fit on a page.
const RUNS_PER_PAGE: usize = 160;

/// Codes that fit on a page.
const CODES_PER_PAGE: usize = RUNS_PER_PAGE * LONGEST_WRITTEN;

/// The most candidates in a block.
pub const MOST_CANDIDATES: usize = CODES_PER_PAGE;

/// Candidate pairs of up to sixteen neighbouring slots.
#[derive(Clone, Copy, Debug)]
pub struct Block<'a> {
    first: usize,
    codes: &'a [u32],
    padded: &'a [u32],
}

impl<'a> Block<'a> {
    /// A block of the candidates `padded[..len]` of the slots from `first` on. One vector of
    /// arbitrary codes follows them.
    #[inline(always)]
    pub(crate) fn new(first: usize, padded: &'a [u32], len: usize) -> Self {
        Self { first, codes: &padded[..len], padded: &padded[..len + MAX_WIDTH] }
    }

    /// The first slot, that of lane 0.
    #[inline(always)]
    pub fn first(&self) -> usize {
        self.first
    }

    /// The candidates as codes: `slot·16 + lane` is the pair (first slot + lane, slot). There are
    /// at most [`MOST_CANDIDATES`].
    #[inline(always)]
    pub fn codes(&self) -> &'a [u32] {
        self.codes
    }

    /// The codes and one vector of arbitrary codes after them.
    #[inline(always)]
    pub fn padded_codes(&self) -> &'a [u32] {
        self.padded
    }

    /// A vector of codes from number `start` on with the balls of their pairs: first those of the
    /// block's own slots, which `ours` has in columns, then the others.
    #[inline(always)]
    pub fn balls<L: Lanes>(
        &self,
        l: L,
        start: usize,
        ours: &[[f32; MAX_WIDTH]; 4],
        balls: &[[f32; 4]],
    ) -> (L::I, [[L::F; 4]; 2]) {
        let codes = &self.padded[start..];
        let code = l.load_u32(codes);
        let (_, lane) = l.split_u32(code);
        let [x, y, z, r] = ours;
        let one = [
            l.lookup_16(x, lane),
            l.lookup_16(y, lane),
            l.lookup_16(z, lane),
            l.lookup_16(r, lane),
        ];
        (code, [one, l.gather_quads(balls, codes)])
    }
}

/// The memory in which a search writes a block, and a list of long runs.
#[derive(Clone, Debug)]
pub struct BlockPage {
    first: usize,
    len: usize,
    codes: [u32; CODES_PER_PAGE + MAX_WIDTH],
    long_len: usize,
    long: [(u32, u32, u32); RUNS_PER_PAGE],
}

impl BlockPage {
    /// An empty page.
    #[inline(always)]
    pub fn new() -> Self {
        Self {
            first: 0,
            len: 0,
            codes: [0; CODES_PER_PAGE + MAX_WIDTH],
            long_len: 0,
            long: [(0, 0, 0); RUNS_PER_PAGE],
        }
    }

    /// The short runs.
    #[inline(always)]
    pub fn block(&self) -> Block<'_> {
        Block::new(self.first, &self.codes, self.len)
    }

    /// Long runs, each with the slot whose candidates they are.
    #[inline(always)]
    pub fn long_runs(&self) -> impl Iterator<Item = (usize, Range<usize>)> + '_ {
        let long = &self.long[..self.long_len];
        long.iter().map(|&(i, start, end)| (i as usize, start as usize..end as usize))
    }

    /// Empties the page for the slots from `first` on, and returns a writer for their runs.
    #[inline(always)]
    pub fn restart(&mut self, first: usize) -> RunWriter<'_> {
        self.first = first;
        RunWriter { page: self, len: 0, long_len: 0 }
    }
}

/// Writes runs to a page. Its position is held in local variables, which stay in registers: if it
/// were in the page, each run would wait for the previous one's store (25 cycles per body,
/// measured).
pub struct RunWriter<'a> {
    page: &'a mut BlockPage,
    len: usize,
    long_len: usize,
}

impl RunWriter<'_> {
    /// Appends the slots of `run` as candidates of the slot in `lane`.
    #[inline(always)]
    pub fn push(&mut self, lane: usize, run: Range<u32>) {
        let length = run.end.wrapping_sub(run.start) as usize;
        let code = run.start << 4 | lane as u32;
        self.write(0, code);
        if length <= CODES_PER_STORE {
            self.len += length;
        } else if length <= LONGEST_WRITTEN {
            self.write(CODES_PER_STORE, code);
            self.len += length;
        } else {
            self.push_long(lane, run);
        }
    }

    /// Appends the slots of `run` as candidates of the slot in `lane`, as a run however long it is.
    #[inline(always)]
    pub fn push_long(&mut self, lane: usize, run: Range<u32>) {
        let slot = self.page.first + lane;
        self.page.long[self.long_len] = (slot as u32, run.start, run.end);
        self.long_len += 1;
    }

    #[inline(always)]
    fn write(&mut self, skip: usize, code: u32) {
        let at = self.len + skip;
        if let Some(codes) = self.page.codes.get_mut(at..at + CODES_PER_STORE) {
            for (i, to) in codes.iter_mut().enumerate() {
                *to = code.wrapping_add(((skip + i) << 4) as u32);
            }
        }
    }

    /// Whether `runs` more runs might not fit.
    #[inline(always)]
    pub fn is_full(&self, runs: usize) -> bool {
        self.len + runs * LONGEST_WRITTEN > CODES_PER_PAGE || self.long_len + runs > RUNS_PER_PAGE
    }

    /// Closes the page.
    #[inline(always)]
    pub fn done(self) {
        (self.page.len, self.page.long_len) = (self.len, self.long_len);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs of any length follow each other without gaps.
    #[test]
    fn runs_are_packed_without_gaps() {
        let mut page = BlockPage::new();
        let mut pen = page.restart(64);
        let (mut short, mut long) = (Vec::new(), Vec::new());
        for (lane, length) in [0, 1, 7, 8, 9, 16, 0, 17, 15, 300, 2].into_iter().enumerate() {
            assert!(!pen.is_full(1));
            let start = 1000 * lane as u32;
            pen.push(lane, start..start + length);
            if length <= 16 {
                short.extend((start..start + length).map(|slot| (slot << 4) | lane as u32));
            } else {
                long.push((64 + lane, start as usize..(start + length) as usize));
            }
        }
        pen.done();
        assert_eq!(page.block().codes(), short);
        assert_eq!(page.long_runs().collect::<Vec<_>>(), long);
        assert_eq!(page.block().padded_codes().len(), short.len() + MAX_WIDTH);
    }

    #[test]
    fn a_block_takes_what_it_promises() {
        let mut page = BlockPage::new();
        for length in [16, 17] {
            let mut pen = page.restart(0);
            let mut runs = 0;
            while !pen.is_full(1) {
                pen.push(15, 7..7 + length);
                runs += 1;
            }
            pen.done();
            assert_eq!(runs, RUNS_PER_PAGE);
        }
        assert!(page.block().codes().is_empty());
    }
}
