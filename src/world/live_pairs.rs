//! The pairs of a world in which few bodies move: kept by body, changed pair by pair, with the
//! changes that events are read of.
//!
//! They have two forms. As long as a cull finds all pairs anew, they are lists that take turns
//! ([`PairLog`]). Once a cull changes some, they are lists of partners ([`Partners`]) and a log of
//! what has changed since events were last read. Either form is made of the other at the price of
//! one pass over the pairs.

use std::sync::Arc;

use super::change_log::{ChangeLog, PairChange};
use super::events::{CurrentPairs, Event, PairDifference};
use super::pair_log::{PairLog, Reported, WorldPairs};
use super::{BodyId, Events, Ids};
use crate::pairs::{PairList, Partners};

/// The pairs of the last cull, and how they differ from those that events were last read of.
#[derive(Clone, Debug, Default)]
pub(crate) struct LivePairs {
    /// What is left of it is memory while pairs are kept by body.
    log: PairLog,
    live: Option<PairsByBody>,
}

/// What is known of pairs while they are kept by body.
#[derive(Clone, Debug)]
struct PairsByBody {
    /// Shared with the events that are read of them.
    partners: Arc<Partners>,
    /// None if no pairs were there when events were last read, or if none have been read: all have
    /// begun since then.
    changes: Option<ChangeLog>,
}

impl LivePairs {
    /// Those of a log.
    #[cfg(feature = "serde")]
    pub fn of(log: PairLog) -> Self {
        Self { log, live: None }
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

    /// The pairs of a cull that found them all, in any order.
    pub fn put(&mut self, slots: PairList, ids: &Ids) {
        self.log.put(slots, ids);
    }

    /// Keeps the pairs by body from now on, until [`Self::take`].
    pub fn keep_by_body(&mut self, ids: &Ids) {
        if self.live.is_none() {
            let log = std::mem::take(&mut self.log);
            let changes = (!log.watched.slots.is_empty())
                .then(|| ChangeLog::between(log.watched, log.last.clone()));
            let partners = Partners::of(&log.last.slots, ids.slots());
            self.live = Some(PairsByBody {
                partners: Arc::new(partners),
                changes,
            });
        }
    }

    /// The slots that one is in pairs with, sorted. None unless pairs are kept by body.
    pub fn partners(&self, slot: u32) -> &[u32] {
        let live = self.live.as_ref();
        live.map_or(&[], |live| live.partners.of_number(slot))
    }

    /// Brings near what [`Self::partners`] reads of one slot soon, and of another next.
    #[inline(always)]
    pub fn prefetch(&self, slots: [Option<&u32>; 2]) {
        if let Some(live) = &self.live {
            live.partners.prefetch(slots);
        }
    }

    /// The pairs, to be changed, if they are kept by body. Copies them if events share them.
    pub fn change<'a>(&'a mut self, ids: &'a Ids) -> Option<PairChanges<'a>> {
        let live = self.live.as_mut()?;
        let partners = Arc::make_mut(&mut live.partners);
        partners.extend_to(ids.slots());
        Some(PairChanges {
            partners,
            log: live.changes.as_mut(),
            ids,
        })
    }

    /// Makes room for the slots that there are.
    pub fn extend(&mut self, ids: &Ids) {
        if let Some(live) = &mut self.live
            && !live.partners.has_room_for(ids.slots())
        {
            Arc::make_mut(&mut live.partners).extend_to(ids.slots());
        }
    }

    /// What the last cull reports that it didn't at the last call of this, and the other way round.
    pub fn events(&mut self, ids: &Ids) -> Events {
        let Some(live) = &mut self.live else {
            return self.log.events();
        };
        let changes = match live.changes.replace(ChangeLog::default()) {
            Some(changes) => changes.net(),
            None => [live.pairs(ids).iter().collect(), Vec::new()],
        };
        live.events(changes, ids)
    }

    /// Bytes that pairs hold.
    pub fn bytes(&self) -> usize {
        let live = self.live.as_ref().map_or(0, |live| {
            live.partners.bytes() + live.changes.as_ref().map_or(0, ChangeLog::bytes)
        });
        self.log.bytes() + live
    }

    /// Gives back the memory that the pairs don't need.
    pub fn shrink_to_fit(&mut self, ids: &Ids) {
        self.log = self.to_log(ids);
        self.live = None;
        self.log.shrink_to_fit();
    }

    /// The same pairs as lists. One list serves for both if nothing has changed since events were
    /// read.
    pub fn to_log(&self, ids: &Ids) -> PairLog {
        let (last, watched) = match &self.live {
            None => {
                let watched = reported(self.log.watched.pairs().iter());
                (self.log.last.clone(), Arc::new(watched))
            }
            Some(live) => (Arc::new(live.last(ids)), Arc::new(live.watched(ids))),
        };
        let are_equal = last.pairs().iter().eq(watched.pairs());
        let watched = if are_equal { last.clone() } else { watched };
        PairLog::of(last, watched)
    }
}

impl PairsByBody {
    fn last(&self, ids: &Ids) -> Reported {
        Reported {
            slots: self.partners.iter().collect(),
            generation: ids.generation().clone(),
        }
    }

    fn pairs<'a>(&'a self, ids: &'a Ids) -> WorldPairs<'a> {
        WorldPairs::of_partners(&self.partners, ids.generation())
    }

    /// The events of these changes, begun and ended ones, that led to the pairs.
    fn events(&self, [begun, ended]: [Vec<[BodyId; 2]>; 2], ids: &Ids) -> Events {
        Events {
            now: CurrentPairs::Partners {
                slots: self.partners.clone(),
                generation: ids.generation().clone(),
            },
            change: PairDifference::Listed { begun, ended },
        }
    }

    /// The pairs that events were last read of.
    fn watched(&self, ids: &Ids) -> Reported {
        let Some(changes) = self.changes.clone() else {
            return Reported::default();
        };
        let events = self.events(changes.net(), ids);
        reported(events.iter().filter_map(|event| match event {
            Event::Begun(_) => None,
            Event::Persisting(pair) | Event::Ended(pair) => Some(pair),
        }))
    }
}

/// Sorted pairs as a list, with the generations of the slots that they name alone.
fn reported(pairs: impl Iterator<Item = [BodyId; 2]>) -> Reported {
    let (mut slots, mut generation) = (PairList::default(), Vec::new());
    for pair in pairs {
        for id in pair {
            if generation.len() <= id.slot() {
                generation.resize(id.slot() + 1, 0);
            }
            generation[id.slot()] = id.generation;
        }
        slots.push(pair[0].slot, pair[1].slot);
    }
    let generation = Arc::new(generation);
    Reported { slots, generation }
}

/// Pairs that are being changed. A change of a pair of two bodies is made at both of them, and
/// noted once.
pub(crate) struct PairChanges<'a> {
    partners: &'a mut Partners,
    log: Option<&'a mut ChangeLog>,
    ids: &'a Ids,
}

impl PairChanges<'_> {
    /// Replaces the partners of one slot.
    pub fn replace(&mut self, slot: u32, partners: &[u32]) {
        self.partners.replace(slot, partners);
    }

    /// Makes another slot a partner of one, or ends that.
    pub fn set_partner(&mut self, slot: u32, other: u32, has_begun: bool) {
        if has_begun {
            self.partners.insert(slot, other);
        } else {
            self.partners.remove(slot, other);
        }
    }

    /// Notes for events that a pair has begun or ended.
    pub fn note(&mut self, slot: u32, other: u32, has_begun: bool) {
        if let Some(log) = &mut self.log {
            let pair = [slot.min(other), slot.max(other)].map(|slot| self.ids.id(slot));
            log.push(PairChange { pair, has_begun });
        }
    }

    /// Drops notes that cancel each other, if there are many.
    pub fn done(self) {
        if let Some(log) = self.log {
            log.cancel_some();
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use std::collections::BTreeSet;

    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::*;

    fn ids(bodies: u32) -> Ids {
        let mut ids = Ids::default();
        (0..bodies).for_each(|_| assert!(ids.take()));
        ids
    }

    /// Makes these the pairs, by whatever changes that takes.
    fn change(live: &mut LivePairs, ids: &Ids, wanted: &BTreeSet<[u32; 2]>) {
        live.keep_by_body(ids);
        let now: BTreeSet<[u32; 2]> = live
            .pairs(ids)
            .iter()
            .map(|pair| pair.map(|id| id.slot))
            .collect();
        let mut changes = live.change(ids).unwrap();
        for &[i, j] in now.symmetric_difference(wanted) {
            let has_begun = wanted.contains(&[i, j]);
            changes.set_partner(i, j, has_begun);
            changes.set_partner(j, i, has_begun);
            changes.note(j, i, has_begun);
        }
        changes.done();
    }

    #[test]
    fn both_forms_report_the_same_events() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let (ids, mut lists, mut live) = (ids(20), PairLog::default(), LivePairs::default());
        for frame in 0..600 {
            let mut below = |n: u32| random.next_u32() % n;
            let pairs = if frame % 7 == 0 { 0 } else { 30 };
            let wanted: BTreeSet<[u32; 2]> = (0..pairs)
                .map(|_| [below(20), below(20)])
                .filter(|[i, j]| i < j)
                .collect();
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
            }
        }
    }

    #[test]
    fn unread_events_hold_no_more_than_pairs() {
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
        assert_eq!(
            (events.begun().count(), events.persisting().count()),
            (2, 0)
        );
        assert_eq!(live.events(&ids).ended().count(), 2);
    }
}
