//! Events between two culls: the changes, which are found by comparing lists or logged one by one,
//! and the pairs of the later cull.

use std::sync::Arc;

use super::BodyId;
use super::pair_log::WorldPairs;
use super::reported_pairs::{ReportedPairs, SortedKeys};
use crate::pairs::{Merge, Merged, Partners, pair_of};

/// Changes are listed if they are at most about one in this number of pairs of both culls.
const LISTED_SHARE: usize = 2;
const ALWAYS_LISTED: usize = 64;

/// The least number of changes for which a log is searched for those that cancel each other.
const LEAST_SEARCHED_CHANGES: usize = 1024;

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
    /// The former pairs, if most have changed: no third list is made of a crowd's pairs.
    pub(super) before: Option<Arc<ReportedPairs>>,
    /// Empty if there are former pairs.
    pub(super) changes: Changes,
}

/// The pairs of the later cull.
#[derive(Clone, Debug)]
pub(super) enum CurrentPairs {
    List(Arc<ReportedPairs>),
    Partners { slots: Arc<Partners>, ids: Arc<Vec<BodyId>> },
}

/// The pairs that have begun and ended between two culls, each kind sorted.
#[derive(Clone, Debug, Default)]
pub(super) struct Changes {
    pub begun: Vec<[BodyId; 2]>,
    pub ended: Vec<[BodyId; 2]>,
}

impl Default for CurrentPairs {
    fn default() -> Self {
        Self::List(Arc::default())
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
        let most = (before.len() + now.len()) / LISTED_SHARE + ALWAYS_LISTED;
        let changes = Changes::between(&before, &now, most);
        let before = changes.is_none().then_some(before);
        Self { now: CurrentPairs::List(now), before, changes: changes.unwrap_or_default() }
    }

    /// All events, sorted by the slots of their pairs.
    pub fn iter(&self) -> impl Iterator<Item = Event> + '_ {
        let merged = self.before.as_ref().map(|before| {
            let both = Merge::new(before.pairs(), self.now.pairs(), Ord::cmp);
            both.map(|merged| match merged {
                Merged::First(pair) => Event::Ended(pair),
                Merged::Second(pair) => Event::Begun(pair),
                Merged::Both(_, pair) => Event::Persisting(pair),
            })
        });
        let listed = merged.is_none().then(|| {
            let Changes { begun, ended } = &self.changes;
            let now = Merge::new(begun, self.now.pairs(), |begun, pair| (*begun).cmp(pair));
            let now = now.map(|merged| match merged {
                Merged::First(&pair) | Merged::Both(_, pair) => (pair, Event::Begun(pair)),
                Merged::Second(pair) => (pair, Event::Persisting(pair)),
            });
            let all = Merge::new(ended, now, |ended, (pair, _)| (*ended).cmp(pair));
            all.map(|merged| match merged {
                Merged::First(&pair) => Event::Ended(pair),
                Merged::Second((_, event)) | Merged::Both(_, (_, event)) => event,
            })
        });
        merged.into_iter().flatten().chain(listed.into_iter().flatten())
    }

    /// These listed pairs, or those of all events that `pick` picks.
    fn changed<'a>(
        &'a self,
        listed: &'a [[BodyId; 2]],
        pick: fn(Event) -> Option<[BodyId; 2]>,
    ) -> impl Iterator<Item = [BodyId; 2]> + 'a {
        let found = self.before.is_some().then(|| self.iter().filter_map(pick));
        found.into_iter().flatten().chain(listed.iter().copied())
    }

    /// Pairs reported now and not before.
    pub fn begun(&self) -> impl Iterator<Item = [BodyId; 2]> + '_ {
        self.changed(&self.changes.begun, |event| match event {
            Event::Begun(pair) => Some(pair),
            _ => None,
        })
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
        self.changed(&self.changes.ended, |event| match event {
            Event::Ended(pair) => Some(pair),
            _ => None,
        })
    }
}

impl Changes {
    /// The changes from one cull to a later one. `None` if there are more than `most`.
    pub fn between(before: &ReportedPairs, now: &ReportedPairs, most: usize) -> Option<Self> {
        if std::ptr::eq(before, now) {
            return Some(Self::default());
        }
        if before.len().abs_diff(now.len()) > most {
            return None;
        }
        let are_of_one_time = Arc::ptr_eq(&before.table, &now.table);
        let in_step = || before.out_of_step(now);
        let keys = match are_of_one_time.then(in_step).flatten() {
            Some(alone) => alone.map(SortedKeys::Copied),
            None => [before, now].map(|reported| reported.keys(before.are_read())),
        };
        let [old, new] = [&keys[0], &keys[1]].map(|keys| (0..keys.len()).map(|at| keys.at(at)));
        let (mut begun, mut ended) = (Vec::new(), Vec::new());
        let mut note = |merged: Merged<u64, u64>| {
            match merged {
                Merged::First(key) => ended.push(key),
                Merged::Second(key) => begun.push(key),
                Merged::Both(..) => return Some(()),
            }
            (begun.len() + ended.len() <= most).then_some(())
        };
        if are_of_one_time {
            Merge::new(old, new, Ord::cmp).try_for_each(&mut note)?;
        } else {
            let ids =
                |key, reported: &ReportedPairs| BodyId::pair_of(pair_of(key), &reported.table);
            let order = |&was: &u64, &is: &u64| ids(was, before).cmp(&ids(is, now));
            Merge::new(old, new, order).try_for_each(&mut note)?;
        }
        // Bodies are looked up at the end, because that misses the caches.
        let named = |keys: Vec<u64>, reported: &ReportedPairs| {
            let pairs = keys.into_iter().map(pair_of);
            pairs.map(|pair| BodyId::pair_of(pair, &reported.table)).collect()
        };
        Some(Self { begun: named(begun, now), ended: named(ended, before) })
    }
}

/// A pair that began or ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PairChange {
    pub pair: [BodyId; 2],
    pub has_begun: bool,
}

/// The pairs that began or ended since events were last read, in the order of time.
#[derive(Clone, Debug, Default)]
pub(super) struct ChangeLog {
    changes: Vec<PairChange>,
    /// Number of changes that the last search left.
    lasting: usize,
}

impl ChangeLog {
    /// A log of these changes.
    pub fn of(Changes { begun, ended }: Changes) -> Self {
        let change = |pairs: Vec<_>, has_begun| {
            pairs.into_iter().map(move |pair| PairChange { pair, has_begun })
        };
        Self { changes: change(begun, true).chain(change(ended, false)).collect(), lasting: 0 }
    }

    pub fn push(&mut self, change: PairChange) {
        self.changes.push(change);
    }

    /// Removes changes that cancel each other, if the log has doubled since the last search. So its
    /// size stays proportional to the pairs of both moments, however long events aren't read.
    pub fn cancel_some(&mut self) {
        if self.changes.len() > 2 * self.lasting + LEAST_SEARCHED_CHANGES {
            self.cancel();
            self.lasting = self.changes.len();
        }
    }

    /// Sorts by pair, and keeps those changes that no later one cancels. A pair begins and ends
    /// alternately, so of an even number of changes none is left, and of an odd number the last.
    fn cancel(&mut self) {
        self.changes.sort_by_key(|change| change.pair);
        let mut kept: Vec<PairChange> = Vec::new();
        for &change in &self.changes {
            match kept.last() {
                Some(former) if former.pair == change.pair => _ = kept.pop(),
                _ => kept.push(change),
            }
        }
        self.changes = kept;
    }

    /// What has changed in the end.
    pub fn net(mut self) -> Changes {
        self.cancel();
        let of = |has_begun: bool| {
            let changes = self.changes.iter();
            let changes = changes.filter(move |change| change.has_begun == has_begun);
            changes.map(|change| change.pair).collect()
        };
        Changes { begun: of(true), ended: of(false) }
    }

    /// Bytes of memory.
    pub fn bytes(&self) -> usize {
        self.changes.capacity() * size_of::<PairChange>()
    }
}
