//! Lists of candidate or reported pairs.

use crate::simd::MAX_WIDTH;

/// A list of body pairs as two columns. It grows as needed: a pair is never dropped for want of room.
///
/// Kernels write a whole vector and then advance by the lanes they kept, so the columns always have
/// [`MAX_WIDTH`] elements of room behind the last pair.
#[derive(Clone, Debug, Default)]
pub struct PairList {
    first: Vec<u32>,
    second: Vec<u32>,
    len: usize,
}

impl PairList {
    /// Number of pairs.
    #[must_use]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there is none.
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

    /// The pairs in list order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = [u32; 2]> + '_ {
        self.first()
            .iter()
            .zip(self.second())
            .map(|(&i, &j)| [i, j])
    }

    /// The pairs sorted, as `pairs_sha256` and records want them.
    #[must_use]
    pub fn sorted(&self) -> Vec<[u32; 2]> {
        let mut pairs: Vec<_> = self.iter().collect();
        pairs.sort_unstable();
        pairs
    }

    /// Empties the list and keeps its room.
    pub fn clear(&mut self) {
        self.len = 0;
    }

    /// Appends the pair i < j.
    pub fn push(&mut self, i: u32, j: u32) {
        let (first, second) = self.room(1);
        (first[0], second[0]) = (i, j);
        self.advance(1);
    }

    /// Appends another list.
    pub fn append(&mut self, other: &Self) {
        let n = other.len;
        let (first, second) = self.room(n);
        first[..n].copy_from_slice(other.first());
        second[..n].copy_from_slice(other.second());
        self.advance(n);
    }

    /// Replaces every index from pair `start` on by its entry in `names`.
    pub(crate) fn rename(&mut self, start: usize, names: &[u32]) {
        for column in [&mut self.first, &mut self.second] {
            for index in &mut column[start..self.len] {
                *index = names[*index as usize];
            }
        }
    }

    /// Both columns behind the last pair, with room for `pairs` of them and a vector more.
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

    #[cold]
    fn grow(&mut self, needed: usize) {
        let size = needed.next_power_of_two().max(1024);
        self.first.resize(size, 0);
        self.second.resize(size, 0);
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

    #[test]
    fn a_list_grows_past_any_room_and_keeps_every_pair() {
        let pairs: Vec<_> = (0..5000u32).map(|i| [i, 2 * i + 1]).collect();
        let list: PairList = pairs.iter().copied().collect();
        assert_eq!(list.iter().collect::<Vec<_>>(), pairs);
        let mut twice = list.clone();
        twice.append(&list);
        assert_eq!(twice.len(), 10_000);
        assert_eq!(twice.first()[9_999], 4_999);
    }
}
