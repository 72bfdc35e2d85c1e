//! Frames in which few bodies change: a pair's verdict is a function of its two bodies, each in a
//! model and at a place, of their groups and motion, of whether one of them is of interest, and of
//! whether the pair is excluded.
//!
//! A body counts as changed when any of these is set (for an excluded pair, one of its bodies), and
//! when its local place or its model changes because an origin has moved.

use std::time::Instant;

use super::World;
use crate::bodies::{Aabb, PairRules};
use crate::broad_phase::{BoxIndex, IndexedBox, tags};
use crate::culler::FoundPairs;
use crate::simd::in_default_mode;

impl World {
    /// Updates the pairs of the last cull by the bodies that have changed. Returns false if finding
    /// all pairs would be faster, if a pair's verdict depends on other pairs, or if these bodies
    /// are near more than `most` others: then all pairs must be found anew.
    pub(super) fn cull_changed(&mut self, most: usize) -> bool {
        if !self.movers.are_few() || !self.culler.judges_pairs_alone() {
            return false;
        }
        let start = Instant::now();
        let is_any_changed = !self.movers.changed().is_empty();
        if is_any_changed && !in_default_mode(|| self.find_changed(most)) {
            return false;
        }
        let counted = self.movers.counters(&self.ids);
        if is_any_changed {
            self.movers.change_pairs(&mut self.log, &self.ids);
            self.sweep_margins(true);
        } else {
            self.movers.none_changed();
        }
        self.ids.settle();
        let pairs = self.log.pairs(&self.ids).len();
        self.culler.count_sampled(counted, pairs, start.elapsed().as_secs_f64());
        true
    }

    /// Prepares what the next cull needs if few bodies change until then.
    pub(super) fn warm_up(&mut self) {
        if self.culler.judges_pairs_alone() {
            self.log.keep_by_body(&self.ids);
            let index = in_default_mode(|| self.index_of_all());
            self.movers.take_index(index);
            self.read_bounds();
        }
    }

    /// Moves changed bodies in the index, and lists the partners of each.
    fn find_changed(&mut self, most: usize) -> bool {
        if self.place_changed().is_err() || !self.movers.are_few() {
            return false;
        }
        let mut movers = std::mem::take(&mut self.movers);
        if movers.need_index() {
            movers.take_index(self.index_of_all());
            self.culler.count_sample_updates(self.ids.len());
        }
        let count = movers.put_gone_last(&self.ids);
        let boxes = self.culler.boxes_of(&self.bodies, &movers.changed()[..count]);
        self.culler.count_sample_updates(count);
        let mut boxes = boxes.into_iter();
        let box_of = |slot| self.indexed(slot, boxes.next());
        let rules = PairRules { groups: &self.groups, excluded: self.culler.excluded() };
        let work = movers.find(box_of, rules, most);
        if work.is_some() {
            let (changed, others, ends) = movers.found();
            let found = FoundPairs {
                bodies: &changed[..count],
                others,
                ends: &mut ends[..count],
                interest: &self.is_of_interest,
            };
            self.culler.test_found(&self.bodies, found);
            movers.end_gone(count);
        }
        self.movers = movers;
        work.is_some()
    }

    /// An index of all present bodies.
    fn index_of_all(&mut self) -> BoxIndex {
        let all: Vec<u32> = self.ids.filled().map(|slot| slot as u32).collect();
        let boxes = self.culler.boxes_of(&self.bodies, &all);
        let boxes = all.iter().zip(&boxes);
        let indexed = boxes.map(|(&slot, &aabb)| self.indexed(slot, Some(aabb)));
        BoxIndex::of(indexed, all.len())
    }

    /// The body in a slot, for the index: with its box, or without one if it was removed.
    fn indexed(&self, slot: u32, aabb: Option<Aabb>) -> IndexedBox {
        let at = slot as usize;
        IndexedBox {
            slot,
            is_present: aabb.is_some(),
            tags: tags(self.bodies.dynamic[at], self.groups[at]),
            aabb: aabb.unwrap_or_default(),
        }
    }
}
