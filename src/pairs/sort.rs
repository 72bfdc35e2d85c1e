//! Sorting lists of pairs.

use super::PairList;

/// The longest list of numbers that is sorted by insertion.
const MOST_BY_INSERTION: usize = 12;

/// Buffers of [`PairList::sort`], reused for the next list.
#[derive(Clone, Debug, Default)]
pub(crate) struct PairSorter {
    /// Where the pairs of each first number begin, and then where they end.
    places: Vec<usize>,
    /// The other numbers in the order of the first ones.
    second: Vec<u32>,
}

impl PairSorter {
    /// Bytes that the buffers hold.
    pub fn bytes(&self) -> usize {
        self.places.capacity() * size_of::<usize>() + self.second.capacity() * size_of::<u32>()
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
        let PairSorter { places, second } = sorter;
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
        second.reserve_exact(size.saturating_sub(second.len()));
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

/// Sorts numbers; short lists without a function call.
#[inline(always)]
fn sort_few(numbers: &mut [u32]) {
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

    #[test]
    fn lists_are_sorted_by_both_numbers() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mut sorter = PairSorter::default();
        for (numbers, count) in [(1, 0), (2, 1), (50, 1000), (5000, 300), (3, 2000), (700, 7)] {
            let mut draw = || random.next_u32() % numbers;
            let mut list: PairList = (0..count).map(|_| [draw(), draw()]).collect();
            let wanted = list.sorted();
            for _ in 0..2 {
                list.sort(numbers as usize, &mut sorter);
                assert!(list.iter().eq(wanted.iter().copied()), "{numbers}, {count}");
            }
            // There is room for a vector after the last pair, as kernels need it.
            list.room(1);
            list.push(numbers, 0);
            assert_eq!(list.len(), wanted.len() + 1);
        }
        assert!(sorter.bytes() > 8 * 5000);
    }
}
