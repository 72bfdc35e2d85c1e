//! Long-lived worlds: bodies come and go, and each frame finds the pairs that might touch.
//!
//! A world gives an engine what it needs around a [`Culler`]: stable ids, static and dynamic
//! bodies, groups and masks, contact margins, translations in f64, and pairs as a list or as
//! events. The promise is the same and includes margins: every [`World::cull`] reports each pair of
//! meshes that meet in exact arithmetic, each grown by its body's margin and posed at its f64
//! translation, if at least one of them is dynamic, their groups collide, and the pair isn't
//! [excluded](World::exclude).
//!
//! A frame costs time for what changes: bodies that were set, inserted or removed, their
//! neighbours, and the pairs that begin or end ([`World`]). Lists and their order depend on the
//! present bodies, never on the finder, the CPU or threads ([`World::cull`]).
//!
//! ```
//! use sdop::{Body, ProceduralShape, Shape, ShapeSpec, World};
//!
//! let cube = ProceduralShape::Box { x: 1.0, y: 1.0, z: 1.0 }.build()?;
//! let mut world = World::new(vec![Shape::build(&cube, &ShapeSpec::default())?])?;
//! let still = world.insert(Body::default().fixed())?;
//! let moving = world.insert(Body { translation: [5.0, 0.0, 0.0], margin: 0.05, ..Body::default() })?;
//! world.cull()?;
//! assert_eq!(world.pairs().len(), 0);
//! world.set_pose(moving, [0.0, 0.0, 0.0, 1.0], [0.5, 0.0, 0.0])?;
//! world.cull()?;
//! assert!(world.events().begun().eq([[still, moving]]));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#[cfg(feature = "shapes")]
mod body;
#[cfg(feature = "shapes")]
mod bounds;
#[cfg(feature = "shapes")]
mod bounds_tree;
mod change_log;
#[cfg(feature = "shapes")]
mod changed_bodies;
#[cfg(feature = "shapes")]
mod crowds;
#[cfg(feature = "shapes")]
mod cull;
#[cfg(feature = "shapes")]
mod digest;
mod error;
mod events;
#[cfg(feature = "shapes")]
mod excluded;
mod ids;
mod live_pairs;
#[cfg(feature = "shapes")]
mod local_origins;
#[cfg(feature = "shapes")]
mod margins;
mod movers;
#[cfg(feature = "shapes")]
mod offset;
mod pair_log;
#[cfg(feature = "shapes")]
mod pair_lookup;
#[cfg(feature = "shapes")]
mod pair_test;
#[cfg(feature = "shapes")]
mod region;
#[cfg(feature = "shapes")]
mod regions;
mod reported_pairs;
#[cfg(feature = "shapes")]
mod shape_volumes;
#[cfg(feature = "shapes")]
mod shapes;
#[cfg(all(feature = "shapes", feature = "serde"))]
mod snapshot;
#[cfg(feature = "serde")]
mod snapshot_parts;

#[cfg(feature = "shapes")]
pub(crate) use self::body::UNTURNED;
pub use crate::bodies::{Groups, Motion};
#[cfg(feature = "shapes")]
pub use body::Body;
pub use error::WorldError;
pub use events::{Event, Events};
pub use ids::BodyId;
pub use pair_log::{PairIds, WorldPairs};
#[cfg(feature = "shapes")]
pub use pair_lookup::PairLookup;
#[cfg(feature = "shapes")]
pub use pair_test::PairTest;
#[cfg(all(feature = "shapes", feature = "serde"))]
pub use snapshot::WorldSnapshot;
#[cfg(feature = "serde")]
pub use snapshot_parts::SnapshotError;

#[cfg(feature = "shapes")]
pub(crate) use self::digest::of as digest_of;
pub(crate) use self::ids::{Ids, renumber_column, renumbered_pairs};
pub(crate) use self::live_pairs::LivePairs;
pub(crate) use self::movers::Movers;
#[cfg(feature = "shapes")]
pub(crate) use self::shape_volumes::{ShapeVolumes, compose, reach_about_pose};
#[cfg(feature = "serde")]
pub(crate) use self::snapshot_parts::{
    IdsSnapshot, PairsSnapshot, Version, excluded_slots, flag_column, flagged_slots,
    restored_column, restored_excluded,
};
#[cfg(feature = "shapes")]
use self::{
    local_origins::Origins,
    margins::{Margins, check_margin},
    shapes::{ShapeSlot, check_shape},
};
#[cfg(feature = "shapes")]
use crate::{
    bodies::Bodies,
    bodies::contract::{ContractError, check_number, check_pose},
    counters::{Counters, Seconds},
    culler::{CullError, Culler, CullerBuilder},
    settings::{Finder, Interest, SettingsError},
    simd::in_default_mode,
    volume::Shape,
};

/// A long-lived set of bodies and their culler: ids that stay, bodies at rest, groups, margins,
/// translations in f64, and pairs as a list or as events.
///
/// A frame costs time for the bodies that were inserted, removed or set to another value since the
/// last cull, for their neighbours, and for the pairs that change, and nothing for all others. All
/// pairs are found anew if more than a sixteenth has changed, with a strategy that has a budget, in
/// the first cull, and in the first one after a world was restored, after [`Self::shrink_to_fit`]
/// and after [`Self::cull_in_portions`]. All bodies are placed anew, and their pairs kept, in a
/// frame in which local origins change, or in which bodies are in far-apart regions
/// ([`World::cull`]). In every case the pairs are those of the present bodies.
///
/// A body is dynamic, resting or fixed ([`Motion`]). Pairs of two fixed bodies are never reported.
/// A body at rest keeps its pairs, also with others at rest: putting a body to rest or waking it
/// begins and ends no pair.
///
/// A clone continues as the original would, on its own threads.
#[cfg(feature = "shapes")]
#[derive(Clone, Debug)]
pub struct World {
    shapes: Vec<ShapeSlot>,
    /// The culler's number of each shape.
    models: Vec<u32>,
    /// One entry per slot; empty slots keep the values of their last body. Bodies that aren't fixed
    /// are dynamic.
    bodies: Bodies,
    resting: Vec<bool>,
    ids: Ids,
    shape: Vec<u32>,
    translation: Vec<[f64; 3]>,
    margin: Vec<f32>,
    /// Whether each rotation was rounded from f64.
    rounded: Vec<bool>,
    groups: Vec<Groups>,
    margins: Margins,
    interest: Vec<BodyId>,
    /// Whether each slot has a body of interest.
    is_of_interest: Vec<bool>,
    culler: Culler,
    origins: Origins,
    log: LivePairs,
    movers: Movers,
    /// Whether the set of bodies, or a static body's pose, differs from that in the culler.
    replaced: bool,
    /// Whether a body's model differs from that in the culler.
    remodelled: bool,
    regrouped: bool,
}

#[cfg(feature = "shapes")]
impl World {
    /// A world without bodies, culled with all defaults ([`Culler::new`]).
    ///
    /// # Errors
    /// A shape is outside of the contract.
    pub fn new(shapes: Vec<Shape>) -> Result<Self, WorldError> {
        Self::with(shapes, &Culler::builder())
    }

    /// A world without bodies, culled with the choices of a builder. If the strategy needs bodies
    /// of interest, set them by [`Self::set_interest`].
    ///
    /// # Errors
    /// The settings can't be carried out or include a view cone, a shape is outside of the
    /// contract, or the system cannot start the threads.
    pub fn with(shapes: Vec<Shape>, culler: &CullerBuilder) -> Result<Self, WorldError> {
        let settings = &culler.settings;
        if let Some(interest) = &settings.interest {
            let refused = SettingsError::Interest {
                problem: format!("a world begins without bodies, {interest:?} has nothing to see"),
                hint: "leave it out, and name bodies with `set_interest`",
            };
            return Err(CullError::from(refused).into());
        }
        let culler = culler.clone().interest(Interest::Bodies(Vec::new()));
        let mut culler = culler.build_about_vertices(&shapes, &Bodies::default())?;
        culler.set_canonical();
        Ok(Self {
            models: (0..shapes.len() as u32).collect(),
            shapes: shapes.iter().map(ShapeSlot::new).collect(),
            bodies: Bodies::default(),
            resting: Vec::new(),
            ids: Ids::default(),
            shape: Vec::new(),
            translation: Vec::new(),
            margin: Vec::new(),
            rounded: Vec::new(),
            groups: Vec::new(),
            margins: Margins::default(),
            interest: Vec::new(),
            is_of_interest: Vec::new(),
            culler,
            origins: Origins::default(),
            log: LivePairs::default(),
            movers: Movers::default(),
            replaced: false,
            remodelled: false,
            regrouped: false,
        })
    }

    /// Adds a body.
    ///
    /// # Errors
    /// The pose, shape or margin is outside of the contract.
    pub fn insert(&mut self, body: Body) -> Result<BodyId, WorldError> {
        self.check(self.ids.next_slot(), &body)?;
        if self.ids.need_rows() {
            self.renumber(Ids::add_rows);
        }
        let slot = self.ids.next();
        if self.ids.take() {
            self.bodies.push(0, true, UNTURNED, [0.0f32; 3]);
            self.resting.push(false);
            self.rounded.push(false);
            self.is_of_interest.push(false);
            self.shape.push(0);
            self.translation.push([0.0; 3]);
            self.margin.push(0.0);
            self.groups.push(Groups::ALL);
            self.regrouped = true; // the culler's column of groups lacks this slot
        }
        self.shapes[body.shape as usize].bodies += 1;
        self.put(slot, body);
        self.movers.note(slot, &self.ids);
        self.replaced = true;
        Ok(self.ids.id(slot as u32))
    }

    /// Removes a body. Pairs of the last cull still contain it; those of the next cull don't.
    ///
    /// # Errors
    /// The body has been removed before.
    pub fn remove(&mut self, id: BodyId) -> Result<(), WorldError> {
        let slot = self.ids.remove(id)?;
        self.shapes[self.shape[slot] as usize].bodies -= 1;
        self.culler.excluded_mut().remove_all(slot as u32);
        self.is_of_interest[slot] = false;
        self.movers.note(slot, &self.ids);
        self.replaced = true;
        if self.ids.are_sparse() {
            self.renumber(Ids::compact);
        }
        Ok(())
    }

    /// The present body.
    ///
    /// # Errors
    /// A body that has been removed.
    pub fn body(&self, id: BodyId) -> Result<Body, WorldError> {
        self.ids.slot(id).map(|slot| self.body_at(slot))
    }

    /// Whether the body exists.
    #[must_use]
    pub fn contains(&self, id: BodyId) -> bool {
        self.ids.slot(id).is_ok()
    }

    /// The ids of all bodies, sorted by slot.
    pub fn ids(&self) -> impl Iterator<Item = BodyId> + '_ {
        self.ids.iter()
    }

    /// All present bodies, sorted by slot.
    pub fn bodies(&self) -> impl Iterator<Item = (BodyId, Body)> + '_ {
        self.rows().map(|(_, id, body)| (id, body))
    }

    /// All present bodies, sorted by slot, each with its row: no row is much greater than the
    /// number of bodies.
    pub(crate) fn rows(&self) -> impl Iterator<Item = (usize, BodyId, Body)> + '_ {
        self.ids.filled().map(|row| (row, self.ids.id(row as u32), self.body_at(row)))
    }

    /// Changes any properties of a body. A pose may change by any amount: nothing is assumed about
    /// the motion between two culls. It costs nothing if the properties are equal to the present
    /// ones.
    ///
    /// # Errors
    /// The body has been removed, or the pose, shape or margin is outside of the contract.
    pub fn set(&mut self, id: BodyId, body: Body) -> Result<(), WorldError> {
        let slot = self.ids.slot(id)?;
        self.check(id.slot(), &body)?;
        self.set_at(slot, body);
        Ok(())
    }

    /// [`Self::set`] of a present body to one within the contract.
    pub(crate) fn set_checked(&mut self, id: BodyId, body: Body) {
        self.set_at(self.ids.row_of(id.slot), body);
    }

    fn set_at(&mut self, slot: usize, body: Body) {
        let (is_dynamic, was_dynamic) = (body.motion.is_dynamic(), self.bodies.dynamic[slot]);
        let is_same = self.is_at(slot, body.rotation, body.translation)
            && body.rounded == self.rounded[slot]
            && body.margin.to_bits() == self.margin[slot].to_bits()
            && body.shape == self.shape[slot]
            && is_dynamic == was_dynamic
            && body.groups == self.groups[slot];
        if !is_same {
            self.replaced |= !is_dynamic || !was_dynamic;
            self.movers.note(slot, &self.ids);
        }
        self.shapes[self.shape[slot] as usize].bodies -= 1;
        self.shapes[body.shape as usize].bodies += 1;
        self.put(slot, body);
    }

    /// Moves a body by any distance. It costs nothing if the pose is equal, and a body at rest
    /// stays at rest.
    ///
    /// # Errors
    /// The body has been removed, or the pose is outside of the contract.
    pub fn set_pose(
        &mut self,
        id: BodyId,
        rotation: impl Into<[f32; 4]>,
        translation: impl Into<[f64; 3]>,
    ) -> Result<(), WorldError> {
        self.pose(id, (rotation.into(), false), translation.into())
    }

    /// [`Self::set_pose`] with a rotation in f64 ([`Body::turned`]): if f32 doesn't hold it, the
    /// body is grown by what rounding may move its points.
    ///
    /// # Errors
    /// As [`Self::set_pose`].
    pub fn set_pose_f64(
        &mut self,
        id: BodyId,
        rotation: impl Into<[f64; 4]>,
        translation: impl Into<[f64; 3]>,
    ) -> Result<(), WorldError> {
        let Body { rotation, rounded, .. } = Body::default().turned(rotation);
        self.pose(id, (rotation, rounded), translation.into())
    }

    fn pose(
        &mut self,
        id: BodyId,
        (rotation, rounded): ([f32; 4], bool),
        translation: [f64; 3],
    ) -> Result<(), WorldError> {
        let slot = self.ids.slot(id)?;
        in_default_mode(|| check_pose(id.slot(), &rotation, &translation))?;
        if !self.is_at(slot, rotation, translation) || self.rounded[slot] != rounded {
            self.replaced |= !self.bodies.dynamic[slot];
            self.movers.note(slot, &self.ids);
            self.bodies.rotation[slot] = rotation;
            self.translation[slot] = translation;
            self.rounded[slot] = rounded;
        }
        Ok(())
    }

    /// Puts a body to rest, wakes it, or fixes it. The first two change no pair and cost nothing.
    ///
    /// # Errors
    /// A body that has been removed.
    pub fn set_motion(&mut self, id: BodyId, motion: Motion) -> Result<(), WorldError> {
        let body = self.body(id)?;
        self.set(id, Body { motion, ..body })
    }

    /// Whether the body in a slot has this pose, bit by bit.
    fn is_at(&self, slot: usize, rotation: [f32; 4], translation: [f64; 3]) -> bool {
        rotation.map(f32::to_bits) == self.bodies.rotation[slot].map(f32::to_bits)
            && translation.map(f64::to_bits) == self.translation[slot].map(f64::to_bits)
    }

    /// Sets the bodies of interest, for the strategies that use them.
    ///
    /// # Errors
    /// A body that has been removed.
    pub fn set_interest(&mut self, ids: &[BodyId]) -> Result<(), WorldError> {
        for &id in ids {
            self.ids.slot(id)?;
        }
        let former = std::mem::replace(&mut self.interest, ids.to_vec());
        for id in former.iter().chain(ids) {
            if let Ok(slot) = self.ids.slot(*id) {
                self.is_of_interest[slot] = false;
                self.movers.note(slot, &self.ids);
            }
        }
        self.look();
        Ok(())
    }

    /// Number of bodies.
    #[must_use]
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Whether there are no bodies.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// One more than the largest possible [`BodyId::slot`].
    #[must_use]
    pub fn slots(&self) -> usize {
        self.ids.slots()
    }

    /// The slot that the next body gets.
    pub(crate) fn next_slot(&self) -> usize {
        self.ids.next_slot()
    }

    /// The pair finder in use: the chosen one, or the last choice of `auto`.
    #[must_use]
    pub fn finder(&self) -> Finder {
        self.culler.finder()
    }

    /// Counters summed over all culls.
    #[must_use]
    pub fn counters(&self) -> &Counters {
        self.culler.counters()
    }

    /// Seconds summed over all culls.
    #[must_use]
    pub fn seconds(&self) -> &Seconds {
        self.culler.seconds()
    }

    /// Marks the present bodies of interest, and passes them to the culler.
    fn look(&mut self) {
        let slots = self.interest.iter().filter_map(|id| self.ids.slot(*id).ok());
        let slots: Vec<u32> = slots.map(|slot| slot as u32).collect();
        for &slot in &slots {
            self.is_of_interest[slot as usize] = true;
        }
        self.culler.set_interest(Interest::Bodies(slots));
    }

    fn put(&mut self, slot: usize, body: Body) {
        let former = self.groups[slot];
        self.regrouped |= former != body.groups;
        self.replaced |= former.collide_with_none() != body.groups.collide_with_none();
        self.bodies.dynamic[slot] = body.motion.is_dynamic();
        self.resting[slot] = body.motion == Motion::Resting;
        self.bodies.rotation[slot] = body.rotation;
        self.rounded[slot] = body.rounded;
        self.shape[slot] = body.shape;
        self.translation[slot] = body.translation;
        self.groups[slot] = body.groups;
        self.margin[slot] = body.margin;
    }

    fn body_at(&self, slot: usize) -> Body {
        Body {
            shape: self.shape[slot],
            motion: Motion::of(self.bodies.dynamic[slot], self.resting[slot]),
            rotation: self.bodies.rotation[slot],
            translation: self.translation[slot],
            rounded: self.rounded[slot],
            groups: self.groups[slot],
            margin: self.margin[slot],
        }
    }

    /// Checks a body for a slot.
    pub(crate) fn check(&self, slot: usize, body: &Body) -> Result<(), ContractError> {
        in_default_mode(|| {
            check_number(slot + 1)?;
            let reach = check_shape(slot, body.shape, &self.shapes)?;
            check_pose(slot, &body.rotation, &body.translation)?;
            check_margin(slot, reach, body.margin)
        })
    }
}
