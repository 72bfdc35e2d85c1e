//! The pairs of a world in which few bodies move: kept by body, changed pair by pair, with the
//! changes from which events are read.
//!
//! The pairs have two forms. As long as each cull finds all pairs anew, there are two lists that
//! take turns ([`PairLog`]). When a cull changes only some pairs, there are lists of partners
//! ([`Partners`]) and a log of what has changed since events were last read. Either form can be
//! made from the other in one pass over the pairs.

use std::sync::Arc;

use super::events::{ChangeLog, Changes, CurrentPairs, Event, PairChange};
use super::movers::Movers;
use super::pair_log::{PairLog, WorldPairs};
use super::reported_pairs::ReportedPairs;
use super::{BodyId, Events, Ids};
use crate::pairs::{FoundPartners, Merge, Merged, PairList, Partners};

/// The number of bodies by which prefetching is ahead.
const PREFETCH_DISTANCE: usize = 8;

/// The pairs of the last cull, and their changes since events were last read.
#[derive(Clone, Debug, Default)]
pub(crate) struct LivePairs {
    /// While pairs are kept by body, only its memory is used.
    log: PairLog,
    live: Option<PairsByBody>,
    /// The partners that a body has gained or lost.
    differences: Vec<(u32, bool)>,
}

/// The pairs while they are kept by body.
#[derive(Clone, Debug)]
struct PairsByBody {
    /// Shared with events.
    partners: Arc<Partners>,
    /// The bodies of rows, if the world has changed its rows since the last cull.
    table: Option<Arc<Vec<BodyId>>>,
    /// `None` if there were no pairs when events were last read, or if events have never been read:
    /// all pairs have begun since then.
    changes: Option<ChangeLog>,
}

impl LivePairs {
    /// The pairs of a log.
    #[cfg(feature = "serde")]
    pub fn of(log: PairLog) -> Self {
        Self { log, ..Self::default() }
    }

    /// The pairs of the last cull.
    pub fn pairs<'a>(&'a self, ids: &'a Ids) -> WorldPairs<'a> {
        match &self.live {
            None => self.log.pairs(),
            Some(live) => live.pairs(ids),
        }
    }

    /// An empty list to cull into. There are no pairs until [`Self::put`].
    pub fn take(&mut self, ids: &Ids) -> PairList {
        if let Some(live) = self.live.take() {
            self.log.watched = Arc::new(live.watched(ids));
        }
        self.log.take()
    }

    /// Takes the pairs of a cull that found them all, in any order.
    pub fn put(&mut self, slots: PairList, ids: &Ids) {
        self.log.put(slots, ids);
    }

    /// Keeps the pairs by body from now on, until [`Self::take`].
    pub fn keep_by_body(&mut self, ids: &Ids) {
        if self.live.is_none() {
            let log = std::mem::take(&mut self.log);
            let changes = Some(&log.watched).filter(|watched| !watched.is_empty());
            let changes = changes.and_then(|was| Changes::between(was, &log.last, usize::MAX));
            let changes = changes.map(ChangeLog::of);
            let partners = Partners::of(log.last.slots(), ids.rows());
            self.live = Some(PairsByBody { partners: Arc::new(partners), table: None, changes });
        }
    }

    /// Gives bodies that have changed the partners that were found, updates the lists of these, and
    /// logs each pair that has begun or ended once. Copies the lists if events share them.
    pub fn apply(&mut self, found: &FoundPartners, movers: &Movers, ids: &Ids) {
        self.keep_by_body(ids);
        let Self { live: Some(live), differences, .. } = self else { return };
        let PairsByBody { partners: shared, changes, .. } = live;
        if !shared.has_room_for(ids.rows()) {
            Arc::make_mut(shared).extend_to(ids.rows());
        }
        for (number, (row, partners)) in found.iter().enumerate() {
            let ahead = [2 * PREFETCH_DISTANCE, PREFETCH_DISTANCE]
                .map(|steps| found.bodies.get(number + steps));
            shared.prefetch(ahead);
            compare(shared.of_number(row), partners, differences);
            if differences.is_empty() {
                continue;
            }
            let lists = Arc::make_mut(shared);
            lists.replace(row, partners);
            for &(other, has_begun) in &*differences {
                let finds_itself = movers.is_changed(other);
                if !finds_itself {
                    lists.set_partner(other, row, has_begun);
                }
                if (!finds_itself || row < other)
                    && let Some(log) = changes
                {
                    let pair = [row.min(other), row.max(other)].map(|row| ids.id(row));
                    log.push(PairChange { pair, has_begun });
                }
            }
        }
        if let Some(log) = changes {
            log.cancel_some();
        }
        if shared.is_sparse() {
            Arc::make_mut(shared).compact();
        }
    }

    /// The pairs that began, persisted or ended between the last call of this method and the last
    /// cull.
    pub fn events(&mut self, ids: &Ids) -> Events {
        let Some(live) = &mut self.live else {
            return self.log.events();
        };
        match live.changes.replace(ChangeLog::default()) {
            Some(changes) => live.events(changes.net(), ids),
            None => {
                let before = Some(Arc::default()); // all have begun
                Events { before, ..live.events(Changes::default(), ids) }
            }
        }
    }

    /// Keeps the pairs of the last cull, and those of the last events, while the world changes its
    /// rows. Then all pairs must be found anew. Long lists aren't copied.
    pub fn outlive_rows(&mut self, ids: &Ids) {
        if let Some(live) = &mut self.live
            && 2 * live.partners.len() > ids.rows()
        {
            live.table.get_or_insert_with(|| ids.table().clone());
        } else {
            self.log = self.to_log(ids);
            self.live = None;
        }
        self.log.outlive_rows();
    }

    /// Bytes of the pairs.
    pub fn bytes(&self) -> usize {
        let live = self.live.as_ref().map_or(0, |live| {
            live.partners.bytes() + live.changes.as_ref().map_or(0, ChangeLog::bytes)
        });
        self.log.bytes() + live
    }

    /// Frees the memory that the pairs don't need.
    pub fn shrink_to_fit(&mut self, ids: &Ids) {
        self.log = self.to_log(ids);
        self.live = None;
        self.log.shrink_to_fit();
    }

    /// The same pairs as lists. If nothing has changed since events were read, both are one list.
    pub fn to_log(&self, ids: &Ids) -> PairLog {
        let (last, watched) = match &self.live {
            None => (self.log.last.clone(), self.log.watched.compacted()),
            Some(live) => (Arc::new(live.last(ids)), Arc::new(live.watched(ids))),
        };
        let are_equal = last.pairs().iter().eq(watched.pairs());
        let watched = if are_equal { last.clone() } else { watched };
        PairLog::of(last, watched)
    }
}

impl PairsByBody {
    fn table<'a>(&'a self, ids: &'a Ids) -> &'a Arc<Vec<BodyId>> {
        self.table.as_ref().unwrap_or(ids.table())
    }

    fn last(&self, ids: &Ids) -> ReportedPairs {
        ReportedPairs::sorted(self.partners.iter().collect(), self.table(ids).clone())
    }

    fn pairs<'a>(&'a self, ids: &'a Ids) -> WorldPairs<'a> {
        WorldPairs::of_partners(&self.partners, self.table(ids))
    }

    /// The events of these changes.
    fn events(&self, changes: Changes, ids: &Ids) -> Events {
        let slots = self.partners.clone();
        let now = CurrentPairs::Partners { slots, ids: self.table(ids).clone() };
        Events { now, before: None, changes }
    }

    /// The pairs of the last call of `events`.
    fn watched(&self, ids: &Ids) -> ReportedPairs {
        let Some(changes) = self.changes.clone() else {
            return ReportedPairs::default();
        };
        let events = self.events(changes.net(), ids);
        ReportedPairs::compact(events.iter().filter_map(|event| match event {
            Event::Begun(_) => None,
            Event::Persisting(pair) | Event::Ended(pair) => Some(pair),
        }))
    }
}

/// Lists the differences of two sorted lists: (n, false) if only `before` has n, (n, true) if only
/// `now` has it.
fn compare(before: &[u32], now: &[u32], differences: &mut Vec<(u32, bool)>) {
    differences.clear();
    if before != now {
        let merged = Merge::new(before, now, Ord::cmp);
        differences.extend(merged.filter_map(|merged| match merged {
            Merged::First(&gone) => Some((gone, false)),
            Merged::Second(&come) => Some((come, true)),
            Merged::Both(..) => None,
        }));
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use std::collections::BTreeSet;

    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::super::ids::tests::filled as ids;
    use super::*;

    /// Changes the pairs to these.
    fn change(live: &mut LivePairs, ids: &Ids, wanted: &BTreeSet<[u32; 2]>) {
        for body in 0..ids.rows() as u32 {
            let of_body = wanted.iter().filter(|pair| pair.contains(&body));
            let mut partners: Vec<u32> = of_body.map(|[i, j]| i + j - body).collect();
            partners.sort_unstable();
            let ends = vec![partners.len()];
            let found = FoundPartners { bodies: vec![body], present: 1, partners, ends };
            live.apply(&found, &Movers::default(), ids);
        }
    }

    #[test]
    fn both_forms_report_the_same_events() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let (ids, mut lists, mut live) = (ids(20), PairLog::default(), LivePairs::default());
        for frame in 0..600 {
            let mut below = |n: u32| random.next_u32() % n;
            let pairs = if frame % 7 == 0 { 0 } else { 30 };
            let wanted: BTreeSet<[u32; 2]> =
                (0..pairs).map(|_| [below(20), below(20)]).filter(|[i, j]| i < j).collect();
            let list = || wanted.iter().copied().collect::<PairList>();
            lists.take();
            lists.put(list(), &ids);
            if below(8) == 0 {
                live.take(&ids);
                live.put(list(), &ids);
            } else {
                change(&mut live, &ids, &wanted);
            }
            assert!(live.pairs(&ids).iter().eq(lists.pairs()), "{frame}");
            assert!(live.to_log(&ids).pairs().iter().eq(lists.pairs()));
            if below(3) > 0 {
                let copy = live.clone().to_log(&ids).events();
                let [one, other] = [lists.events(), live.events(&ids)];
                assert!(one.iter().eq(other.iter()), "{frame}");
                assert!(one.iter().eq(copy.iter()), "{frame}");
                assert!(one.begun().eq(other.begun()) && one.ended().eq(other.ended()));
                assert!(one.persisting().eq(other.persisting()));
            }
            if below(9) == 0 {
                live.shrink_to_fit(&ids);
                assert!(live.pairs(&ids).iter().eq(lists.pairs()), "{frame}");
                live.take(&ids);
                live.put(list(), &ids);
            }
        }
    }

    /// Unread events hold no more than pairs.
    #[test]
    fn unread_events_stay_small() {
        let (ids, mut live) = (ids(200), LivePairs::default());
        let all: BTreeSet<[u32; 2]> = (0..199).map(|i| [i, i + 1]).collect();
        change(&mut live, &ids, &all);
        assert_eq!(live.events(&ids).begun().count(), 199);
        let mut most = 0;
        for frame in 0..1000 {
            let some = all.iter().filter(|[i, _]| (i + frame) % 3 > 0);
            change(&mut live, &ids, &some.copied().collect());
            most = most.max(live.bytes());
        }
        assert!(most < 200_000, "{most}");
        assert_eq!(live.events(&ids).ended().count(), 67);
    }

    #[test]
    fn events_outlive_the_next_cull() {
        let (ids, mut live) = (ids(4), LivePairs::default());
        change(&mut live, &ids, &[[0, 1], [1, 2]].into());
        let events = live.events(&ids);
        change(&mut live, &ids, &[[2, 3]].into());
        assert_eq!((events.begun().count(), events.persisting().count()), (2, 0));
        assert_eq!(live.events(&ids).ended().count(), 2);
    }
}
