//! Frames in which few boxes change: a pair's verdict is a function of the ends, groups and motion
//! of its two boxes, and of whether the pair is excluded. A box counts as changed when its ends,
//! groups or motion are set. When a pair is excluded or included, one of its two boxes counts as
//! changed.

use super::BoxWorld;
use crate::bodies::PairRules;
use crate::broad_phase::{BoxIndex, IndexedBox, tags};
use crate::counters::RestCounters;
use crate::simd::in_default_mode;

impl BoxWorld {
    /// Counters of the culls that kept the pairs of unchanged boxes, summed over all culls.
    #[must_use]
    pub fn rest_counters(&self) -> &RestCounters {
        &self.rest_counters
    }

    /// Updates the pairs of the last cull by the boxes that have changed. Returns false, without a
    /// change, if finding all pairs would be faster, or if these boxes are in more than `most`
    /// pairs.
    pub(super) fn cull_changed(&mut self, most: usize) -> bool {
        if !self.movers.are_few() {
            return false;
        }
        let is_any_changed = !self.movers.changed().is_empty();
        if is_any_changed && !in_default_mode(|| self.find_changed(most)) {
            return false;
        }
        self.rest_counters += self.movers.counters(&self.ids);
        if is_any_changed {
            self.movers.change_pairs(&mut self.log, &self.ids);
        } else {
            self.movers.none_changed();
        }
        self.ids.settle();
        true
    }

    /// Notes that a cull has found all pairs, and prepares the next one if few boxes will change
    /// until then.
    pub(super) fn all_found(&mut self) {
        self.movers.all_found();
        if self.movers.expect_few(&self.ids) {
            self.warm_up();
        }
    }

    /// Prepares what the next cull needs if few boxes change until then.
    pub(super) fn warm_up(&mut self) {
        self.log.keep_by_body(&self.ids);
        let index = in_default_mode(|| self.index_of_all());
        self.movers.take_index(index);
    }

    /// An index of all present boxes.
    fn index_of_all(&self) -> BoxIndex {
        let present = self.ids.filled().map(|slot| self.indexed(slot as u32));
        BoxIndex::of(present, self.ids.len())
    }

    /// Moves changed boxes in the index, and lists the partners of each.
    fn find_changed(&mut self, most: usize) -> bool {
        let mut movers = std::mem::take(&mut self.movers);
        if movers.need_index() {
            movers.take_index(self.index_of_all());
        }
        let rules = PairRules { groups: &self.groups, excluded: &self.excluded };
        let work = movers.find(|slot| self.indexed(slot), rules, most);
        if let Some(work) = work {
            let present = |&&slot: &&u32| self.ids.present()[slot as usize];
            self.counters.updates += movers.changed().iter().filter(present).count() as u64;
            self.counters.tests += work as u64;
            self.counters.hits += movers.found().1.len() as u64;
        }
        self.movers = movers;
        work.is_some()
    }

    /// The box in a slot, for the index.
    fn indexed(&self, slot: u32) -> IndexedBox {
        let at = slot as usize;
        IndexedBox {
            slot,
            is_present: self.ids.present()[at],
            tags: tags(self.dynamic[at], self.groups[at]),
            aabb: self.bounds[at],
        }
    }
}
