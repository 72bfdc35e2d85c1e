//! What every long-lived set of bodies is: stable ids, groups, excluded pairs, the bodies that have
//! changed, the reported pairs, their events, and snapshots.
//!
//! A [`LivingSet`] holds these. Its bodies' volumes are in a [`VolumeSource`]: posed meshes in a
//! `World`, boxes in a [`BoxWorld`](crate::BoxWorld).

mod cull;
mod error;
mod events;
mod ids;
mod live_pairs;
mod members;
mod movers;
mod pair_log;
mod pair_lookup;
mod reported_pairs;
#[cfg(feature = "serde")]
mod snapshot;
mod source;

pub use crate::bodies::{Groups, Motion};
pub use error::WorldError;
pub use events::{Event, Events};
pub use ids::BodyId;
pub use members::Members;
pub use pair_log::{PairIds, WorldPairs};
pub use pair_lookup::PairLookup;
#[cfg(feature = "serde")]
pub use snapshot::SnapshotError;
pub use source::{PortionReader, VolumeSource};

pub(crate) use self::ids::{Ids, renumber_column, renumbered_pairs};
#[cfg(feature = "serde")]
pub(crate) use self::snapshot::{
    IdsSnapshot, PairsSnapshot, RestoredMembers, Version, damaged, excluded_slots, flag_column,
    flagged_slots, restored_column,
};
use crate::bodies::contract::{ContractError, check_number};

/// A long-lived set of bodies and their pairs: [`BoxWorld`](crate::BoxWorld), or `World` for posed
/// meshes.
///
/// A frame costs time for the bodies that were inserted, removed or set to another value since the
/// last cull, for their neighbours, and for the pairs that change, and nothing for all others. All
/// pairs are found anew if more than a sixteenth has changed, in the first cull, and in the first
/// one after a world was restored, after [`Self::shrink_to_fit`] and after
/// [`Self::cull_in_portions`]; in a `World` also with a strategy that has a budget. All bodies of a
/// `World` are placed anew, and their pairs kept, in a frame in which local origins change, or in
/// which bodies are in far-apart regions. In every case the pairs are those of the present bodies.
///
/// A body is dynamic, resting or fixed ([`Motion`]). Pairs of two fixed bodies are never reported.
/// A body at rest keeps its pairs, also with others at rest: putting a body to rest or waking it
/// begins and ends no pair.
///
/// A clone continues as the original would, on its own threads.
#[derive(Clone, Debug)]
pub struct LivingSet<V: VolumeSource> {
    pub(crate) members: Members,
    pub(crate) volumes: V,
}

impl<V: VolumeSource> LivingSet<V> {
    /// A set without bodies.
    pub(crate) fn of(volumes: V) -> Self {
        Self { members: Members::default(), volumes }
    }

    /// Adds a body.
    ///
    /// # Errors
    /// A number of the body is outside of the contract, or there are more bodies than can be
    /// numbered.
    pub fn insert(&mut self, body: impl Into<V::Body>) -> Result<BodyId, WorldError> {
        let body = body.into();
        self.check(self.next_slot(), &body)?;
        if self.members.ids.need_rows() {
            self.renumber(Ids::add_rows);
        }
        let row = self.members.ids.next();
        if self.members.take() {
            self.volumes.push();
        }
        self.put(row, &body, true);
        self.members.note(row, true);
        Ok(self.members.ids.id(row as u32))
    }

    /// Removes a body. Pairs of the last cull still contain it; those of the next cull don't.
    ///
    /// # Errors
    /// The body has been removed before.
    pub fn remove(&mut self, id: BodyId) -> Result<(), WorldError> {
        let row = self.members.ids.remove(id)?;
        self.volumes.take_out(row);
        self.members.excluded.remove_all(row as u32);
        self.members.note(row, true);
        if self.members.ids.are_sparse() {
            self.renumber(Ids::compact);
        }
        Ok(())
    }

    /// The present body.
    ///
    /// # Errors
    /// The body has been removed.
    pub fn body(&self, id: BodyId) -> Result<V::Body, WorldError> {
        self.members.ids.slot(id).map(|row| self.body_at(row))
    }

    /// Whether the body exists.
    #[must_use]
    pub fn contains(&self, id: BodyId) -> bool {
        self.members.ids.slot(id).is_ok()
    }

    /// The ids of all bodies, sorted by slot.
    pub fn ids(&self) -> impl Iterator<Item = BodyId> + '_ {
        self.members.ids.iter()
    }

    /// All present bodies, sorted by slot.
    pub fn bodies(&self) -> impl Iterator<Item = (BodyId, V::Body)> + '_ {
        self.rows().map(|(_, id, body)| (id, body))
    }

    /// All present bodies, sorted by slot, each with its row: no row is much greater than the
    /// number of bodies.
    pub(crate) fn rows(&self) -> impl Iterator<Item = (usize, BodyId, V::Body)> + '_ {
        let ids = &self.members.ids;
        ids.filled().map(|row| (row, ids.id(row as u32), self.body_at(row)))
    }

    /// Changes any properties of a body. It may move by any distance: nothing is assumed about the
    /// motion between two culls. It costs nothing if the properties are equal to the present ones.
    ///
    /// # Errors
    /// The body has been removed, or a number is outside of the contract.
    pub fn set(&mut self, id: BodyId, body: impl Into<V::Body>) -> Result<(), WorldError> {
        let (row, body) = (self.members.ids.slot(id)?, body.into());
        self.volumes.check(id.slot(), &body)?;
        self.set_at(row, &body);
        Ok(())
    }

    /// [`Self::set`] of a present body to one within the contract.
    #[inline]
    pub(crate) fn set_checked(&mut self, id: BodyId, body: &V::Body) {
        self.set_at(self.members.ids.row_of(id.slot), body);
    }

    #[inline]
    fn set_at(&mut self, row: usize, body: &V::Body) {
        let (motion, groups) = V::common(body);
        let [is_dynamic, was_dynamic] = [motion.is_dynamic(), self.volumes.dynamic()[row]];
        let is_same = self.volumes.has(row, body)
            && is_dynamic == was_dynamic
            && groups == self.members.groups[row];
        if !is_same {
            self.members.note(row, !is_dynamic || !was_dynamic);
        }
        self.put(row, body, false);
    }

    /// Puts a body to rest, wakes it, or fixes it. The first two change no pair and cost nothing.
    ///
    /// # Errors
    /// The body has been removed.
    pub fn set_motion(&mut self, id: BodyId, motion: Motion) -> Result<(), WorldError> {
        let row = self.members.ids.slot(id)?;
        let body = self.volumes.body(row, motion, self.members.groups[row]);
        self.set_at(row, &body);
        Ok(())
    }

    /// Excludes a pair of bodies, such as two that a joint connects: it is not reported from the
    /// next cull on, until [`Self::include`] or until one of the bodies is removed. Returns whether
    /// the pair was included before; a body and itself are no pair.
    ///
    /// It costs one look-up per pair that passes the first test, and memory in proportion to the
    /// excluded pairs. Groups filter as before.
    ///
    /// ```
    /// # use sdop::{Aabb, BoxWorld};
    /// # let mut world = BoxWorld::new();
    /// # let cube = Aabb::new([0.0; 3], [1.0; 3]);
    /// let [upper, lower] = [world.insert(cube)?, world.insert(cube)?];
    /// world.exclude(upper, lower)?; // a joint connects them
    /// assert_eq!(world.cull()?.len(), 0);
    /// world.include(upper, lower)?; // it broke
    /// assert_eq!(world.cull()?.len(), 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// A body that has been removed.
    pub fn exclude(&mut self, a: BodyId, b: BodyId) -> Result<bool, WorldError> {
        self.members.set_excluded([a, b], true)
    }

    /// Includes an excluded pair again. Returns whether it was excluded.
    ///
    /// # Errors
    /// A body that has been removed.
    pub fn include(&mut self, a: BodyId, b: BodyId) -> Result<bool, WorldError> {
        self.members.set_excluded([a, b], false)
    }

    /// Whether a pair is excluded. A pair with a removed body is not.
    #[must_use]
    pub fn is_excluded(&self, a: BodyId, b: BodyId) -> bool {
        match [a, b].map(|id| self.members.ids.slot(id)) {
            [Ok(a), Ok(b)] => self.members.excluded.contains(a as u32, b as u32),
            _ => false,
        }
    }

    /// The excluded pairs, the lower slot first, sorted by slots.
    #[must_use]
    pub fn excluded(&self) -> Vec<[BodyId; 2]> {
        let pairs = self.members.excluded.sorted();
        pairs.into_iter().map(|pair| pair.map(|row| self.members.ids.id(row))).collect()
    }

    /// Number of bodies.
    #[must_use]
    pub fn len(&self) -> usize {
        self.members.ids.len()
    }

    /// Whether there are no bodies.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// One more than the largest possible [`BodyId::slot`].
    #[must_use]
    pub fn slots(&self) -> usize {
        self.members.ids.slots()
    }

    /// The slot that the next body gets.
    pub(crate) fn next_slot(&self) -> usize {
        self.members.ids.next_slot()
    }

    /// Frees all memory except that of the present bodies and shapes and the last pairs. Use it
    /// after a crowd. Free slots at the end are removed, too ([`Self::slots`]); ids are still never
    /// reused. The next cull starts without lists, takes as long as a first one, and reports the
    /// same pairs in the same order. A set does this by itself when most of it is gone.
    pub fn shrink_to_fit(&mut self) {
        self.volumes.drop_unused(&mut self.members);
        self.members.pairs.shrink_to_fit(&self.members.ids);
        self.renumber(Ids::compact);
    }

    /// Changes the rows of all columns, and frees what was kept about former ones. The pairs of the
    /// last cull stay.
    fn renumber(&mut self, change: fn(&mut Ids) -> Vec<u32>) {
        let plan = self.members.renumber(change);
        self.volumes.renumber(&plan);
    }

    #[inline]
    fn put(&mut self, row: usize, body: &V::Body, is_new: bool) {
        let (motion, groups) = V::common(body);
        self.members.put(row, motion, groups);
        self.volumes.put(row, body, is_new);
    }

    fn body_at(&self, row: usize) -> V::Body {
        let motion = Motion::of(self.volumes.dynamic()[row], self.members.resting[row]);
        self.volumes.body(row, motion, self.members.groups[row])
    }

    /// Checks a body for a slot.
    pub(crate) fn check(&self, slot: usize, body: &V::Body) -> Result<(), ContractError> {
        check_number(slot + 1)?;
        self.volumes.check(slot, body)
    }
}
