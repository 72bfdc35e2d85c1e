//! [`PairList`], the list of candidate or reported pairs.

mod found;
mod in_step;
mod merge;
mod partners;
mod runs;
mod sort;

pub(crate) use found::FoundPartners;
pub(crate) use in_step::out_of_step;
pub(crate) use merge::{Merge, Merged};
pub(crate) use partners::{PartnerPairs, Partners};
pub(crate) use runs::{Run, Runs};
pub(crate) use sort::{PairSorter, key, pair_of, sort_few};

use crate::simd::MAX_WIDTH;

/// The least capacity that is allocated, in pairs.
const LEAST_CAPACITY: usize = 1024;

/// Bytes that a column has allocated, used or not.
pub(crate) fn bytes<T>(column: &Vec<T>) -> usize {
    column.capacity() * size_of::<T>()
}

/// Up to this number of pairs, a list that can't get its memory ends the process, as other small
/// allocations do. Longer lists are lost: blocks and portions are shorter, and so never are.
const LEAST_LOST: usize = 1 << 18;

/// A list of body pairs, stored as two columns. It grows as needed: no pair is dropped, unless the
/// system refuses memory, which then makes the frame an error.
///
/// Kernels write a whole vector and advance by the lanes they keep, so the columns always have
/// capacity for [`MAX_WIDTH`] elements after the last pair.
#[derive(Clone, Debug, Default)]
pub struct PairList {
    first: Vec<u32>,
    second: Vec<u32>,
    len: usize,
    is_lost: bool,
}

impl PairList {
    /// Number of pairs.
    #[must_use]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether the list is empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The lower body index of every pair.
    #[must_use]
    pub fn first(&self) -> &[u32] {
        &self.first[..self.len]
    }

    /// The higher body index of every pair.
    #[must_use]
    pub fn second(&self) -> &[u32] {
        &self.second[..self.len]
    }

    /// The [`key`] of a pair by its number in the list.
    #[inline(always)]
    pub(crate) fn key_at(&self, at: usize) -> u64 {
        key([self.first()[at], self.second()[at]])
    }

    /// The pairs in list order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = [u32; 2]> + '_ {
        self.first().iter().zip(self.second()).map(|(&i, &j)| [i, j])
    }

    /// The pairs in ascending order, as in `pairs_sha256` and records.
    #[must_use]
    pub fn sorted(&self) -> Vec<[u32; 2]> {
        let mut pairs: Vec<_> = self.iter().collect();
        pairs.sort_unstable();
        pairs
    }

    /// Empties the list and keeps its memory.
    pub fn clear(&mut self) {
        (self.len, self.is_lost) = (0, false);
    }

    /// Whether pairs were dropped since the list was cleared, because there was no memory for them.
    pub(crate) fn is_lost(&self) -> bool {
        self.is_lost
    }

    /// Drops the pairs, and counts as lost, if the list on which this one depends is lost.
    pub(crate) fn lose_with(&mut self, other: &Self) {
        if other.is_lost {
            self.lose();
        }
    }

    /// Drops the pairs, since there is no memory for them or for their use.
    pub(crate) fn lose(&mut self) {
        (self.len, self.is_lost) = (0, true);
    }

    /// Appends the pair i < j.
    pub fn push(&mut self, i: u32, j: u32) {
        let (first, second) = self.room(1);
        (first[0], second[0]) = (i, j);
        self.advance(1);
    }

    /// Appends another list.
    pub fn append(&mut self, other: &Self) {
        self.append_all(std::iter::once(other));
    }

    /// Appends other lists in order, with one allocation at most.
    pub(crate) fn append_all<'a>(&mut self, others: impl Iterator<Item = &'a Self> + Clone) {
        let pairs = others.clone().map(Self::len).sum::<usize>();
        others.clone().for_each(|other| self.lose_with(other));
        let needed = self.len + pairs + MAX_WIDTH;
        if pairs == 0 || self.is_lost || needed > self.first.len() && !self.resize(needed) {
            return;
        }
        for other in others {
            let n = other.len;
            let (first, second) = self.room(n);
            first[..n].copy_from_slice(other.first());
            second[..n].copy_from_slice(other.second());
            self.advance(n);
        }
    }

    /// Appends another list if the result has at most `limit` pairs.
    pub(crate) fn append_up_to(&mut self, other: &Self, limit: usize) {
        if self.len + other.len <= limit {
            self.append(other);
        }
    }

    /// Gives back the memory after the last pair.
    pub fn shrink_to_fit(&mut self) {
        let size = if self.len == 0 { 0 } else { self.len + MAX_WIDTH };
        for column in [&mut self.first, &mut self.second] {
            column.truncate(size);
            column.shrink_to_fit();
        }
    }

    /// Bytes that the list has allocated, used or not.
    #[must_use]
    pub fn bytes(&self) -> usize {
        (self.first.capacity() + self.second.capacity()) * size_of::<u32>()
    }

    /// Replaces every index from pair `start` on by its entry in `names`.
    pub(crate) fn rename(&mut self, start: usize, names: &[u32]) {
        for column in [&mut self.first, &mut self.second] {
            for index in &mut column[start.min(self.len)..self.len] {
                *index = names[*index as usize];
            }
        }
    }

    /// Drops the pairs from number `start` on for which `keep` is false.
    pub(crate) fn keep_from(&mut self, start: usize, keep: impl Fn([u32; 2]) -> bool) {
        let mut kept = start.min(self.len); // fewer if the list was lost meanwhile
        for at in start..self.len {
            let pair = [self.first[at], self.second[at]];
            if keep(pair) {
                [self.first[kept], self.second[kept]] = pair;
                kept += 1;
            }
        }
        self.len = kept;
    }

    /// Both columns after the last pair, with room for `pairs` more pairs and one vector.
    #[inline(always)]
    pub(crate) fn room(&mut self, pairs: usize) -> (&mut [u32], &mut [u32]) {
        let needed = self.len + pairs + MAX_WIDTH;
        if needed > self.first.len() {
            self.grow(needed);
        }
        (&mut self.first[self.len..], &mut self.second[self.len..])
    }

    /// Counts the pairs written to [`Self::room`].
    #[inline(always)]
    pub(crate) fn advance(&mut self, pairs: usize) {
        self.len += pairs;
        debug_assert!(self.len + MAX_WIDTH <= self.first.len());
    }

    /// Grows by at least an eighth, so that a list that grows pair by pair is rarely copied. If
    /// there is no memory for that, the pairs so far are lost.
    #[cold]
    fn grow(&mut self, needed: usize) {
        let (eighth, room) = (self.first.len() / 8 * 9, needed - self.len);
        if !self.resize(needed.max(eighth).max(LEAST_CAPACITY)) && room > self.first.len() {
            self.resize(room);
        }
    }

    /// Whether there is memory for columns of this size. If not, the list is lost.
    fn resize(&mut self, size: usize) -> bool {
        let mut columns = [&mut self.first, &mut self.second];
        let reserved = columns.iter_mut().try_for_each(|column| {
            let more = size.saturating_sub(column.len());
            if size > LEAST_LOST {
                return column.try_reserve_exact(more);
            }
            column.reserve_exact(more);
            Ok(())
        });
        if reserved.is_ok() {
            columns.into_iter().for_each(|column| column.resize(size, 0));
        } else {
            self.lose();
        }
        reserved.is_ok()
    }
}

impl FromIterator<[u32; 2]> for PairList {
    fn from_iter<T: IntoIterator<Item = [u32; 2]>>(pairs: T) -> Self {
        let mut list = Self::default();
        for [i, j] in pairs {
            list.push(i, j);
        }
        list
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pairs from one on are kept in their order.
    #[test]
    fn kept_pairs_stay_in_order() {
        let mut list: PairList = (0..9).map(|i| [i, 20 - i]).collect();
        list.keep_from(3, |[i, j]| i % 2 == 1 && j != 15);
        let kept: Vec<_> = list.iter().collect();
        assert_eq!(kept, [[0, 20], [1, 19], [2, 18], [3, 17], [7, 13]]);
        list.keep_from(5, |_| false);
        assert_eq!(list.len(), 5);
    }

    /// A list takes little more than it needs and gives it back.
    #[test]
    fn list_memory_is_bounded() {
        let mut list = PairList::default();
        for pair in 0..100_000 {
            list.push(pair, pair + 1);
            let needed = 8 * (list.len() + MAX_WIDTH);
            assert!(list.bytes() <= (needed / 8 * 9).max(8 * LEAST_CAPACITY), "{pair}");
        }
        let mut joined = PairList::default();
        joined.append_all([&list, &list].into_iter());
        assert_eq!(joined.bytes(), 8 * (200_000 + MAX_WIDTH));
        joined.clear();
        joined.push(3, 4);
        joined.shrink_to_fit();
        assert_eq!(joined.bytes(), 8 * (1 + MAX_WIDTH));
        assert_eq!(joined.iter().collect::<Vec<_>>(), [[3, 4]]);
        joined.clear();
        joined.shrink_to_fit();
        assert_eq!(joined.bytes(), 0);
        joined.append_all([&list].into_iter());
        assert_eq!(joined.second(), list.second());
    }
}
