//! Pairs stored as a list of partners per number: finding the partners of a number, adding a pair
//! and removing one does not touch other lists.

use super::runs::{Run, Runs};
use super::{PairList, bytes};
use crate::simd::prefetch;

/// A set of pairs of numbers. Each number has a sorted list of its partners.
///
/// A pair is in the lists of both of its numbers. While a frame's changes are applied it may be in
/// only one of them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Partners {
    lists: Runs<u32, 4>,
    by_number: Vec<Run>,
    /// Entries in all lists, two per pair.
    entries: usize,
}

impl Partners {
    /// The set of the pairs in a sorted list, each with its lower number first. All numbers are
    /// below `numbers`.
    pub fn of(pairs: &PairList, numbers: usize) -> Self {
        let mut partners = Self::default();
        let mut counts = vec![0_u32; numbers];
        for &number in pairs.first().iter().chain(pairs.second()) {
            counts[number as usize] += 1;
        }
        partners.by_number.resize(numbers, Run::default());
        let lengths = counts.iter().copied().filter(|&count| count > 0);
        partners.lists.reserve_growing(lengths);
        for (run, count) in partners.by_number.iter_mut().zip(counts) {
            if count > 0 {
                partners.lists.reserve(run, count as usize);
            }
        }
        // In each list, lower partners come before higher ones.
        for [i, j] in pairs.iter() {
            partners.lists.push(&mut partners.by_number[j as usize], i);
            partners.lists.push(&mut partners.by_number[i as usize], j);
        }
        partners.entries = 2 * pairs.len();
        partners
    }

    /// Whether all numbers below this one have a list.
    pub fn has_room_for(&self, numbers: usize) -> bool {
        self.by_number.len() >= numbers
    }

    /// Makes room for numbers below this one.
    pub fn extend_to(&mut self, numbers: usize) {
        if self.by_number.len() < numbers {
            self.by_number.resize(numbers, Run::default());
        }
    }

    /// The partners of a number, sorted.
    #[inline(always)]
    pub fn of_number(&self, number: u32) -> &[u32] {
        self.lists.get(self.by_number[number as usize])
    }

    /// Prefetches first the location of a number's list, then the list itself.
    #[inline(always)]
    pub fn prefetch(&self, [soon, next]: [Option<&u32>; 2]) {
        if let Some(&number) = soon {
            prefetch(&self.by_number[number as usize]);
        }
        if let Some(&number) = next {
            self.lists.prefetch(self.by_number[number as usize]);
        }
    }

    /// Replaces a number's list, and leaves those of its partners.
    pub fn replace(&mut self, number: u32, partners: &[u32]) {
        let run = &mut self.by_number[number as usize];
        self.entries = self.entries - run.len() + partners.len();
        self.lists.replace(run, partners);
    }

    /// Adds a partner to a number's list, or removes it, unless that is so already.
    pub fn set_partner(&mut self, number: u32, partner: u32, is_in: bool) {
        if self.lists.set(&mut self.by_number[number as usize], partner, is_in) {
            self.entries = if is_in { self.entries + 1 } else { self.entries - 1 };
        }
    }

    /// Whether former lists have left so much room that [`Self::compact`] pays.
    pub fn is_sparse(&self) -> bool {
        self.lists.is_sparse(self.by_number.len())
    }

    /// Frees the room that former lists have left.
    pub fn compact(&mut self) {
        self.lists.compact(self.by_number.iter_mut());
    }

    /// Number of pairs.
    pub fn len(&self) -> usize {
        self.entries / 2
    }

    /// The pairs, the lower number first, sorted.
    pub fn iter(&self) -> PartnerPairs<'_> {
        PartnerPairs { partners: self, next: 0, higher: [].iter(), left: self.len() }
    }

    /// Bytes that the lists hold.
    pub fn bytes(&self) -> usize {
        self.lists.bytes() + bytes(&self.by_number)
    }
}

/// Iterator over the pairs of [`Partners`].
#[derive(Clone, Debug)]
pub(crate) struct PartnerPairs<'a> {
    partners: &'a Partners,
    /// The number whose list comes next.
    next: u32,
    /// The rest of the previous number's list, from its higher partners on.
    higher: std::slice::Iter<'a, u32>,
    left: usize,
}

impl Iterator for PartnerPairs<'_> {
    type Item = [u32; 2];
    #[inline]
    fn next(&mut self) -> Option<[u32; 2]> {
        loop {
            if let Some(&second) = self.higher.next() {
                self.left -= 1;
                return Some([self.next - 1, second]);
            }
            let run = self.partners.by_number.get(self.next as usize)?;
            let list = self.partners.lists.get(*run);
            let lower = list.iter().take_while(|&&other| other < self.next).count();
            self.higher = list[lower..].iter();
            self.next += 1;
        }
    }
    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

impl ExactSizeIterator for PartnerPairs<'_> {}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::*;

    #[test]
    fn pairs_come_and_go_in_order() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mut draw = |n: u32| random.next_u32() % n;
        let mut wanted: BTreeSet<[u32; 2]> =
            (0..300).map(|_| [draw(40), draw(40)]).filter(|[i, j]| i < j).collect();
        let list: PairList = wanted.iter().copied().collect();
        let mut partners = Partners::of(&list, 40);
        for step in 0..2000 {
            assert!(partners.iter().eq(wanted.iter().copied()), "{step}");
            assert_eq!(partners.len(), wanted.len());
            assert_eq!(partners.iter().len(), wanted.len());
            let [i, j] = [draw(40), draw(40)];
            if i >= j {
                continue;
            }
            // Both directions, in either order.
            let has_begun = wanted.insert([i, j]) || !wanted.remove(&[i, j]);
            partners.set_partner(j, i, has_begun);
            partners.set_partner(i, j, has_begun);
        }
    }

    /// A list is replaced apart from its partners.
    #[test]
    fn replacing_leaves_partner_lists() {
        let list: PairList = [[0, 3], [1, 3], [2, 4]].into_iter().collect();
        let mut partners = Partners::of(&list, 5);
        partners.extend_to(6);
        partners.replace(3, &[1, 5]);
        partners.set_partner(0, 3, false);
        partners.set_partner(5, 3, true);
        partners.set_partner(5, 3, true);
        let pairs: Vec<_> = partners.iter().collect();
        assert_eq!(pairs, [[1, 3], [2, 4], [3, 5]]);
        assert_eq!((partners.len(), partners.of_number(3)), (3, &[1, 5][..]));
        assert!(partners.bytes() > 6 * 12);
    }
}
