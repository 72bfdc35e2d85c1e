//! The pairs of one cull. They are in the order in which they were found until they or their events
//! are first read, and sorted from then on.

use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use crate::pairs::{PairList, PairSorter};

/// The pairs of one cull by slot, with the generations of slots at that time.
#[derive(Debug, Default)]
pub(crate) struct ReportedPairs {
    /// The pairs in any order; empty once they have been sorted.
    found: Mutex<PairList>,
    sorted: OnceLock<PairList>,
    len: usize,
    pub(super) generation: Arc<Vec<u32>>,
    sorter: Arc<Mutex<PairSorter>>,
}

impl ReportedPairs {
    /// Pairs in any order.
    pub fn found(
        found: PairList,
        generation: Arc<Vec<u32>>,
        sorter: Arc<Mutex<PairSorter>>,
    ) -> Self {
        Self {
            len: found.len(),
            found: Mutex::new(found),
            sorted: OnceLock::new(),
            generation,
            sorter,
        }
    }

    /// Pairs that are sorted.
    pub fn sorted(slots: PairList, generation: Arc<Vec<u32>>) -> Self {
        Self {
            len: slots.len(),
            sorted: slots.into(),
            generation,
            ..Self::default()
        }
    }

    /// Number of pairs.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there is no pair.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The pairs, sorted.
    pub fn slots(&self) -> &PairList {
        self.sorted.get_or_init(|| {
            let mut found = std::mem::take(&mut *lock(&self.found));
            found.sort(self.generation.len(), &mut lock(&self.sorter));
            found
        })
    }

    /// The memory of the list.
    pub fn into_list(self) -> PairList {
        let found = self
            .found
            .into_inner()
            .unwrap_or_else(PoisonError::into_inner);
        self.sorted.into_inner().unwrap_or(found)
    }

    /// Bytes of the list.
    pub fn bytes(&self) -> usize {
        lock(&self.found).bytes() + self.sorted.get().map_or(0, PairList::bytes)
    }

    /// A copy without spare memory.
    pub(super) fn compacted(&self) -> Self {
        let mut slots = PairList::default();
        slots.append(self.slots());
        let last = slots.second().iter().max();
        let named = last.map_or(0, |&last| last as usize + 1);
        let generation = if named < self.generation.len() {
            Arc::new(self.generation[..named].to_vec())
        } else {
            self.generation.clone()
        };
        Self::sorted(slots, generation)
    }
}

/// The value of a lock. Nothing panics in the middle of a change.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
