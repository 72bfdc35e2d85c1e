//! The changes between two lists of pairs that were found in nearly the same order.
//!
//! As long as a finder follows one list of neighbours, the pairs of each cull are in the order of
//! that list. Their changes are then found in one pass over both lists, neither of which is sorted.
//! Where the order differs, a pair may be found both as ended and as begun. Such entries cancel
//! each other, so the result is right for lists in any order.

use crate::pairs::PairList;

/// How far ahead the match of a pair is searched.
const WINDOW: usize = 16;

/// The lists are given up when their changes exceed this share of the pairs that were read.
const CHANGES_DIVISOR: usize = 4;
const ALWAYS_LISTED: usize = 32;

/// A pair as one number, in the order of pairs.
pub(super) fn key(pair: [u32; 2]) -> u64 {
    u64::from(pair[0]) << 32 | u64::from(pair[1])
}

/// The pair of a [`key`].
pub(super) fn pair_of(key: u64) -> [u32; 2] {
    [(key >> 32) as u32, key as u32]
}

/// The keys of the pairs of `now` that are not in `before`, and of those of `before` that are not
/// in `now`, both sorted. Each list has a pair once. `None` if their orders differ too much.
pub(super) fn changes(before: &PairList, now: &PairList) -> Option<[Vec<u64>; 2]> {
    let (before, now) = (Keys::of(before), Keys::of(now));
    let (mut begun, mut ended) = (Vec::new(), Vec::new());
    let (mut i, mut j) = (0, 0);
    while i < before.len() && j < now.len() {
        let (old, new) = (before.at(i), now.at(j));
        if old == new {
            (i, j) = (i + 1, j + 1);
            continue;
        }
        // The nearer match decides which of the lists has pairs that the other hasn't.
        let ahead = (1..WINDOW).find_map(|steps| {
            if now.has(j + steps, old) {
                return Some((0, steps));
            }
            before.has(i + steps, new).then_some((steps, 0))
        });
        let (gone, come) = ahead.unwrap_or((1, 1));
        ended.extend((i..i + gone).map(|at| before.at(at)));
        begun.extend((j..j + come).map(|at| now.at(at)));
        (i, j) = (i + gone, j + come);
        if begun.len() + ended.len() > (i + j) / CHANGES_DIVISOR + ALWAYS_LISTED {
            return None;
        }
    }
    ended.extend((i..before.len()).map(|at| before.at(at)));
    begun.extend((j..now.len()).map(|at| now.at(at)));
    begun.sort_unstable();
    ended.sort_unstable();
    cancel(&mut begun, &mut ended);
    Some([begun, ended])
}

/// Removes what two sorted lists have in common from both.
fn cancel(one: &mut Vec<u64>, other: &mut Vec<u64>) {
    let (mut i, mut j) = (0, 0);
    let [mut kept_one, mut kept_other] = [Vec::new(), Vec::new()];
    while i < one.len() && j < other.len() {
        match one[i].cmp(&other[j]) {
            std::cmp::Ordering::Less => {
                kept_one.push(one[i]);
                i += 1;
            }
            std::cmp::Ordering::Equal => (i, j) = (i + 1, j + 1),
            std::cmp::Ordering::Greater => {
                kept_other.push(other[j]);
                j += 1;
            }
        }
    }
    kept_one.extend(&one[i..]);
    kept_other.extend(&other[j..]);
    (*one, *other) = (kept_one, kept_other);
}

/// The keys of a list.
struct Keys<'a> {
    first: &'a [u32],
    second: &'a [u32],
}

impl<'a> Keys<'a> {
    fn of(list: &'a PairList) -> Self {
        let (first, second) = (list.first(), list.second());
        Self { first, second }
    }

    fn len(&self) -> usize {
        self.first.len()
    }

    fn at(&self, at: usize) -> u64 {
        key([self.first[at], self.second[at]])
    }

    fn has(&self, at: usize, key: u64) -> bool {
        at < self.len() && self.at(at) == key
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::*;

    /// Lists in one order, in nearly one, and in any: the changes are those of the sets.
    #[test]
    fn aligned_changes_are_those_of_sets() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mut draw = |n: usize| random.next_u32() as usize % n;
        let mut given_up = [0; 3];
        for round in 0..600 {
            let mut all: Vec<[u32; 2]> = (0..600).map(|i| [i % 40, i / 40 + 50]).collect();
            for at in 0..all.len() {
                all.swap(at, draw(at + 1));
            }
            let some = |draw: &mut dyn FnMut(usize) -> usize, shares: usize| {
                let kept = all.iter().copied().filter(|_| draw(shares) > 0);
                kept.collect::<Vec<_>>()
            };
            let shares = [40, 9][round % 2];
            let (before, mut now) = (some(&mut draw, shares), some(&mut draw, shares));
            let swaps = [0, 5, 500][round % 3];
            for _ in 0..swaps {
                let at = draw(now.len());
                let to = if swaps == 500 {
                    draw(now.len())
                } else {
                    at.saturating_sub(draw(9))
                };
                now.swap(at, to);
            }
            let list = |pairs: &[[u32; 2]]| pairs.iter().copied().collect::<PairList>();
            let Some([begun, ended]) = changes(&list(&before), &list(&now)) else {
                given_up[round % 3] += 1;
                continue;
            };
            let [before, now] = [before, now].map(BTreeSet::from_iter);
            let wanted = now.difference(&before).copied();
            assert!(begun.iter().copied().map(pair_of).eq(wanted), "{round}");
            let wanted = before.difference(&now).copied();
            assert!(ended.iter().copied().map(pair_of).eq(wanted), "{round}");
        }
        assert_eq!(given_up, [0, 0, 200]);
    }

    /// Short lists are never given up, so that pairs in any order cancel each other.
    #[test]
    fn reversed_pairs_cancel() {
        let pairs = (0..14).map(|i| [i, i + 1]);
        let before: PairList = pairs.clone().collect();
        let now: PairList = pairs
            .rev()
            .filter(|[i, _]| *i != 5)
            .chain([[20, 21]])
            .collect();
        let changes = changes(&before, &now);
        assert_eq!(changes, Some([vec![key([20, 21])], vec![key([5, 6])]]));
    }
}
