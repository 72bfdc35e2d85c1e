//! Sorting lists of pairs.

use super::{PairList, bytes};

/// The longest list of numbers that is sorted by insertion.
const MOST_BY_INSERTION: usize = 12;

/// Up to this number of pairs per number, pairs are sorted as keys. Lists per number are then so
/// short that the branches of a sort of each would cost more than all else.
const MOST_AS_KEYS: usize = 4;

/// Buffers of [`PairList::sort`], reused for the next list.
#[derive(Clone, Debug, Default)]
pub(crate) struct PairSorter {
    /// Where the pairs of each first number begin, and then where they end.
    places: Vec<usize>,
    /// The other numbers in the order of the first ones.
    second: Vec<u32>,
    /// The same as `places` and `second` where pairs are few.
    key_places: Vec<u32>,
    keys: Vec<u64>,
}

/// A pair as one number, in the order of pairs.
pub(crate) fn key([first, second]: [u32; 2]) -> u64 {
    u64::from(first) << 32 | u64::from(second)
}

/// The pair of a [`key`].
pub(crate) fn pair_of(key: u64) -> [u32; 2] {
    [(key >> 32) as u32, key as u32]
}

impl PairSorter {
    /// Bytes that the buffers hold.
    pub fn bytes(&self) -> usize {
        bytes(&self.places) + bytes(&self.second) + bytes(&self.key_places) + bytes(&self.keys)
    }
}

impl PairList {
    /// Sorts the pairs by their first number, then by their second. All numbers are below
    /// `numbers`.
    ///
    /// This is a counting sort by the first number, followed by a sort of the few pairs of each
    /// first number. A list that is in order already is left as it is.
    pub(crate) fn sort(&mut self, numbers: usize, sorter: &mut PairSorter) {
        if self.iter().is_sorted() {
            return;
        }
        if self.are_sorted_as_keys(numbers) {
            self.sort_as_keys(numbers, sorter);
        } else {
            self.sort_by_number(numbers, sorter);
        }
    }

    /// The keys of the pairs in ascending order, without a change to the list. `None` if there are
    /// so many pairs per number that [`Self::sort`] doesn't sort keys. All numbers are below
    /// `numbers`.
    pub(crate) fn sorted_keys(&self, numbers: usize, sorter: &mut PairSorter) -> Option<Vec<u64>> {
        self.are_sorted_as_keys(numbers).then(|| {
            self.sort_keys(numbers, sorter);
            sorter.keys[..self.len].to_vec()
        })
    }

    fn are_sorted_as_keys(&self, numbers: usize) -> bool {
        let most = MOST_AS_KEYS.saturating_mul(numbers).min(u32::MAX as usize);
        self.len <= most
    }

    /// Sorts at most 2³² pairs as numbers of 64 bits.
    fn sort_as_keys(&mut self, numbers: usize, sorter: &mut PairSorter) {
        self.sort_keys(numbers, sorter);
        let columns = self.first.iter_mut().zip(&mut self.second);
        for (&key, (first, second)) in sorter.keys.iter().zip(columns) {
            [*first, *second] = pair_of(key);
        }
    }

    /// Makes the sorter's keys those of this list, sorted.
    fn sort_keys(&self, numbers: usize, sorter: &mut PairSorter) {
        let PairSorter { key_places: places, keys, .. } = sorter;
        places.clear();
        places.resize(numbers, 0);
        for &first in self.first() {
            places[first as usize] += 1;
        }
        let has_long_list = places.iter().any(|&count| count > MOST_BY_INSERTION as u32);
        let mut start = 0;
        for place in &mut *places {
            start += std::mem::replace(place, start);
        }
        keys.reserve_exact(self.len.saturating_sub(keys.len()));
        keys.resize(self.len, 0);
        for [i, j] in self.iter() {
            let place = &mut places[i as usize];
            keys[*place as usize] = key([i, j]);
            *place += 1;
        }
        if has_long_list {
            sort_long_lists(keys, places);
        }
        sort_nearly_sorted(keys);
    }

    /// Sorts the second numbers of each first number on their own.
    fn sort_by_number(&mut self, numbers: usize, sorter: &mut PairSorter) {
        let PairSorter { places, second, .. } = sorter;
        places.clear();
        places.resize(numbers, 0);
        for &first in self.first() {
            places[first as usize] += 1;
        }
        let mut start = 0;
        for place in &mut *places {
            start += std::mem::replace(place, start);
        }
        let size = self.first.len();
        if second.try_reserve_exact(size.saturating_sub(second.len())).is_err() {
            return self.sort_in_place();
        }
        second.resize(size, 0);
        for [i, j] in self.iter() {
            let place = &mut places[i as usize];
            second[*place] = j;
            *place += 1;
        }
        std::mem::swap(&mut self.second, second);
        let mut start = 0;
        for (first, &end) in (0..).zip(&*places) {
            if end - start == 1 {
                self.first[start] = first;
            } else if end > start {
                self.first[start..end].fill(first);
                sort_few(&mut self.second[start..end]);
            }
            start = end;
        }
    }
}

impl PairList {
    /// Sorts by a heap, which takes long and no memory.
    #[cold]
    fn sort_in_place(&mut self) {
        for end in (0..2 * self.len).rev() {
            // First pairs become a heap, from the last one on; then the largest pair of the heap
            // moves to its end, until none is left.
            let (mut at, end) = if end < self.len {
                self.swap(0, end);
                (0, end)
            } else {
                (end - self.len, self.len)
            };
            while let Some(child) =
                (2 * at + 1..end.min(2 * at + 3)).max_by_key(|&at| self.key_at(at))
                && self.key_at(at) < self.key_at(child)
            {
                self.swap(at, child);
                at = child;
            }
        }
    }

    fn swap(&mut self, a: usize, b: usize) {
        self.first.swap(a, b);
        self.second.swap(a, b);
    }
}

/// Sorts those lists of keys, of which the ends are given, that are too long for insertion: a body
/// as large as the ground meets nearly all others.
#[cold]
fn sort_long_lists(keys: &mut [u64], ends: &[u32]) {
    let mut start = 0;
    for end in ends.iter().map(|&end| end as usize) {
        if end - start > MOST_BY_INSERTION {
            keys[start..end].sort_unstable();
        }
        start = end;
    }
}

/// Sorts keys of which each is fewer than [`MOST_BY_INSERTION`] places from its own. The first pass
/// has no branch that depends on them, and leaves few keys that have to move.
fn sort_nearly_sorted(keys: &mut [u64]) {
    let Some((&first, _)) = keys.split_first() else {
        return;
    };
    let mut greatest = first;
    for at in 1..keys.len() {
        let key = keys[at];
        keys[at - 1] = greatest.min(key);
        greatest = greatest.max(key);
    }
    if let Some(last) = keys.last_mut() {
        *last = greatest;
    }
    for end in 1..keys.len() {
        let key = keys[end];
        let mut at = end;
        while at > 0 && keys[at - 1] > key {
            keys[at] = keys[at - 1];
            at -= 1;
        }
        debug_assert!(end - at < MOST_BY_INSERTION, "{} places", end - at);
        keys[at] = key;
    }
}

/// Sorts numbers; short lists without a function call.
#[inline(always)]
pub(crate) fn sort_few(numbers: &mut [u32]) {
    if numbers.len() > MOST_BY_INSERTION {
        return numbers.sort_unstable();
    }
    for end in 1..numbers.len() {
        let mut at = end;
        while at > 0 && numbers[at - 1] > numbers[at] {
            numbers.swap(at - 1, at);
            at -= 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::*;

    /// One body that meets nearly all others: none of its pairs moves by insertion.
    #[test]
    fn pairs_of_a_hub_are_sorted() {
        let mut random = ChaCha8Rng::seed_from_u64(2);
        let mut partners: Vec<u32> = (8..3000).collect();
        for at in 1..partners.len() {
            partners.swap(at, random.next_u32() as usize % (at + 1));
        }
        let of_ground = partners.iter().map(|&partner| [7, partner]);
        let others = (8..2900).map(|body| [body, body + 1]);
        let mut list: PairList = others.chain(of_ground).collect();
        let wanted = list.sorted();
        list.sort(3000, &mut PairSorter::default());
        assert!(list.iter().eq(wanted));
    }

    #[test]
    fn lists_are_sorted_by_both_numbers() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mut sorter = PairSorter::default();
        let sizes = [(1, 0), (2, 1), (50, 1000), (5000, 300), (3, 2000), (700, 7)];
        for (numbers, count) in sizes.into_iter().chain([(300, 1200), (300, 1201)]) {
            let mut draw = || random.next_u32() % numbers;
            let mut list: PairList = (0..count).map(|_| [draw(), draw()]).collect();
            let wanted = list.sorted();
            let mut in_place = list.clone();
            in_place.sort_in_place();
            assert!(in_place.iter().eq(wanted.iter().copied()));
            for _ in 0..2 {
                list.sort(numbers as usize, &mut sorter);
                assert!(list.iter().eq(wanted.iter().copied()), "{numbers}, {count}");
            }
            // There is room for a vector after the last pair, as kernels need it.
            list.room(1);
            list.push(numbers, 0);
            assert_eq!(list.len(), wanted.len() + 1);
        }
        assert!(sorter.bytes() > 4 * 5000 + 8 * 1200);
    }
}
