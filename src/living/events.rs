//! Events between two culls: found by merging their lists, or listed if little has changed.

use std::cmp::Ordering;
use std::iter::Peekable;
use std::sync::Arc;

use super::BodyId;
use super::pair_log::{PairIds, WorldPairs};
use super::reported_pairs::{ReportedPairs, SortedKeys};
use crate::pairs::{Partners, pair_of};

/// Changes are listed if they are at most about one in this number of pairs of both culls.
const LISTED_SHARE: usize = 2;
const ALWAYS_LISTED: usize = 64;

/// The event of one pair, the lower slot first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// Reported now and not before.
    Begun([BodyId; 2]),
    /// Reported now and before.
    Persisting([BodyId; 2]),
    /// Reported before and not now; pairs of a body removed since then are among them.
    Ended([BodyId; 2]),
}

/// The pairs that have begun, persist or have ended between two culls, each kind sorted by slots.
///
/// It doesn't borrow the world: bodies may be removed while events are read. The cost of
/// [`Self::begun`] and [`Self::ended`] is proportional to the changes, or one pass over both lists
/// of pairs if there are many; [`Self::persisting`] and [`Self::iter`] take one pass over the
/// pairs. Drop the events before the next cull, which otherwise copies the pairs that they share
/// with the world.
#[derive(Clone, Debug, Default)]
pub struct Events {
    pub(super) now: CurrentPairs,
    pub(super) change: PairDifference,
}

/// The pairs of the later cull.
#[derive(Clone, Debug)]
pub(super) enum CurrentPairs {
    List(Arc<ReportedPairs>),
    Partners { slots: Arc<Partners>, ids: Arc<Vec<BodyId>> },
}

/// The difference of the former cull's pairs.
#[derive(Clone, Debug)]
pub(super) enum PairDifference {
    /// The former pairs.
    Since(Arc<ReportedPairs>),
    /// The changes, both sorted.
    Listed { begun: Vec<[BodyId; 2]>, ended: Vec<[BodyId; 2]> },
}

impl Default for CurrentPairs {
    fn default() -> Self {
        Self::List(Arc::default())
    }
}

impl Default for PairDifference {
    fn default() -> Self {
        Self::Since(Arc::default())
    }
}

impl CurrentPairs {
    pub fn pairs(&self) -> WorldPairs<'_> {
        match self {
            Self::List(list) => list.pairs(),
            Self::Partners { slots, ids } => WorldPairs::of_partners(slots, ids),
        }
    }
}

impl Events {
    /// The events between two culls.
    pub(super) fn between(before: Arc<ReportedPairs>, now: Arc<ReportedPairs>) -> Self {
        let change = changes_between(&before, &now).unwrap_or(PairDifference::Since(before));
        let now = CurrentPairs::List(now);
        Self { now, change }
    }

    /// All events, sorted by the slots of their pairs.
    pub fn iter(&self) -> impl Iterator<Item = Event> + '_ {
        let now = self.now.pairs().iter().peekable();
        match &self.change {
            PairDifference::Since(before) => {
                EitherIterator::One(MergedEvents { before: before.pairs().iter().peekable(), now })
            }
            PairDifference::Listed { begun, ended } => EitherIterator::Other(FormerPairs {
                now,
                begun: begun.iter().peekable(),
                ended: ended.iter().peekable(),
            }),
        }
    }

    /// Pairs reported now and not before.
    pub fn begun(&self) -> impl Iterator<Item = [BodyId; 2]> + '_ {
        match &self.change {
            PairDifference::Listed { begun, .. } => EitherIterator::One(begun.iter().copied()),
            PairDifference::Since(_) => {
                EitherIterator::Other(self.iter().filter_map(|event| match event {
                    Event::Begun(pair) => Some(pair),
                    _ => None,
                }))
            }
        }
    }

    /// Pairs reported now and before.
    pub fn persisting(&self) -> impl Iterator<Item = [BodyId; 2]> + '_ {
        self.iter().filter_map(|event| match event {
            Event::Persisting(pair) => Some(pair),
            _ => None,
        })
    }

    /// Pairs reported before and not now; those of a body removed since then are among them.
    pub fn ended(&self) -> impl Iterator<Item = [BodyId; 2]> + '_ {
        match &self.change {
            PairDifference::Listed { ended, .. } => EitherIterator::One(ended.iter().copied()),
            PairDifference::Since(_) => {
                EitherIterator::Other(self.iter().filter_map(|event| match event {
                    Event::Ended(pair) => Some(pair),
                    _ => None,
                }))
            }
        }
    }
}

/// Lists the changes between two culls, unless most pairs have changed.
fn changes_between(before: &ReportedPairs, now: &ReportedPairs) -> Option<PairDifference> {
    let most = (before.len() + now.len()) / LISTED_SHARE + ALWAYS_LISTED;
    if before.len().abs_diff(now.len()) > most {
        return None;
    }
    let [begun, ended] = if std::ptr::eq(before, now) {
        Default::default()
    } else {
        changes_of_lists(before, now, most)?
    };
    // Bodies are looked up at the end, because that misses the caches.
    let named = |keys: Vec<u64>, reported: &ReportedPairs| {
        let pairs = keys.into_iter().map(pair_of);
        pairs.map(|pair| BodyId::pair_of(pair, &reported.table)).collect()
    };
    Some(PairDifference::Listed { begun: named(begun, now), ended: named(ended, before) })
}

/// The keys of the pairs that have begun and ended from one cull to a later one, each kind sorted.
/// `None` if there are more than `most`.
fn changes_of_lists(
    before: &ReportedPairs,
    now: &ReportedPairs,
    most: usize,
) -> Option<[Vec<u64>; 2]> {
    let are_of_one_time = Arc::ptr_eq(&before.table, &now.table);
    let in_step = || before.out_of_step(now);
    let [old, new] = match are_of_one_time.then(in_step).flatten() {
        Some(alone) => alone.map(SortedKeys::Copied),
        None => [before, now].map(|reported| reported.keys(before.are_read())),
    };
    if are_of_one_time {
        return changes_in_order(&old, &new, |[was, is]| was.cmp(&is), most);
    }
    let ids = |key, reported: &ReportedPairs| BodyId::pair_of(pair_of(key), &reported.table);
    changes_in_order(&old, &new, |[was, is]| ids(was, before).cmp(&ids(is, now)), most)
}

/// The keys that have begun and ended from one list to another, of which `order` compares the
/// bodies of two keys. `None` if there are more than `most`.
fn changes_in_order(
    old: &SortedKeys<'_>,
    new: &SortedKeys<'_>,
    order: impl Fn([u64; 2]) -> Ordering,
    most: usize,
) -> Option<[Vec<u64>; 2]> {
    let (mut begun, mut ended) = (Vec::new(), Vec::new());
    let (mut i, mut j) = (0, 0);
    while i < old.len() && j < new.len() {
        let (was, is) = (old.at(i), new.at(j));
        let order = order([was, is]);
        if order.is_eq() {
            (i, j) = (i + 1, j + 1);
            continue;
        }
        if order.is_lt() {
            ended.push(was);
            i += 1;
        } else {
            begun.push(is);
            j += 1;
        }
        if begun.len() + ended.len() > most {
            return None;
        }
    }
    ended.extend((i..old.len()).map(|at| old.at(at)));
    begun.extend((j..new.len()).map(|at| new.at(at)));
    Some([begun, ended])
}

/// One of two iterators.
enum EitherIterator<A, B> {
    One(A),
    Other(B),
}

impl<T, A: Iterator<Item = T>, B: Iterator<Item = T>> Iterator for EitherIterator<A, B> {
    type Item = T;
    fn next(&mut self) -> Option<T> {
        match self {
            Self::One(iter) => iter.next(),
            Self::Other(iter) => iter.next(),
        }
    }
}

/// Merges two sorted lists.
struct MergedEvents<'a> {
    before: Peekable<PairIds<'a>>,
    now: Peekable<PairIds<'a>>,
}

impl Iterator for MergedEvents<'_> {
    type Item = Event;
    fn next(&mut self) -> Option<Event> {
        let Some(&pair) = self.now.peek() else {
            return self.before.next().map(Event::Ended);
        };
        if let Some(gone) = self.before.next_if(|&old| old < pair) {
            return Some(Event::Ended(gone));
        }
        self.now.next();
        match self.before.next_if_eq(&pair) {
            Some(_) => Some(Event::Persisting(pair)),
            None => Some(Event::Begun(pair)),
        }
    }
}

/// Reconstructs the former pairs from the later ones and the changes, all sorted.
struct FormerPairs<'a> {
    now: Peekable<PairIds<'a>>,
    begun: Peekable<std::slice::Iter<'a, [BodyId; 2]>>,
    ended: Peekable<std::slice::Iter<'a, [BodyId; 2]>>,
}

impl Iterator for FormerPairs<'_> {
    type Item = Event;
    fn next(&mut self) -> Option<Event> {
        let Some(&pair) = self.now.peek() else {
            return self.ended.next().copied().map(Event::Ended);
        };
        if let Some(gone) = self.ended.next_if(|&&gone| gone < pair) {
            return Some(Event::Ended(*gone));
        }
        self.now.next();
        match self.begun.next_if(|&&begun| begun == pair) {
            Some(_) => Some(Event::Begun(pair)),
            None => Some(Event::Persisting(pair)),
        }
    }
}
