//! The reported pairs: those of the last cull, and those of the last events.

use std::iter::Zip;
use std::slice::Iter;
use std::sync::{Arc, Mutex, PoisonError};

use super::reported_pairs::ReportedPairs;
use super::{BodyId, Events, Ids};
use crate::pairs::{PairList, PairSorter, PartnerPairs, Partners};

/// Pairs of bodies, the lower slot first.
#[derive(Clone, Copy, Debug)]
pub struct WorldPairs<'a> {
    slots: SlotPairs<'a>,
    ids: &'a [BodyId],
}

/// Pairs of slots, in one of their forms.
#[derive(Clone, Copy, Debug)]
enum SlotPairs<'a> {
    List(&'a PairList),
    ReportedPairs(&'a ReportedPairs),
    Partners(&'a Partners),
}

impl<'a> WorldPairs<'a> {
    pub(crate) fn new(slots: &'a PairList, ids: &'a [BodyId]) -> Self {
        let slots = SlotPairs::List(slots);
        Self { slots, ids }
    }

    pub(super) fn of_partners(slots: &'a Partners, ids: &'a [BodyId]) -> Self {
        let slots = SlotPairs::Partners(slots);
        Self { slots, ids }
    }

    /// Number of pairs.
    #[must_use]
    pub fn len(&self) -> usize {
        match self.slots {
            SlotPairs::List(list) => list.len(),
            SlotPairs::ReportedPairs(reported) => reported.len(),
            SlotPairs::Partners(partners) => partners.len(),
        }
    }

    /// Whether there is no pair.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The pairs in the order of the list.
    #[must_use]
    pub fn iter(&self) -> PairIds<'a> {
        let in_list = |list: &'a PairList| list.first().iter().zip(list.second());
        let slots = match self.slots {
            SlotPairs::List(list) => SlotIter::List(in_list(list)),
            SlotPairs::ReportedPairs(reported) => SlotIter::List(in_list(reported.slots())),
            SlotPairs::Partners(partners) => SlotIter::Partners(partners.iter()),
        };
        PairIds { slots, ids: self.ids }
    }

    /// The pairs sorted by slots. The pairs of a world's cull already have this order; portions
    /// don't.
    #[must_use]
    pub fn sorted(&self) -> Vec<[BodyId; 2]> {
        let mut pairs: Vec<_> = self.iter().collect();
        pairs.sort_unstable();
        pairs
    }
}

impl<'a> IntoIterator for WorldPairs<'a> {
    type Item = [BodyId; 2];
    type IntoIter = PairIds<'a>;
    fn into_iter(self) -> PairIds<'a> {
        self.iter()
    }
}

/// An iterator over the pairs of [`WorldPairs`].
#[derive(Clone, Debug)]
pub struct PairIds<'a> {
    slots: SlotIter<'a>,
    ids: &'a [BodyId],
}

#[derive(Clone, Debug)]
enum SlotIter<'a> {
    List(Zip<Iter<'a, u32>, Iter<'a, u32>>),
    Partners(PartnerPairs<'a>),
}

impl Iterator for PairIds<'_> {
    type Item = [BodyId; 2];
    fn next(&mut self) -> Option<[BodyId; 2]> {
        let [first, second] = match &mut self.slots {
            SlotIter::List(list) => list.next().map(|(&first, &second)| [first, second])?,
            SlotIter::Partners(partners) => partners.next()?,
        };
        Some(BodyId::pair_of([first, second], self.ids))
    }
    fn size_hint(&self) -> (usize, Option<usize>) {
        match &self.slots {
            SlotIter::List(list) => list.size_hint(),
            SlotIter::Partners(partners) => partners.size_hint(),
        }
    }
}

impl ExactSizeIterator for PairIds<'_> {}

impl ReportedPairs {
    /// The pairs with their ids.
    pub fn pairs(&self) -> WorldPairs<'_> {
        WorldPairs { slots: SlotPairs::ReportedPairs(self), ids: &self.table }
    }
}

/// The pairs of the last cull, those of the last events, and memory for the next cull.
///
/// Lists are shared with [`Events`], and none is copied: two lists are used alternately.
#[derive(Clone, Debug, Default)]
pub(crate) struct PairLog {
    pub(super) last: Arc<ReportedPairs>,
    pub(super) watched: Arc<ReportedPairs>,
    /// The list of events before: its memory is reused once nothing reads it.
    spare: Option<Arc<ReportedPairs>>,
    sorter: Arc<Mutex<PairSorter>>,
    /// Whether the lists are those of a larger world, and too long for this one.
    are_long: bool,
}

impl PairLog {
    /// A log of the pairs of a cull, and those of the last events.
    pub(super) fn of(last: Arc<ReportedPairs>, watched: Arc<ReportedPairs>) -> Self {
        Self { last, watched, ..Self::default() }
    }

    /// An empty list to cull into. There are no pairs until [`Self::put`].
    pub fn take(&mut self) -> PairList {
        let last = Arc::into_inner(std::mem::take(&mut self.last));
        let unread = last.or_else(|| Arc::into_inner(self.spare.take()?));
        let are_long = std::mem::take(&mut self.are_long);
        let unread = unread.filter(|_| !are_long);
        let mut list = unread.map(ReportedPairs::into_list).unwrap_or_default();
        list.clear();
        list
    }

    /// Takes the pairs of a cull in any order.
    pub fn put(&mut self, slots: PairList, ids: &Ids) {
        let (table, sorter) = (ids.table().clone(), self.sorter.clone());
        self.last = Arc::new(ReportedPairs::found(slots, table, sorter));
    }

    /// The pairs of the last cull.
    pub fn pairs(&self) -> WorldPairs<'_> {
        self.last.pairs()
    }

    /// The pairs that began, persisted or ended between the last call of this method and the last
    /// cull.
    pub fn events(&mut self) -> Events {
        let now = self.last.clone();
        let before = std::mem::replace(&mut self.watched, now.clone());
        self.spare = Some(before.clone());
        Events::between(before, now)
    }

    /// Bytes of the lists of pairs.
    pub fn bytes(&self) -> usize {
        let Self { last, watched, spare, sorter, .. } = self;
        let mut lists: Vec<_> = [last, watched].into_iter().chain(spare).collect();
        lists.sort_by_key(|list| Arc::as_ptr(list));
        lists.dedup_by_key(|list| Arc::as_ptr(list));
        let lists = lists.iter().map(|list| list.bytes());
        let sorter = sorter.lock().unwrap_or_else(PoisonError::into_inner);
        lists.sum::<usize>() + sorter.bytes()
    }

    /// Prepares for a change of rows: no memory of this log is of use afterwards.
    pub fn outlive_rows(&mut self) {
        (self.spare, self.sorter, self.are_long) = (None, Arc::default(), true);
        for list in [&mut self.last, &mut self.watched] {
            if list.table.len() > 2 * list.len() {
                *list = list.compacted();
            }
        }
    }

    /// Frees the memory that the pairs don't need.
    pub fn shrink_to_fit(&mut self) {
        (self.spare, self.sorter) = Default::default();
        let is_watched = Arc::ptr_eq(&self.last, &self.watched);
        self.last = self.last.compacted();
        self.watched = if is_watched { self.last.clone() } else { self.watched.compacted() };
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::super::ids::tests::filled as ids;
    use super::*;

    fn cull(log: &mut PairLog, ids: &Ids, pairs: impl IntoIterator<Item = [u32; 2]>) {
        let mut list = log.take();
        assert!(list.is_empty() && log.pairs().is_empty());
        pairs.into_iter().for_each(|[i, j]| list.push(i, j));
        log.put(list, ids);
    }

    /// Two lists take turns while events are read.
    #[test]
    fn two_lists_alternate() {
        let (mut log, ids) = (PairLog::default(), ids(3000));
        let mut bytes = Vec::new();
        for frame in 0..6 {
            let pairs = (0..2000).rev().filter(|i| i % 3 != frame % 3);
            cull(&mut log, &ids, pairs.map(|i| [i, i + 7]));
            let events = log.events();
            assert_eq!(events.now.pairs().len(), events.iter().count() - events.ended().count());
            bytes.push(log.bytes());
        }
        assert!(bytes[2..].iter().all(|&later| later == bytes[2]), "{bytes:?}");
        let one = 8 * 2000;
        assert!(bytes[2] < 4 * one, "two lists and a sort: {bytes:?}");
    }

    /// Memory of a crowd is given back and its pairs stay.
    #[test]
    fn crowd_memory_is_freed() {
        let (mut log, ids) = (PairLog::default(), ids(500));
        cull(&mut log, &ids, (0..499).flat_map(|i| (i + 1..500).map(move |j| [i, j])));
        let crowd = log.events();
        cull(&mut log, &ids, [[3, 4], [1, 2]]);
        let few = log.events();
        log.shrink_to_fit();
        assert!(log.bytes() < 1000, "{}", log.bytes());
        assert!(log.pairs().iter().eq(few.now.pairs().iter()) && log.pairs().len() == 2);
        assert_eq!(log.events().persisting().count(), 2);
        drop((crowd, few));
    }

    /// Events tell bodies of one slot apart.
    #[test]
    fn events_distinguish_generations() {
        let (mut log, mut ids) = (PairLog::default(), ids(3));
        cull(&mut log, &ids, [[0, 1], [1, 2]]);
        log.events();
        let former = ids.id(1);
        ids.remove(former).unwrap();
        ids.settle();
        ids.take();
        cull(&mut log, &ids, [[1, 2], [0, 2]]);
        let (a, b, c) = (ids.id(0), ids.id(1), ids.id(2));
        let events: Vec<_> = log.events().iter().collect();
        let wanted = [
            super::super::Event::Ended([a, former]),
            super::super::Event::Begun([a, c]),
            super::super::Event::Ended([former, c]),
            super::super::Event::Begun([b, c]),
        ];
        assert_eq!(events, wanted);
    }
}
