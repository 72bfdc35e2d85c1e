//! Excluded pairs: bodies that are never reported as a pair, for example because a joint connects
//! them.

use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};
use std::hash::{BuildHasherDefault, Hasher};

/// A set of pairs of bodies, by their numbers. Memory and the time to drop a body are in proportion
/// to the pairs; a look-up takes the time of two hashes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct ExcludedPairs {
    /// The partners of each body that has any; each pair is at both of its bodies.
    partners: HashMap<
        u32,
        HashSet<u32, BuildHasherDefault<NumberHasher>>,
        BuildHasherDefault<NumberHasher>,
    >,
}

impl ExcludedPairs {
    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.partners.is_empty()
    }

    /// Whether it has a pair.
    #[inline]
    pub fn contains(&self, a: u32, b: u32) -> bool {
        let partners = self.partners.get(&a);
        partners.is_some_and(|partners| partners.contains(&b))
    }

    /// Adds a pair of two bodies, and returns whether it is new.
    pub fn insert(&mut self, a: u32, b: u32) -> bool {
        self.partners.entry(a).or_default().insert(b);
        self.partners.entry(b).or_default().insert(a)
    }

    /// Removes a pair, and returns whether it was there.
    pub fn remove(&mut self, a: u32, b: u32) -> bool {
        self.remove_at(a, b);
        self.remove_at(b, a)
    }

    /// Removes all pairs of a body.
    pub fn remove_all(&mut self, body: u32) {
        for partner in self.partners.remove(&body).into_iter().flatten() {
            self.remove_at(partner, body);
        }
    }

    fn remove_at(&mut self, body: u32, partner: u32) -> bool {
        let Entry::Occupied(mut partners) = self.partners.entry(body) else {
            return false;
        };
        let was_there = partners.get_mut().remove(&partner);
        if partners.get().is_empty() {
            partners.remove();
        }
        was_there
    }

    /// The pairs, the lower number first, sorted.
    pub fn sorted(&self) -> Vec<[u32; 2]> {
        let of_body = |(&body, partners): (&u32, &HashSet<u32, _>)| {
            let pairs = partners.iter().map(move |&partner| [body, partner]);
            pairs.filter(|[a, b]| a < b).collect::<Vec<_>>()
        };
        let mut pairs: Vec<_> = self.partners.iter().flat_map(of_body).collect();
        pairs.sort_unstable();
        pairs
    }
}

impl FromIterator<[u32; 2]> for ExcludedPairs {
    fn from_iter<I: IntoIterator<Item = [u32; 2]>>(pairs: I) -> Self {
        let mut all = Self::default();
        for [a, b] in pairs {
            all.insert(a, b);
        }
        all
    }
}

/// Numbers of bodies, which nobody chooses to collide.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct NumberHasher(u64);

impl Hasher for NumberHasher {
    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.write_u32(byte.into());
        }
    }

    #[inline]
    fn write_u32(&mut self, number: u32) {
        let mixed = (self.0 ^ u64::from(number)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.0 = mixed ^ mixed >> 32;
    }

    #[inline]
    fn finish(&self) -> u64 {
        self.0
    }
}

/// What decides, next to their volumes, whether two bodies are reported.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PairRules<'a> {
    /// One entry per body.
    pub groups: &'a [super::Groups],
    pub excluded: &'a ExcludedPairs,
}

/// The filters for pairs whose volumes meet, if there are any.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PairFilter<'a> {
    /// The groups by body, unless all collide with all.
    groups: Option<&'a [super::Groups]>,
    excluded: Option<&'a ExcludedPairs>,
}

impl<'a> PairFilter<'a> {
    /// None if it would let all pairs pass.
    pub fn new(groups: Option<&'a [super::Groups]>, excluded: &'a ExcludedPairs) -> Option<Self> {
        let excluded = (!excluded.is_empty()).then_some(excluded);
        let is_needed = groups.is_some() || excluded.is_some();
        is_needed.then_some(Self { groups, excluded })
    }

    /// A filter of groups alone.
    pub fn of_groups(groups: Option<&'a [super::Groups]>) -> Option<Self> {
        groups.map(|groups| Self { groups: Some(groups), excluded: None })
    }

    /// Whether two bodies may be reported as a pair.
    #[inline]
    pub fn passes(&self, a: u32, b: u32) -> bool {
        let collide =
            self.groups.is_none_or(|groups| groups[a as usize].collide(groups[b as usize]));
        collide && self.excluded.is_none_or(|excluded| !excluded.contains(a, b))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bodies::Groups;

    #[test]
    fn exclusions_are_known_at_both_bodies() {
        let mut pairs = ExcludedPairs::default();
        assert!(pairs.insert(3, 1) && !pairs.insert(1, 3) && pairs.insert(1, 7));
        assert!(pairs.contains(1, 3) && pairs.contains(3, 1) && !pairs.contains(3, 7));
        assert_eq!(pairs.sorted(), [[1, 3], [1, 7]]);
        assert!(pairs.remove(3, 1) && !pairs.remove(1, 3) && !pairs.contains(3, 1));
        assert_eq!(pairs, ExcludedPairs::from_iter([[7, 1]]));
        pairs.insert(2, 7);
        pairs.remove_all(7);
        assert!(pairs.is_empty(), "{pairs:?}");
        pairs.remove_all(7);
    }

    /// A filter is made only where it may stop a pair.
    #[test]
    fn filters_exist_where_they_matter() {
        let (none, one) = (ExcludedPairs::default(), ExcludedPairs::from_iter([[0, 1]]));
        assert!(PairFilter::new(None, &none).is_none());
        let only = |member| Groups { member, mask: 1 };
        let groups = [only(1), only(1), only(2)];
        let passes = |groups, excluded: &ExcludedPairs| {
            let filter = PairFilter::new(groups, excluded).expect("something to ask");
            [[0, 1], [1, 0], [0, 2]].map(|[a, b]| filter.passes(a, b))
        };
        assert_eq!(passes(Some(&groups), &none), [true, true, false]);
        assert_eq!(passes(None, &one), [false, false, true]);
        assert_eq!(passes(Some(&groups), &one), [false; 3]);
    }
}
