//! The pairs of one cull. They are in the order in which they were found until they are first read,
//! and sorted from then on. Events leave that order as it is, if there are few pairs per body.

use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use super::BodyId;
use crate::pairs::{PairList, PairSorter, out_of_step};

/// The pairs of one cull by row, with the bodies of rows at that time.
#[derive(Debug, Default)]
pub(crate) struct ReportedPairs {
    /// The pairs in any order; empty once they have been sorted.
    found: Mutex<PairList>,
    sorted: OnceLock<PairList>,
    /// Whether someone has read the pairs in order.
    is_read: AtomicBool,
    len: usize,
    /// The body of each row. Rows are in the order of slots while pairs aren't sorted.
    pub(super) table: Arc<Vec<BodyId>>,
    /// Whether list and table hold these pairs and no more.
    is_compact: bool,
    sorter: Arc<Mutex<PairSorter>>,
}

/// The keys of a cull's pairs in ascending order.
pub(super) enum SortedKeys<'a> {
    OfList(&'a PairList),
    Copied(Vec<u64>),
}

impl SortedKeys<'_> {
    /// Number of keys.
    pub fn len(&self) -> usize {
        match self {
            Self::OfList(list) => list.len(),
            Self::Copied(keys) => keys.len(),
        }
    }

    /// A key by its number in the order.
    #[inline(always)]
    pub fn at(&self, at: usize) -> u64 {
        match self {
            Self::OfList(list) => list.key_at(at),
            Self::Copied(keys) => keys[at],
        }
    }
}

impl ReportedPairs {
    /// Pairs in any order.
    pub fn found(found: PairList, table: Arc<Vec<BodyId>>, sorter: Arc<Mutex<PairSorter>>) -> Self {
        Self { len: found.len(), found: Mutex::new(found), table, sorter, ..Self::default() }
    }

    /// Pairs that are sorted.
    pub fn sorted(slots: PairList, table: Arc<Vec<BodyId>>) -> Self {
        Self { len: slots.len(), sorted: slots.into(), table, ..Self::default() }
    }

    /// Number of pairs.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there is no pair.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The pairs, sorted, for someone who reads them.
    pub fn slots(&self) -> &PairList {
        self.is_read.store(true, Relaxed);
        self.sort()
    }

    fn sort(&self) -> &PairList {
        self.sorted.get_or_init(|| {
            let mut found = std::mem::take(&mut *lock(&self.found));
            found.sort(self.table.len(), &mut lock(&self.sorter));
            found
        })
    }

    /// As [`out_of_step`] from this cull to a later one. `None` also if the pairs of either have
    /// been sorted.
    pub fn out_of_step(&self, later: &Self) -> Option<[Vec<u64>; 2]> {
        // Every thread locks the earlier one first.
        let [before, now] = [lock(&self.found), lock(&later.found)];
        let are_sorted = [self, later].map(|reported| reported.sorted.get().is_some());
        (are_sorted == [false; 2]).then(|| out_of_step(&before, &now))?
    }

    /// The keys of the pairs, in order. Sorts the pairs themselves if they will be read
    /// (`are_read`), or if there are many per body. Otherwise they stay in the order in which they
    /// were found, so that the next ones can be compared with them in step.
    pub fn keys(&self, are_read: bool) -> SortedKeys<'_> {
        let copied = || {
            let found = lock(&self.found);
            let is_kept = !are_read && self.sorted.get().is_none();
            is_kept.then(|| found.sorted_keys(self.table.len(), &mut lock(&self.sorter)))?
        };
        copied().map_or_else(|| SortedKeys::OfList(self.sort()), SortedKeys::Copied)
    }

    /// Whether someone has read the pairs in order.
    pub fn are_read(&self) -> bool {
        self.is_read.load(Relaxed)
    }

    /// The memory of the list.
    pub fn into_list(self) -> PairList {
        let found = self.found.into_inner().unwrap_or_else(PoisonError::into_inner);
        self.sorted.into_inner().unwrap_or(found)
    }

    /// Bytes of the list.
    pub fn bytes(&self) -> usize {
        lock(&self.found).bytes() + self.sorted.get().map_or(0, PairList::bytes)
    }

    /// Sorted pairs, with a table of these bodies alone.
    pub fn compact(pairs: impl Iterator<Item = [BodyId; 2]>) -> Self {
        let (mut list, mut table) = (PairList::default(), Vec::new());
        let mut first = (None, 0);
        for [one, other] in pairs {
            if first.0 != Some(one) {
                first = (Some(one), table.len() as u32);
                table.push(one);
            }
            list.push(first.1, table.len() as u32);
            table.push(other);
        }
        list.shrink_to_fit();
        table.shrink_to_fit();
        Self { is_compact: true, ..Self::sorted(list, Arc::new(table)) }
    }

    /// The same pairs without spare memory.
    pub(super) fn compacted(self: &Arc<Self>) -> Arc<Self> {
        if self.is_compact { self.clone() } else { Arc::new(Self::compact(self.pairs().iter())) }
    }
}

/// The value of a lock. Nothing panics in the middle of a change.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
