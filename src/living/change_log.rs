//! A log of the pairs that began or ended since events were last read.

use super::BodyId;
use super::events::Changes;

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
