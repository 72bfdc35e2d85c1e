//! Scattered candidates: the short runs of sixteen neighbouring slots, gathered so that they fill vectors.
//!
//! At 1.5 sphere partners a body a run holds one candidate in the mean. A vector a run then leaves 15 of 16 lanes idle
//! (90 cycles a body, measured); written one behind the other, the runs of sixteen bodies fill five vectors (19 cycles).

use crate::simd::MAX_WIDTH;

/// Slots whose candidates share a block.
pub const BLOCK_BODIES: usize = 16;

/// Candidates that are written at once; a run's surplus is overwritten by the next.
const STRIDE: usize = 8;

/// Room for candidates.
const CAPACITY: usize = 1024;

/// Candidate pairs of up to sixteen neighbouring slots: `slot·16 + lane` stands for (first slot + lane, slot).
#[derive(Clone, Debug)]
pub struct Block {
    first: usize,
    len: usize,
    codes: [u32; CAPACITY + MAX_WIDTH],
}

impl Block {
    /// The longest run that may be pushed; longer ones fill vectors by themselves.
    pub const LONGEST_RUN: usize = 16;

    /// An empty block for the slots from `first` on.
    #[inline(always)]
    #[allow(
        clippy::new_without_default,
        reason = "made once a search, never as a part that defaults"
    )]
    pub fn new() -> Self {
        Self {
            first: 0,
            len: 0,
            codes: [0; CAPACITY + MAX_WIDTH],
        }
    }

    /// The slot of lane 0.
    #[inline(always)]
    pub fn first(&self) -> usize {
        self.first
    }

    /// The codes, padded by a vector of valid ones.
    #[inline(always)]
    pub fn codes(&self) -> &[u32] {
        &self.codes[..self.len + MAX_WIDTH]
    }

    /// Number of candidates.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there is none.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Starts over at the slots from `first` on.
    #[inline(always)]
    pub fn restart(&mut self, first: usize) {
        (self.first, self.len) = (first, 0);
    }

    /// Whether `runs` more runs might not find room.
    #[inline(always)]
    pub fn is_full(&self, runs: usize) -> bool {
        self.len + runs * Self::LONGEST_RUN > CAPACITY
    }

    /// Appends the slots from `start` on, `length` of them, as candidates of `lane`.
    #[inline(always)]
    pub fn push(&mut self, lane: usize, start: u32, length: usize) {
        debug_assert!(lane < BLOCK_BODIES && length <= Self::LONGEST_RUN);
        let code = start << 4 | lane as u32;
        self.write(0, code);
        if length > STRIDE {
            self.write(STRIDE, code);
        }
        self.len += length;
    }

    #[inline(always)]
    fn write(&mut self, skip: usize, code: u32) {
        if let Some(codes) = self.codes[self.len + skip..].first_chunk_mut::<STRIDE>() {
            for (i, to) in codes.iter_mut().enumerate() {
                *to = code + ((skip + i) << 4) as u32;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_of_any_length_follow_each_other_without_gaps() {
        let mut block = Block::new();
        block.restart(64);
        let mut expected = Vec::new();
        for (lane, length) in [0, 1, 7, 8, 9, 16, 0, 15].into_iter().enumerate() {
            assert!(!block.is_full(1));
            block.push(lane, 100 * lane as u32, length);
            expected.extend((0..length).map(|i| (100 * lane + i) << 4 | lane));
        }
        let codes: Vec<usize> = block.codes()[..block.len()]
            .iter()
            .map(|&code| code as usize)
            .collect();
        assert_eq!(codes, expected);
        while !block.is_full(1) {
            block.push(15, 7, 16);
        }
        assert!(block.len() > CAPACITY - 32 && block.codes().len() == block.len() + MAX_WIDTH);
    }
}
