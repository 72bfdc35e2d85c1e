//! Long-lived sets of boxes.
//!
//! A pair's verdict is a function of the ends, groups and motion of its two boxes, and of whether
//! the pair is excluded. A box counts as changed when its ends, groups or motion are set. When a
//! pair is excluded or included, one of its two boxes counts as changed.

use super::BoxCullerBuilder;
use super::frame::BoxFrames;
use crate::bodies::contract::ContractError;
use crate::bodies::{Aabb, Groups, Motion};
use crate::broad_phase::{Candidates, IndexedBox, tags};
use crate::counters::{RestCounters, VolumeCounters};
use crate::living::{
    BodyId, Ids, LivingSet, Members, PortionReader, VolumeSource, WorldError, renumber_column,
};
use crate::pairs::{FoundPartners, PairList};
use crate::threads::Threads;

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
/// events, as `World` has them for meshes. See [`LivingSet`].
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
pub type BoxWorld = LivingSet<Boxes>;

/// The boxes of a [`BoxWorld`], by row. Empty rows keep the ends of their last box.
#[derive(Clone, Debug)]
pub struct Boxes {
    pub(super) bounds: Vec<Aabb>,
    /// Whether each box is not fixed.
    pub(super) dynamic: Vec<bool>,
    pub(super) frames: BoxFrames,
    rest_counters: RestCounters,
}

impl Default for BoxWorld {
    fn default() -> Self {
        Self::of(Boxes::new(BoxCullerBuilder::default().frames_on(Threads::default())))
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
        Ok(Self::of(Boxes::new(culler.frames()?)))
    }

    /// Moves or resizes a box. It costs nothing if the ends are equal, and a box at rest stays at
    /// rest.
    ///
    /// # Errors
    /// The box has been removed, or its ends are infinite, NaN or in the wrong order.
    #[inline]
    pub fn set_bounds(&mut self, id: BodyId, bounds: Aabb) -> Result<(), WorldError> {
        let row = self.members.ids.slot(id)?;
        bounds.check(id.slot())?;
        self.move_to(row, bounds);
        Ok(())
    }

    /// Counters summed over all culls: boxes updated, candidates tested, pairs reported.
    #[must_use]
    pub fn counters(&self) -> &VolumeCounters {
        &self.volumes.frames.counters
    }

    /// Counters of the culls that kept the pairs of unchanged boxes, summed over all culls.
    #[must_use]
    pub fn rest_counters(&self) -> &RestCounters {
        &self.volumes.rest_counters
    }
}

impl Boxes {
    fn new(frames: BoxFrames) -> Self {
        Self {
            bounds: Vec::new(),
            dynamic: Vec::new(),
            frames,
            rest_counters: RestCounters::default(),
        }
    }

    /// The box in a row, for the index.
    fn indexed(&self, row: u32, ids: &Ids, groups: &[Groups]) -> IndexedBox {
        let at = row as usize;
        IndexedBox {
            slot: row,
            is_present: ids.present()[at],
            tags: tags(self.dynamic[at], groups[at]),
            aabb: self.bounds[at],
        }
    }
}

impl VolumeSource for Boxes {
    type Body = BoxBody;

    #[inline]
    fn common(body: &BoxBody) -> (Motion, Groups) {
        (body.motion, body.groups)
    }

    #[inline]
    fn check(&self, slot: usize, body: &BoxBody) -> Result<(), ContractError> {
        body.bounds.check(slot)
    }

    fn push(&mut self) {
        self.bounds.push(Aabb::default());
        self.dynamic.push(true);
    }

    #[inline]
    fn has(&self, row: usize, body: &BoxBody) -> bool {
        body.bounds.has_bits_of(&self.bounds[row])
    }

    #[inline]
    fn put(&mut self, row: usize, body: &BoxBody, _: bool) {
        self.bounds[row] = body.bounds;
        self.dynamic[row] = body.motion.is_dynamic();
    }

    #[inline]
    fn body(&self, row: usize, motion: Motion, groups: Groups) -> BoxBody {
        BoxBody { bounds: self.bounds[row], motion, groups }
    }

    #[inline]
    fn dynamic(&self) -> &[bool] {
        &self.dynamic
    }

    fn renumber(&mut self, plan: &[u32]) {
        renumber_column(&mut self.bounds, plan, Aabb::default());
        renumber_column(&mut self.dynamic, plan, true);
        self.frames.forget();
    }

    fn make_index(&mut self, members: &mut Members) {
        let Members { ids, groups, .. } = members;
        let present = ids.filled().map(|row| self.indexed(row as u32, ids, groups));
        let index = Candidates::of(present, ids.len());
        members.movers.take_index(index);
    }

    fn find_changed(&mut self, members: &mut Members, most: usize) -> Option<FoundPartners> {
        if members.movers.need_index() {
            self.make_index(members);
        }
        let mut found = members.movers.take_changed(&members.ids);
        let indexed = |row, ids: &Ids, groups: &[Groups]| self.indexed(row, ids, groups);
        let work = members.find(&mut found, most, indexed)?;
        self.frames.counters += VolumeCounters {
            updates: found.present as u64,
            tests: work as u64,
            hits: found.partners.len() as u64,
        };
        Some(found)
    }

    fn count_changed(&mut self, counted: RestCounters, _: usize, _: f64) {
        self.rest_counters += counted;
    }

    fn prepare(&mut self, members: &mut Members) -> Result<(), WorldError> {
        if std::mem::take(&mut members.replaced) {
            self.frames.replace(&self.dynamic, &members.ids.colliding(&members.groups));
        }
        Ok(())
    }

    fn list_all(
        &mut self,
        members: &Members,
        limit: Option<usize>,
        list: &mut PairList,
    ) -> Result<(), WorldError> {
        Ok(self.frames.list(&self.bounds, members.filter(), limit, list)?)
    }

    fn pass_on_all(
        &mut self,
        members: &Members,
        take: &mut PortionReader<'_>,
    ) -> Result<u64, WorldError> {
        Ok(self.frames.pass_on(&self.bounds, members.filter(), take)?)
    }

    fn pair_bytes(&self) -> usize {
        self.frames.pair_bytes()
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
        assert!(world.is_empty() && !world.members.replaced);
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
            assert_eq!(world.members.replaced, is_news, "call {call}");
            world.set_bounds(one, at(0.0)).unwrap();
            world.cull().unwrap();
            assert_eq!(world.pairs().len(), usize::from(call < 7 && call != 5), "call {call}");
            assert!(!world.members.replaced);
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
