//! Boxes that come and go.

use super::BoxCullerBuilder;
use super::frame::BoxFrames;
use crate::bodies::contract::check_number;
use crate::bodies::{Aabb, ExcludedPairs, Groups, Motion, PairFilter};
use crate::counters::{RestCounters, VolumeCounters};
use crate::culler::CullError;
use crate::strategy::Output;
use crate::threads::Threads;
use crate::world::{BodyId, Events, Ids, LivePairs, Movers, WorldError, WorldPairs};

/// A box to be inserted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxBody {
    /// Its ends.
    pub bounds: Aabb,
    /// Whether it is dynamic, resting or fixed. Pairs of two fixed boxes are never reported.
    pub motion: Motion,
    /// Which boxes it may collide with.
    pub groups: Groups,
}

impl From<Aabb> for BoxBody {
    /// A dynamic box that collides with all.
    fn from(bounds: Aabb) -> Self {
        Self { bounds, motion: Motion::Dynamic, groups: Groups::ALL }
    }
}

/// A long-lived set of boxes: ids that stay, boxes at rest, groups, and pairs as a list or as
/// events, as [`World`](crate::world::World) has them for meshes.
///
/// A frame costs time for the boxes that were inserted, removed or set to another value since the
/// last cull, for their neighbours, and for the pairs that change, and nothing for all others. If
/// more than a sixteenth has changed, all pairs are found anew, as in a
/// [`BoxCuller`](super::BoxCuller). The same holds for the first cull, and for the first one after
/// a world was restored, after [`Self::shrink_to_fit`] and after [`Self::cull_in_portions`]. In
/// every case the pairs are exactly those of the present boxes.
///
/// A box is dynamic, resting or fixed ([`Motion`]). Pairs of two fixed boxes are never reported. A
/// box at rest keeps its pairs, also with others at rest: putting a box to rest or waking it begins
/// and ends no pair.
///
/// ```
/// use sdop::{Aabb, BoxWorld, Motion};
/// use sdop::boxes::BoxBody;
///
/// let mut world = BoxWorld::new();
/// let floor = Aabb::new([-9.0, -9.0, -1.0], [9.0, 9.0, 0.0]);
/// let floor = world.insert(BoxBody { motion: Motion::Fixed, ..floor.into() })?;
/// let crate_ = world.insert(Aabb::new([0.0, 0.0, 0.0], [1.0, 1.0, 1.0]))?;
/// world.cull()?;
/// assert!(world.events().begun().eq([[floor, crate_]]));
/// world.set_bounds(crate_, Aabb::new([0.0, 0.0, 0.1], [1.0, 1.0, 1.1]))?;
/// world.cull()?;
/// assert!(world.events().ended().eq([[floor, crate_]]));
/// # Ok::<(), sdop::WorldError>(())
/// ```
///
/// A clone continues as the original would, on its own threads.
#[derive(Clone, Debug)]
pub struct BoxWorld {
    /// One entry per slot; empty slots keep the ends of their last box.
    pub(super) bounds: Vec<Aabb>,
    /// Whether each box is not fixed.
    pub(super) dynamic: Vec<bool>,
    pub(super) resting: Vec<bool>,
    pub(super) groups: Vec<Groups>,
    pub(super) excluded: ExcludedPairs,
    pub(super) ids: Ids,
    pub(super) frames: BoxFrames,
    pub(super) counters: VolumeCounters,
    pub(super) rest_counters: RestCounters,
    pub(super) log: LivePairs,
    pub(super) movers: Movers,
    /// Number of slots whose groups don't collide with all.
    pub(super) grouped: usize,
    /// Whether the set of boxes, or a fixed box, differs from that in `frames`.
    pub(super) replaced: bool,
}

impl Default for BoxWorld {
    fn default() -> Self {
        Self::of(BoxCullerBuilder::default().frames_on(Threads::default()))
    }
}

impl BoxWorld {
    /// A world without boxes, culled with all defaults ([`BoxCuller::new`](super::BoxCuller::new)).
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// A world without boxes, culled with the choices of a builder.
    ///
    /// # Errors
    /// The system cannot start the threads.
    pub fn with(culler: &BoxCullerBuilder) -> Result<Self, WorldError> {
        Ok(Self::of(culler.frames()?))
    }

    fn of(frames: BoxFrames) -> Self {
        Self {
            bounds: Vec::new(),
            dynamic: Vec::new(),
            resting: Vec::new(),
            groups: Vec::new(),
            excluded: ExcludedPairs::default(),
            ids: Ids::default(),
            frames,
            counters: VolumeCounters::default(),
            rest_counters: RestCounters::default(),
            log: LivePairs::default(),
            movers: Movers::default(),
            grouped: 0,
            replaced: false,
        }
    }

    /// Adds a box.
    ///
    /// # Errors
    /// The box's ends are infinite, NaN or in the wrong order, or there are more boxes than can be
    /// numbered.
    pub fn insert(&mut self, body: impl Into<BoxBody>) -> Result<BodyId, WorldError> {
        let body = body.into();
        let slot = self.ids.next_slot();
        check_number(slot + 1)?;
        body.bounds.check(slot)?;
        if self.ids.need_rows() {
            self.renumber(Ids::add_rows);
        }
        let slot = self.ids.next();
        if self.ids.take() {
            self.bounds.push(body.bounds);
            self.dynamic.push(true);
            self.resting.push(false);
            self.groups.push(Groups::ALL);
        }
        self.put(slot, body);
        self.movers.note(slot, &self.ids);
        self.replaced = true;
        Ok(self.ids.id(slot as u32))
    }

    /// Removes a box. Pairs of the last cull still contain it; those of the next cull don't.
    ///
    /// # Errors
    /// The box has been removed before.
    pub fn remove(&mut self, id: BodyId) -> Result<(), WorldError> {
        let slot = self.ids.remove(id)?;
        self.excluded.remove_all(slot as u32);
        self.movers.note(slot, &self.ids);
        self.replaced = true;
        if self.ids.are_sparse() {
            self.renumber(Ids::compact);
        }
        Ok(())
    }

    /// The present box.
    ///
    /// # Errors
    /// The box has been removed.
    pub fn body(&self, id: BodyId) -> Result<BoxBody, WorldError> {
        self.ids.slot(id).map(|slot| self.body_at(slot))
    }

    /// Whether the box exists.
    #[must_use]
    pub fn contains(&self, id: BodyId) -> bool {
        self.ids.slot(id).is_ok()
    }

    /// The ids of all boxes, sorted by slot.
    pub fn ids(&self) -> impl Iterator<Item = BodyId> + '_ {
        self.ids.iter()
    }

    /// All present boxes, sorted by slot.
    pub fn bodies(&self) -> impl Iterator<Item = (BodyId, BoxBody)> + '_ {
        self.rows().map(|(_, id, body)| (id, body))
    }

    /// All present boxes, sorted by slot, each with its row: no row is much greater than the number
    /// of boxes.
    pub(crate) fn rows(&self) -> impl Iterator<Item = (usize, BodyId, BoxBody)> + '_ {
        self.ids.filled().map(|row| (row, self.ids.id(row as u32), self.body_at(row)))
    }

    /// Changes any properties of a box. It costs nothing if they are equal to the present ones.
    ///
    /// # Errors
    /// The box has been removed, or as [`Self::insert`].
    pub fn set(&mut self, id: BodyId, body: impl Into<BoxBody>) -> Result<(), WorldError> {
        let (slot, body) = (self.ids.slot(id)?, body.into());
        body.bounds.check(id.slot())?;
        self.set_at(slot, body);
        Ok(())
    }

    /// [`Self::set`] of a present box to a valid one.
    #[inline]
    pub(crate) fn set_checked(&mut self, id: BodyId, body: BoxBody) {
        self.set_at(self.ids.row_of(id.slot() as u32), body);
    }

    #[inline]
    fn set_at(&mut self, slot: usize, body: BoxBody) {
        let (is_dynamic, was_dynamic) = (body.motion.is_dynamic(), self.dynamic[slot]);
        let is_same = body.bounds.has_bits_of(&self.bounds[slot])
            && is_dynamic == was_dynamic
            && body.groups == self.groups[slot];
        if !is_same {
            self.replaced |= !is_dynamic || !was_dynamic;
            self.movers.note(slot, &self.ids);
        }
        self.put(slot, body);
    }

    /// Moves or resizes a box. It costs nothing if the ends are equal, and a box at rest stays at
    /// rest.
    ///
    /// # Errors
    /// As [`Self::set`].
    #[inline]
    pub fn set_bounds(&mut self, id: BodyId, bounds: Aabb) -> Result<(), WorldError> {
        let slot = self.ids.slot(id)?;
        bounds.check(id.slot())?;
        self.move_to(slot, bounds);
        Ok(())
    }

    /// Puts a box to rest, wakes it, or fixes it. The first two change no pair and cost nothing.
    ///
    /// # Errors
    /// The box has been removed.
    pub fn set_motion(&mut self, id: BodyId, motion: Motion) -> Result<(), WorldError> {
        let body = self.body(id)?;
        self.set(id, BoxBody { motion, ..body })
    }

    fn body_at(&self, slot: usize) -> BoxBody {
        BoxBody {
            bounds: self.bounds[slot],
            motion: Motion::of(self.dynamic[slot], self.resting[slot]),
            groups: self.groups[slot],
        }
    }

    fn put(&mut self, slot: usize, body: BoxBody) {
        self.bounds[slot] = body.bounds;
        self.dynamic[slot] = body.motion.is_dynamic();
        self.resting[slot] = body.motion == Motion::Resting;
        let former = std::mem::replace(&mut self.groups[slot], body.groups);
        self.replaced |= former.collide_with_none() != body.groups.collide_with_none();
        self.grouped += usize::from(body.groups != Groups::ALL);
        self.grouped -= usize::from(former != Groups::ALL);
    }

    /// Counts the boxes that don't collide with all, after the column has been replaced.
    pub(super) fn count_groups(&mut self) {
        let groups = self.groups.iter();
        self.grouped = groups.filter(|groups| **groups != Groups::ALL).count();
    }

    /// Finds the boxes that meet, not both fixed, whose groups collide and which aren't
    /// [excluded](Self::exclude), and returns their pairs: the lower slot first, sorted by slots,
    /// independent of the finder, of threads and of earlier calls.
    ///
    /// # Errors
    /// There are more pairs than memory holds: then there are none. Invalid boxes are rejected when
    /// they are inserted or set.
    pub fn cull(&mut self) -> Result<WorldPairs<'_>, WorldError> {
        if !self.cull_changed(usize::MAX) {
            let mut list = self.log.take(&self.ids);
            self.cull_into(Output::List(&mut list))?;
            CullError::check_memory(&mut list)?;
            self.log.put(list, &self.ids);
            self.all_found();
        }
        Ok(self.log.pairs(&self.ids))
    }

    /// Finds all pairs anew. Until [`Movers::all_found`], the next cull does so too.
    pub(super) fn cull_into(&mut self, output: Output<'_>) -> Result<(), WorldError> {
        self.movers.lose_pairs();
        if std::mem::take(&mut self.replaced) {
            self.frames.replace(&self.dynamic, &self.ids.colliding(&self.groups));
        }
        self.ids.settle();
        let groups = (self.grouped > 0).then_some(&*self.groups);
        let filter = PairFilter::new(groups, &self.excluded);
        let counted = self.frames.cull(&self.bounds, filter, output);
        self.counters += counted?;
        Ok(())
    }

    /// The pairs of the last cull, the lower slot first, sorted by slots.
    pub fn pairs(&self) -> impl ExactSizeIterator<Item = [BodyId; 2]> + '_ {
        self.log.pairs(&self.ids).iter()
    }

    /// The pairs that began, persisted or ended between the last call of this method and the last
    /// cull. Events don't borrow the world, so boxes may be removed while they are read. Drop them
    /// before the next cull, which otherwise copies the pairs.
    pub fn events(&mut self) -> Events {
        self.log.events(&self.ids)
    }

    /// Number of boxes.
    #[must_use]
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Whether there are no boxes.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// One more than the largest possible [`BodyId::slot`].
    #[must_use]
    pub fn slots(&self) -> usize {
        self.ids.slots()
    }

    /// The slot that the next box gets.
    pub(crate) fn next_slot(&self) -> usize {
        self.ids.next_slot()
    }

    /// Counters summed over all culls: boxes updated, candidates tested, pairs reported.
    #[must_use]
    pub fn counters(&self) -> &VolumeCounters {
        &self.counters
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;

    fn at(x: f32) -> Aabb {
        Aabb::new([x, 0.0, 0.0], [x + 1.0, 1.0, 1.0])
    }

    fn at_rest(x: f32) -> BoxBody {
        BoxBody { motion: Motion::Fixed, ..at(x).into() }
    }

    /// The next cull searches changed boxes and no others.
    #[test]
    fn only_changes_are_searched() {
        let mut world = BoxWorld::new();
        assert!(world.is_empty() && !world.replaced);
        let one = world.insert(at(0.0)).unwrap();
        let fixed = world.insert(at_rest(0.5)).unwrap();
        assert_eq!((world.is_empty(), world.len(), world.slots()), (false, 2, 2));
        // A change of the world, and whether the next cull must test boxes again.
        type Call = fn(&mut BoxWorld, BodyId, BodyId);
        let calls: [(Call, bool); 8] = [
            (|_, _, _| (), false),
            (|world, one, _| world.set_bounds(one, at(0.2)).unwrap(), false),
            (|world, one, _| world.set(one, at(0.1)).unwrap(), false),
            (|world, _, fixed| world.set_bounds(fixed, at(0.6)).unwrap(), true),
            (|world, _, fixed| world.set(fixed, at_rest(0.7)).unwrap(), true),
            (|world, one, _| world.set(one, at_rest(0.0)).unwrap(), true),
            (|world, one, _| world.set(one, at(0.0)).unwrap(), true),
            (|world, _, fixed| world.remove(fixed).unwrap(), true),
        ];
        world.cull().unwrap();
        for (call, (change, is_news)) in calls.into_iter().enumerate() {
            change(&mut world, one, fixed);
            assert_eq!(world.replaced, is_news, "call {call}");
            world.set_bounds(one, at(0.0)).unwrap();
            world.cull().unwrap();
            assert_eq!(world.pairs().len(), usize::from(call < 7 && call != 5), "call {call}");
            assert!(!world.replaced);
        }
        assert_eq!((world.is_empty(), world.len(), world.slots()), (false, 1, 2));
        world.remove(one).unwrap();
        assert_eq!((world.is_empty(), world.len(), world.slots()), (true, 0, 2));
    }

    /// Groups count where some or none collide with all.
    #[test]
    fn grouped_boxes_are_counted() {
        let only = |group| Groups { member: group, mask: group };
        for (groups, meet) in [
            ([Groups::ALL, Groups::ALL], true),
            ([Groups::ALL, only(1)], true),
            ([only(1), only(1)], true),
            ([only(1), only(2)], false),
        ] {
            let mut world = BoxWorld::new();
            for groups in groups {
                let body = BoxBody { groups, ..at(0.0).into() };
                world.insert(body).unwrap();
            }
            world.cull().unwrap();
            assert_eq!(world.pairs().len(), usize::from(meet), "{groups:?}");
        }
    }
}
