//! The difference of two lists whose pairs were found in nearly the same order.

use super::PairList;

/// How far a pair of one list is looked for in the other.
const WINDOW: usize = 12;

/// Lists are in the same order if at most one in this number of their pairs, and
/// [`ALWAYS_SKIPPED`], are out of step.
const PAIRS_PER_SKIPPED: usize = 4;
const ALWAYS_SKIPPED: usize = 32;

/// The keys of the pairs that are in only one of two lists, and of some that both have: each list's
/// in ascending order. `None` if the lists are in another order.
///
/// Two culls that test the same candidates in the same order find lists of which each is the other
/// with pairs left out and put in. A walk through both in step finds these, and sorts neither.
pub(crate) fn out_of_step(before: &PairList, now: &PairList) -> Option<[Vec<u64>; 2]> {
    let (mut alone_before, mut alone_now) = (Vec::new(), Vec::new());
    let (mut i, mut j) = (0, 0);
    while i < before.len() && j < now.len() {
        let [old, new] = [before.key_at(i), now.key_at(j)];
        if old == new {
            (i, j) = (i + 1, j + 1);
            continue;
        }
        let [gone, come] = detour([(before, i), (now, j)], [old, new]);
        alone_before.extend((i..i + gone).map(|at| before.key_at(at)));
        alone_now.extend((j..j + come).map(|at| now.key_at(at)));
        (i, j) = (i + gone, j + come);
        let skipped = alone_before.len() + alone_now.len();
        if skipped > (i + j) / PAIRS_PER_SKIPPED + ALWAYS_SKIPPED {
            return None;
        }
    }
    alone_before.extend((i..before.len()).map(|at| before.key_at(at)));
    alone_now.extend((j..now.len()).map(|at| now.key_at(at)));
    alone_before.sort_unstable();
    alone_now.sort_unstable();
    Some([alone_before, alone_now])
}

/// By how many pairs to go on in each of two lists, which have different pairs at these places, so
/// that both have the same one; or else by one in each.
#[inline(always)]
fn detour([(before, i), (now, j)]: [(&PairList, usize); 2], [old, new]: [u64; 2]) -> [usize; 2] {
    for steps in 1..WINDOW {
        if i + steps < before.len() && before.key_at(i + steps) == new {
            return [steps, 0];
        }
        if j + steps < now.len() && now.key_at(j + steps) == old {
            return [0, steps];
        }
    }
    [1, 1]
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::*;
    use crate::pairs::key;

    /// What only one list has is found, whatever is left out, put in or moved to another place.
    #[test]
    fn only_common_pairs_are_left_out() {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let mut in_step = 0;
        for round in 0..400 {
            let mut below = |n: u32| random.next_u32() % n;
            let (left_out, moved) = (1 + below(30), below(3) * below(40));
            let all: Vec<_> = (0..below(600)).map(|at| [(at * 7919) % 601, 601 + at]).collect();
            let mut some = || {
                let mut list: Vec<_> = all.iter().filter(|_| below(left_out + 1) > 0).collect();
                for _ in 0..moved.min(list.len() as u32) {
                    let [from, to] = [0; 2].map(|_| below(list.len() as u32) as usize);
                    list.swap(from, to);
                }
                list.into_iter().copied().collect::<PairList>()
            };
            let (before, now) = (some(), some());
            let Some([old, new]) = out_of_step(&before, &now) else {
                continue;
            };
            in_step += 1;
            assert!(old.is_sorted() && new.is_sorted());
            let set = |keys: Vec<u64>| keys.into_iter().collect::<BTreeSet<_>>();
            let [old, new] = [old, new].map(set);
            let [before, now] = [before, now].map(|list| set(list.iter().map(key).collect()));
            let [gone, come] = [&before - &now, &now - &before];
            assert!(&old - &new == gone && &new - &old == come, "{round}");
        }
        assert!((100..400).contains(&in_step), "{in_step}");
    }
}
