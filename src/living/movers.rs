//! Frames in which few bodies change: a world searches only for the partners of these bodies, and
//! keeps the pairs of all others.
//!
//! A pair's verdict is a function of its two bodies: their places, their models, and whether their
//! pair counts. If any of these has changed since the last cull, the body is in the list of changed
//! bodies, so a pair of two other bodies keeps its verdict. For each changed body, an index of all
//! bodies finds the new partners. They are compared with the former ones, and the lists of the
//! partners concerned are changed as well.

use super::Ids;
use crate::bodies::PairRules;
use crate::broad_phase::{BODIES_IN_CACHE, Candidates, IndexedBox};
use crate::counters::RestCounters;
use crate::pairs::FoundPartners;

/// Changed bodies are searched one by one if they are at most one in this number of bodies.
/// Otherwise finding all pairs anew is faster. Beyond the nearer caches, a body that hasn't changed
/// in the two culls before counts as two: all that is to be known of it is read from memory.
const BODIES_PER_CHANGE: usize = 16;

/// The largest work of such a search, in boxes read per body of the world.
const WORK_PER_BODY: usize = 8;

/// An index pays if it serves for at least `LEAST_SERVICE` frames. After one that didn't, or after
/// a frame in which searching one by one took too long, the next frames find all pairs: twice as
/// many frames as the last time, up to `LONGEST_PAUSE`.
const LEAST_SERVICE: u32 = 8;
const LONGEST_PAUSE: u32 = 64;

/// The number of the first cull. Those of earlier changes are lower by two at least.
const FIRST_CULL: u32 = 2;

/// The bodies that have changed since the last cull, and an index of all.
#[derive(Clone, Debug)]
pub(crate) struct Movers {
    changed: Vec<u32>,
    /// The cull before which each slot's body last changed.
    changed_before: Vec<u32>,
    /// The number of the next cull.
    cull: u32,
    /// How many of the changed bodies weren't searched for in the cull before.
    thawed: usize,
    /// What it costs to search for the changed bodies, in bodies that are in the caches.
    cost: usize,
    /// Whether the next cull finds all pairs, because many bodies have changed or the pairs of the
    /// last cull aren't known.
    are_many: bool,
    /// The bodies as of the last cull. `None` after a cull that found all pairs.
    index: Option<Candidates>,
    /// Bodies in the index when it was made, and frames in which it was used.
    indexed: usize,
    served: u32,
    /// Frames that still find all pairs, and how many there were after the last attempt.
    pause: u32,
    last_pause: u32,
    /// The changed bodies.
    boxes: Vec<IndexedBox>,
    /// The last frame's, for its memory.
    found: FoundPartners,
}

impl Default for Movers {
    fn default() -> Self {
        Self {
            changed: Vec::new(),
            changed_before: Vec::new(),
            cull: FIRST_CULL,
            thawed: 0,
            cost: 0,
            are_many: true,
            index: None,
            indexed: 0,
            served: 0,
            pause: 0,
            last_pause: 0,
            boxes: Vec::new(),
            found: FoundPartners::default(),
        }
    }
}

impl Movers {
    /// Notes that a body has changed, or was inserted or removed.
    #[inline]
    pub fn note(&mut self, slot: usize, ids: &Ids) {
        if self.are_many {
            return;
        }
        if self.changed_before.len() <= slot {
            self.changed_before.resize(slot + 1, 0);
        }
        let former = std::mem::replace(&mut self.changed_before[slot], self.cull);
        if former != self.cull {
            self.changed.push(slot as u32);
            self.thawed += usize::from(former + 1 != self.cull);
            let is_far = ids.rows() > BODIES_IN_CACHE && former + 2 < self.cull;
            self.cost += 1 + usize::from(is_far);
            self.are_many = self.cost * BODIES_PER_CHANGE > ids.rows();
        }
    }

    /// Whether it is known already that the next cull finds all pairs anew.
    #[inline]
    pub fn are_many(&self) -> bool {
        self.are_many
    }

    /// Makes the next cull find all pairs anew, without former pairs.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// Notes that a cull has found all pairs of the present bodies.
    pub fn all_found(&mut self) {
        self.changed.clear();
        // No body has changed before the number that is skipped: the next cull thaws them all.
        self.number_next(2);
        self.are_many = false;
        self.pause = self.pause.saturating_sub(1);
    }

    /// The bodies that have changed since the last cull, if no others have. `None` if the pairs of
    /// that cull can't be updated by them.
    #[cfg(feature = "serde")]
    pub fn all_changed(&self) -> Option<&[u32]> {
        (!self.are_many).then_some(&self.changed)
    }

    /// Continues after a cull whose pairs are known, since which no bodies but these have changed.
    #[cfg(feature = "serde")]
    pub fn resume(&mut self, changed: &[u32], ids: &Ids) {
        self.forget();
        self.are_many = false;
        changed.iter().for_each(|&slot| self.note(slot as usize, ids));
    }

    /// Whether an index should be made after a cull that found all pairs: many bodies have come or
    /// gone, so the next frames will probably change few.
    pub fn expect_few(&self, ids: &Ids) -> bool {
        let are_many = ids.exchanged() * BODIES_PER_CHANGE > ids.rows();
        are_many && !self.are_many && self.pause == 0 && self.index.is_none()
    }

    /// Notes that the pairs of the last cull are unknown until [`Self::all_found`].
    pub fn lose_pairs(&mut self) {
        self.are_many = true;
        match self.index.take() {
            Some(_) if self.served < LEAST_SERVICE => self.back_off(),
            Some(_) => self.last_pause = 0,
            None => {}
        }
    }

    /// Whether no body has changed since the last cull.
    pub fn none_changed(&self) -> bool {
        self.changed.is_empty()
    }

    /// Notes that a cull has kept the pairs of all bodies that haven't changed.
    pub fn end(&mut self) {
        self.changed.clear();
        self.number_next(1);
    }

    /// Gives the next cull a number that is higher by `step`.
    fn number_next(&mut self, step: u32) {
        (self.thawed, self.cost) = (0, 0);
        self.cull = self.cull.checked_add(step).unwrap_or_else(|| {
            self.changed_before.fill(0);
            FIRST_CULL
        });
    }

    fn back_off(&mut self) {
        self.last_pause = (2 * self.last_pause).clamp(1, LONGEST_PAUSE);
        self.pause = self.last_pause;
    }

    /// Whether the pairs of the last cull can be updated by the changed bodies.
    pub fn are_few(&self) -> bool {
        !self.are_many && (self.pause == 0 || self.changed.is_empty())
    }

    /// Whether no body has changed since a cull whose pairs are known.
    pub fn has_present_pairs(&self) -> bool {
        !self.are_many && self.changed.is_empty()
    }

    /// The counters of a cull that searches only for the partners of the changed bodies.
    pub fn counters(&self, ids: &Ids) -> RestCounters {
        let is_present = |&&slot: &&u32| ids.present()[slot as usize];
        let present = self.changed.iter().filter(is_present).count();
        RestCounters {
            queried: self.changed.len() as u64,
            thawed: self.thawed as u64,
            kept: (ids.len() - present) as u64,
        }
    }

    /// The rows of the bodies that have changed.
    pub fn changed(&self) -> &[u32] {
        &self.changed
    }

    /// Whether the body in a row has changed.
    #[inline]
    pub fn is_changed(&self, row: u32) -> bool {
        self.changed_before.get(row as usize) == Some(&self.cull)
    }

    /// The bodies that have changed, to be searched for: those that are gone come last.
    pub fn take_changed(&mut self, ids: &Ids) -> FoundPartners {
        let mut found = std::mem::take(&mut self.found);
        found.partners.clear();
        found.ends.clear();
        found.bodies.clone_from(&self.changed);
        found.present = 0;
        for at in 0..found.bodies.len() {
            if ids.present()[found.bodies[at] as usize] {
                found.bodies.swap(found.present, at);
                found.present += 1;
            }
        }
        found
    }

    /// Whether an index of all bodies must be made before [`Self::find`].
    pub fn need_index(&self) -> bool {
        let index = self.index.as_ref();
        index.is_none_or(|index| index.len() > 2 * self.indexed)
    }

    /// Takes an index of all present bodies.
    pub fn take_index(&mut self, index: Candidates) {
        (self.indexed, self.served) = (index.len(), 0);
        self.index = Some(index);
    }

    /// Lists the boxes of the changed bodies, for [`Self::find`].
    pub fn list(&mut self, boxes: impl Iterator<Item = IndexedBox>) {
        self.boxes.clear();
        self.boxes.extend(boxes);
    }

    /// Moves changed bodies in the index, and lists the bodies whose boxes meet each one's. Groups
    /// have one entry per row. Returns the work that it took, in boxes and cells read; `None` if
    /// that is too much, or if there are more than `most` pairs.
    pub fn find(
        &mut self,
        found: &mut FoundPartners,
        rules: PairRules<'_>,
        most: usize,
    ) -> Option<usize> {
        let most_work = WORK_PER_BODY * rules.groups.len();
        let mut index = self.index.take()?;
        let work = index.find(&self.boxes, rules, found, [most_work, most]);
        match work {
            Some(_) => self.index = Some(index),
            None => self.back_off(),
        }
        work
    }

    /// Ends a cull in which these bodies were searched for.
    pub fn end_search(&mut self, found: FoundPartners) {
        self.found = found;
        self.end();
        self.served = self.served.saturating_add(1);
    }
}
