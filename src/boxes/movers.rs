//! Frames in which few boxes change: these alone are looked for, and the pairs of all others are
//! kept.
//!
//! A pair's verdict is a function of the ends, groups and motion of its two boxes, and of whether it
//! is excluded. A box of which any of these has changed since the last cull is in the list of changed
//! ones, as is one of the two where a pair was excluded or included, so a pair of two
//! others has the verdict that it had. The partners of each changed box are found anew by an index
//! of all boxes, compared with those that it had, and the differences are made at its partners too.

use super::BoxWorld;
use super::index::{BoxIndex, FIXED, GROUPED, Search, Seeker};
use crate::bodies::Groups;
use crate::simd::in_default_mode;
use crate::world::Ids;

/// Changed boxes are looked for one by one while they are at most one in so many: beyond, finding
/// all pairs anew is faster.
const BOXES_PER_CHANGE: usize = 8;

/// The same by the boxes that looking for them takes, for each box of the world.
const WORK_PER_BOX: usize = 8;

/// Boxes that are looked for together.
const SEEKERS_PER_BATCH: usize = 16;

/// How many boxes ahead what is read of one is prefetched.
const PREFETCH_DISTANCE: usize = 8;

/// An index pays if it serves for so many frames. After one that didn't, or a frame in which
/// looking one by one took too long, the next frames find all pairs: twice as many as the last
/// time, up to so many.
const LEAST_SERVICE: u32 = 8;
const LONGEST_PAUSE: u32 = 64;

/// Which boxes have changed since the last cull, and where all are.
#[derive(Clone, Debug)]
pub(super) struct Movers {
    changed: Vec<u32>,
    /// By slot.
    is_changed: Vec<bool>,
    /// So many have changed that the next cull finds all pairs, or the pairs of the last one aren't
    /// known.
    are_many: bool,
    /// As the boxes were at the last cull. None after one that found all pairs.
    index: Option<BoxIndex>,
    /// Boxes in the index when it was made, and frames that it has served for.
    indexed: usize,
    served: u32,
    /// Frames that still find all pairs, and how many there were after the last attempt.
    pause: u32,
    last_pause: u32,
    /// Partners of the changed boxes, one after the other, and where those of each end.
    found: Vec<u32>,
    ends: Vec<usize>,
    /// Those that a box has gained or lost.
    differences: Vec<(u32, bool)>,
    search: Search,
}

impl Default for Movers {
    fn default() -> Self {
        Self {
            changed: Vec::new(),
            is_changed: Vec::new(),
            are_many: true,
            index: None,
            indexed: 0,
            served: 0,
            pause: 0,
            last_pause: 0,
            found: Vec::new(),
            ends: Vec::new(),
            differences: Vec::new(),
            search: Search::default(),
        }
    }
}

impl Movers {
    /// Notes that a box has changed, come or gone.
    #[inline]
    pub fn note(&mut self, slot: usize, ids: &Ids) {
        if self.are_many {
            return;
        }
        if self.is_changed.len() <= slot {
            self.is_changed.resize(slot + 1, false);
        }
        if !std::mem::replace(&mut self.is_changed[slot], true) {
            self.changed.push(slot as u32);
            self.are_many = self.changed.len() * BOXES_PER_CHANGE > ids.slots();
        }
    }

    /// The next cull finds all pairs anew, and knows none before.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// Boxes are as a cull that found all pairs has seen them.
    pub fn all_found(&mut self) {
        self.changed.clear();
        self.is_changed.fill(false);
        self.are_many = false;
        self.pause = self.pause.saturating_sub(1);
    }

    /// The pairs of the last cull aren't known any more, until [`Self::all_found`].
    pub fn lose_pairs(&mut self) {
        self.are_many = true;
        match self.index.take() {
            Some(_) if self.served < LEAST_SERVICE => self.back_off(),
            Some(_) => self.last_pause = 0,
            None => {}
        }
    }

    fn back_off(&mut self) {
        self.last_pause = (2 * self.last_pause).clamp(1, LONGEST_PAUSE);
        self.pause = self.last_pause;
    }

    fn clear(&mut self) {
        for slot in self.changed.drain(..) {
            self.is_changed[slot as usize] = false;
        }
        self.served = self.served.saturating_add(1);
    }
}

impl BoxWorld {
    /// Changes the pairs of the last cull to those of now, by the boxes that have changed. False if
    /// that would take longer than finding them all, or if these boxes are in more than so many
    /// pairs: then nothing has happened.
    pub(super) fn cull_changed(&mut self, most: usize) -> bool {
        let movers = &self.movers;
        if movers.are_many || (movers.pause > 0 && !movers.changed.is_empty()) {
            return false;
        }
        if !movers.changed.is_empty() {
            if !in_default_mode(|| self.find_changed(most)) {
                self.movers.back_off();
                return false;
            }
            self.change_pairs();
            self.movers.clear();
        }
        self.ids.settle();
        true
    }

    /// What the index has of a box.
    fn tags(&self, slot: usize) -> u32 {
        let is_grouped = self.groups[slot] != Groups::ALL;
        (FIXED * u32::from(!self.dynamic[slot])) | (GROUPED * u32::from(is_grouped))
    }

    /// An index of all boxes as they are now.
    fn indexed(&self) -> BoxIndex {
        let present = || self.ids.iter().map(|id| id.slot());
        let boxes = present().map(|slot| &self.bounds[slot]);
        let mut index = BoxIndex::suited_to(boxes, self.ids.len());
        for slot in present() {
            index.put(slot as u32, &self.bounds[slot], self.tags(slot));
        }
        index
    }

    /// Puts changed boxes where they are now, and lists the partners of each. False if that takes
    /// too much work, or if there are pairs beyond `most`.
    fn find_changed(&mut self, most: usize) -> bool {
        let (mut work, most_work) = (0, WORK_PER_BOX * self.ids.slots());
        let present = self.ids.present();
        let index = match self.movers.index.take() {
            Some(mut index) if index.len() <= 2 * self.movers.indexed => {
                let changed = &self.movers.changed;
                for (number, &slot) in changed.iter().enumerate() {
                    if let Some(&next) = changed.get(number + PREFETCH_DISTANCE) {
                        index.prefetch(next);
                    }
                    let at = slot as usize;
                    work += if present[at] {
                        index.put(slot, &self.bounds[at], self.tags(at))
                    } else {
                        index.remove(slot)
                    };
                }
                index
            }
            _ => {
                let index = self.indexed();
                (self.movers.indexed, self.movers.served) = (index.len(), 0);
                index
            }
        };
        let mut found = std::mem::take(&mut self.movers.found);
        let mut ends = std::mem::take(&mut self.movers.ends);
        let mut search = std::mem::take(&mut self.movers.search);
        found.clear();
        ends.clear();
        let mut seekers = Vec::with_capacity(SEEKERS_PER_BATCH);
        let mut updates = 0;
        for slots in self.movers.changed.chunks(SEEKERS_PER_BATCH) {
            seekers.clear();
            seekers.extend(slots.iter().map(|&slot| Seeker {
                slot,
                is_present: present[slot as usize],
                aabb: &self.bounds[slot as usize],
                tags: self.tags(slot as usize),
                groups: &self.groups,
                excluded: &self.excluded,
            }));
            updates += seekers.iter().filter(|seeker| seeker.is_present).count() as u64;
            work += index.find_partners(&seekers, &mut search, &mut found, &mut ends);
            // A pair of two changed boxes is found twice.
            if work > most_work || found.len() / 2 > most {
                return false;
            }
        }
        self.movers.search = search;
        self.counters.updates += updates;
        self.counters.tests += work as u64;
        self.counters.hits += found.len() as u64;
        (self.movers.index, self.movers.found, self.movers.ends) = (Some(index), found, ends);
        true
    }

    /// Gives the changed boxes the partners that were found, and takes note at these.
    fn change_pairs(&mut self) {
        self.log.keep_by_body(&self.ids);
        self.log.extend(&self.ids);
        let Movers {
            changed,
            is_changed,
            found,
            ends,
            differences,
            ..
        } = &mut self.movers;
        let mut start = 0;
        for (number, (&slot, &end)) in changed.iter().zip(&*ends).enumerate() {
            let ahead =
                [2 * PREFETCH_DISTANCE, PREFETCH_DISTANCE].map(|steps| changed.get(number + steps));
            self.log.prefetch(ahead);
            let found = &found[std::mem::replace(&mut start, end)..end];
            compare(self.log.partners(slot), found, differences);
            if differences.is_empty() {
                continue;
            }
            let Some(mut changes) = self.log.change(&self.ids) else {
                return;
            };
            changes.replace(slot, found);
            for &(other, has_begun) in &*differences {
                // A partner that has changed finds this box by itself.
                let finds_itself = is_changed.get(other as usize) == Some(&true);
                if !finds_itself {
                    changes.set_partner(other, slot, has_begun);
                }
                if !finds_itself || slot < other {
                    changes.note(slot, other, has_begun);
                }
            }
            changes.done();
        }
    }
}

/// Lists what one sorted list lacks of another (false), and has in addition (true).
fn compare(before: &[u32], now: &[u32], differences: &mut Vec<(u32, bool)>) {
    differences.clear();
    if before == now {
        return;
    }
    let (mut before, mut now) = (before.iter().peekable(), now.iter().peekable());
    while let Some(&&next) = [before.peek(), now.peek()].into_iter().flatten().min() {
        let [had, has] = [before.next_if_eq(&&next), now.next_if_eq(&&next)];
        if had.is_some() != has.is_some() {
            differences.push((next, has.is_some()));
        }
    }
}
