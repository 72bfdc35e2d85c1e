//! A log of the pairs that began or ended since events were last read.

use std::sync::Arc;

use super::reported_pairs::ReportedPairs;
use super::{BodyId, Event, Events};

/// The least number of changes for which a log is searched for those that cancel each other.
const LEAST_SEARCHED_CHANGES: usize = 1024;

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
    /// The changes from some pairs to others.
    pub fn between(before: Arc<ReportedPairs>, now: Arc<ReportedPairs>) -> Self {
        let change = |pair, has_begun| Some(PairChange { pair, has_begun });
        let events = Events::between(before, now);
        let changes = events.iter().filter_map(|event| match event {
            Event::Begun(pair) => change(pair, true),
            Event::Persisting(_) => None,
            Event::Ended(pair) => change(pair, false),
        });
        Self { changes: changes.collect(), lasting: 0 }
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

    /// Pairs that have begun, and those that have ended, each sorted.
    pub fn net(mut self) -> [Vec<[BodyId; 2]>; 2] {
        self.cancel();
        let of = |has_begun: bool| {
            let changes = self.changes.iter();
            let changes = changes.filter(move |change| change.has_begun == has_begun);
            changes.map(|change| change.pair).collect()
        };
        [of(true), of(false)]
    }

    /// Bytes of memory.
    pub fn bytes(&self) -> usize {
        self.changes.capacity() * size_of::<PairChange>()
    }
}
