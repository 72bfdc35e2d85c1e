//! Long-lived worlds: bodies come and go, and every frame asks who might touch.
//!
//! What an engine needs around a [`Culler`]: stable ids, static and dynamic bodies, groups and masks, contact margins,
//! translations in f64, and pairs as a list or as events. The promise is the same, margins included: at every
//! [`World::cull`], if two meshes, each grown by its body's margin and posed at its f64 translation, meet in exact
//! arithmetic, and one of them is dynamic, and their groups collide, the pair is reported.
//!
//! Bodies that come or go leave what is known of the others: until a sixteenth of all are new, the next cull takes a sort
//! more, and places static bodies anew. Poses, margins and groups change at the price of a copy. Lists, and their order, depend on
//! the bodies as they are now, never on the finder, the CPU or threads ([`World::cull`]).
//!
//! ```
//! use sdop::{Body, ProceduralShape, Shape, ShapeSpec, World};
//!
//! let cube = ProceduralShape::Box { x: 1.0, y: 1.0, z: 1.0 }.build()?;
//! let mut world = World::new(vec![Shape::build(&cube, &ShapeSpec::default())?])?;
//! let still = world.insert(Body { dynamic: false, ..Body::default() })?;
//! let moving = world.insert(Body { translation: [5.0, 0.0, 0.0], margin: 0.05, ..Body::default() })?;
//! world.cull()?;
//! assert_eq!(world.pairs().len(), 0);
//! world.set_pose(moving, [0.0, 0.0, 0.0, 1.0], [0.5, 0.0, 0.0])?;
//! world.cull()?;
//! assert!(world.events().begun().eq([[still, moving]]));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod body;
mod crowds;
#[cfg(feature = "serde")]
mod digest;
mod error;
mod events;
mod ids;
mod local;
mod lookup;
mod margins;
mod offset;
mod pair_log;
mod pair_test;
#[cfg(feature = "serde")]
mod saved;
mod shapes;
#[cfg(feature = "serde")]
mod snapshot;

pub use crate::bodies::Groups;
pub use body::Body;
pub use error::WorldError;
pub use events::{Event, Events};
pub use ids::BodyId;
pub use lookup::PairLookup;
pub use pair_log::{PairIds, WorldPairs};
pub use pair_test::PairTest;
#[cfg(feature = "serde")]
pub use saved::SnapshotError;
#[cfg(feature = "serde")]
pub use snapshot::WorldSnapshot;

pub(crate) use self::ids::{Ids, shrink_column};
use self::local::Local;
use self::margins::{Margins, check_margin};
pub(crate) use self::pair_log::PairLog;
#[cfg(feature = "serde")]
pub(crate) use self::saved::{IdsSnapshot, PairsSnapshot, Version, check_length};
use self::shapes::{ShapeSlot, check_shape};
use crate::bodies::Bodies;
use crate::bodies::contract::{ContractError, check_number, check_pose};
use crate::counters::{Counters, Seconds};
use crate::culler::{CullError, Culler, CullerBuilder};
use crate::settings::{Interest, SettingsError};
use crate::simd::in_default_mode;
use crate::volume::Shape;

/// Bodies in slots, and their culler.
///
/// A clone goes on as the original would, on threads that it starts for itself.
#[derive(Clone, Debug)]
pub struct World {
    shapes: Vec<ShapeSlot>,
    /// The culler's number of each shape.
    models: Vec<u32>,
    /// One entry a slot; empty slots keep their last body's.
    bodies: Bodies,
    ids: Ids,
    shape: Vec<u32>,
    translation: Vec<[f64; 3]>,
    margin: Vec<f32>,
    groups: Vec<Groups>,
    local: Local,
    margins: Margins,
    interest: Vec<BodyId>,
    culler: Culler,
    log: PairLog,
    /// Whether the culler must take up another set of bodies, or another pose of a static one.
    replaced: bool,
    regrouped: bool,
}

impl World {
    /// A world without bodies, culled with every default ([`Culler::new`]).
    ///
    /// # Errors
    /// A shape beyond the contract.
    pub fn new(shapes: Vec<Shape>) -> Result<Self, WorldError> {
        Self::with(shapes, &Culler::builder())
    }

    /// A world without bodies, culled as the builder says. Bodies of interest, where the strategy needs them, are set by
    /// [`Self::set_interest`].
    ///
    /// # Errors
    /// Settings that can't be carried out, a view cone, a shape beyond the contract, threads that the system refuses.
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
            ids: Ids::default(),
            shape: Vec::new(),
            translation: Vec::new(),
            margin: Vec::new(),
            groups: Vec::new(),
            local: Local::default(),
            margins: Margins::default(),
            interest: Vec::new(),
            culler,
            log: PairLog::default(),
            replaced: false,
            regrouped: false,
        })
    }

    /// Adds a body.
    ///
    /// # Errors
    /// A pose, shape or margin outside of the contract.
    pub fn insert(&mut self, body: Body) -> Result<BodyId, WorldError> {
        let slot = self.ids.next();
        self.check(slot, &body)?;
        if self.ids.take() {
            self.bodies.push(0, true, [0.0f32; 4], [0.0f32; 3]);
            self.shape.push(0);
            self.translation.push([0.0; 3]);
            self.margin.push(0.0);
            self.groups.push(Groups::ALL);
            self.regrouped = true; // the culler's column of groups lacks this slot
        }
        self.shapes[body.shape as usize].bodies += 1;
        self.put(slot, body);
        self.replaced = true;
        Ok(self.ids.id(slot as u32))
    }

    /// Removes a body. Pairs of the last cull still name it; the next cull's don't.
    ///
    /// # Errors
    /// A body that has been removed before.
    pub fn remove(&mut self, id: BodyId) -> Result<(), WorldError> {
        self.ids.remove(id)?;
        self.shapes[self.shape[id.slot()] as usize].bodies -= 1;
        self.replaced = true;
        Ok(())
    }

    /// The body as it is now.
    ///
    /// # Errors
    /// A body that has been removed.
    pub fn body(&self, id: BodyId) -> Result<Body, WorldError> {
        self.ids.slot(id).map(|slot| self.body_at(slot))
    }

    /// Whether the body is there.
    #[must_use]
    pub fn contains(&self, id: BodyId) -> bool {
        self.ids.slot(id).is_ok()
    }

    /// The ids of all bodies, sorted by slot.
    pub fn ids(&self) -> impl Iterator<Item = BodyId> + '_ {
        self.ids.iter()
    }

    /// All bodies as they are now, sorted by slot.
    pub fn bodies(&self) -> impl Iterator<Item = (BodyId, Body)> + '_ {
        self.ids().map(|id| (id, self.body_at(id.slot())))
    }

    /// Changes a body in any of its properties. A dynamic body's pose may change by any amount: nothing is assumed of the
    /// way between two culls.
    ///
    /// # Errors
    /// A body that has been removed; a pose, shape or margin outside of the contract.
    pub fn set(&mut self, id: BodyId, body: Body) -> Result<(), WorldError> {
        let slot = self.ids.slot(id)?;
        self.check(slot, &body)?;
        self.replaced |= !body.dynamic || !self.bodies.dynamic[slot];
        self.shapes[self.shape[slot] as usize].bodies -= 1;
        self.shapes[body.shape as usize].bodies += 1;
        self.put(slot, body);
        Ok(())
    }

    /// Moves a body: a step or a teleport.
    ///
    /// # Errors
    /// A body that has been removed; a pose outside of the contract.
    pub fn set_pose(
        &mut self,
        id: BodyId,
        rotation: impl Into<[f32; 4]>,
        translation: impl Into<[f64; 3]>,
    ) -> Result<(), WorldError> {
        let (rotation, translation) = (rotation.into(), translation.into());
        let slot = self.ids.slot(id)?;
        in_default_mode(|| check_pose(slot, &rotation, &translation))?;
        self.replaced |= !self.bodies.dynamic[slot];
        self.bodies.rotation[slot] = rotation;
        self.translation[slot] = translation;
        Ok(())
    }

    /// The bodies of interest from now on, for the strategies that look for them.
    ///
    /// # Errors
    /// A body that has been removed.
    pub fn set_interest(&mut self, ids: &[BodyId]) -> Result<(), WorldError> {
        for &id in ids {
            self.ids.slot(id)?;
        }
        self.interest = ids.to_vec();
        self.look();
        Ok(())
    }

    /// Finds the pairs that might touch now, and returns them: the lower slot first, sorted by slots. Under every strategy,
    /// list and order are a function of the bodies as they are now (with [`Order::OldestAnswer`](crate::Order), also of when
    /// pairs were refined, and with a budget of time, of the clock), whatever the finder, the threads and the calls before.
    /// Translations that f32 has to round are the exception: the origin about which they are rounded follows the bodies, and
    /// how much wider their volumes are depends on where it has been.
    ///
    /// # Errors
    /// Bodies more than 2⁶⁰ apart; [`Self::pairs`] are still those of the cull before.
    pub fn cull(&mut self) -> Result<WorldPairs<'_>, WorldError> {
        self.cull_with(|culler, bodies| culler.cull(bodies).map(|_| ()))
    }

    /// Culls by this function of the culler, which leaves the pairs in its list.
    fn cull_with(
        &mut self,
        cull: impl FnOnce(&mut Culler, &Bodies) -> Result<(), CullError>,
    ) -> Result<WorldPairs<'_>, WorldError> {
        self.prepare()?;
        let mut list = self.log.take();
        self.culler.swap_pairs(&mut list);
        let outcome = cull(&mut self.culler, &self.bodies);
        self.culler.swap_pairs(&mut list);
        self.log.put(list, &self.ids);
        outcome?;
        Ok(self.log.pairs())
    }

    /// Brings the culler up to date with the bodies.
    fn prepare(&mut self) -> Result<(), WorldError> {
        in_default_mode(|| self.place())?;
        self.sweep_margins(true);
        if self.replaced {
            self.culler.exchange(&self.bodies, self.ids.present());
            self.replaced = false;
            if !self.interest.is_empty() {
                self.look(); // another body may have taken the slot of one that was of interest
            }
        }
        if self.regrouped {
            let all = self.groups.iter().all(|&groups| groups == Groups::ALL);
            self.culler
                .set_groups((!all).then(|| self.groups.clone()))?;
            self.regrouped = false;
        }
        self.ids.settle();
        Ok(())
    }

    /// The pairs of the last cull, the lower slot first, sorted by slots.
    pub fn pairs(&self) -> impl ExactSizeIterator<Item = [BodyId; 2]> + '_ {
        self.log.pairs().iter()
    }

    /// What the last cull reports that it didn't at the last call of this, and the other way round. The events are apart
    /// from the world: bodies may be removed while they are read.
    pub fn events(&mut self) -> Events {
        self.log.events()
    }

    /// Number of bodies.
    #[must_use]
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Above every [`BodyId::slot`].
    #[must_use]
    pub fn slots(&self) -> usize {
        self.ids.slots()
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

    /// Brings all bodies near the local origin, in the model that their margin and rounding call for.
    fn place(&mut self) -> Result<(), WorldError> {
        let (ids, slots) = (&self.ids, 0..self.ids.slots());
        let present = slots.filter(|&slot| ids.present()[slot]);
        let translations = present.clone().map(|slot| self.composed(slot).0);
        let local = self.local.follow(translations);
        self.replaced |= local != self.local; // static bodies have moved, as seen from there
        if let Some(slot) = present
            .clone()
            .find(|&slot| !local.reaches(self.composed(slot).0))
        {
            return Err(WorldError::Apart(ids.id(slot as u32)));
        }
        self.local = local;
        let mut changed = false;
        for slot in present {
            let (translation, composed) = self.composed(slot);
            let (place, moved) = local.place(translation);
            let moved = moved + composed;
            let shape = self.shape[slot] as usize;
            let (reach, margin) = (self.shapes[shape].reach, self.margin[slot]);
            let grow = |model, margin| self.culler.grow(model, margin);
            let model = self
                .margins
                .model(self.models[shape], reach, margin, moved, grow);
            changed |= self.bodies.shape[slot] != model;
            self.bodies.shape[slot] = model;
            self.bodies.translation[slot] = place;
        }
        if changed && !self.replaced {
            self.culler.reread_shapes(&self.bodies);
        }
        Ok(())
    }

    /// The translation of the vertices of the body in a slot, and how far from the exact one it may be.
    fn composed(&self, slot: usize) -> ([f64; 3], f64) {
        let offset = self.shapes[self.shape[slot] as usize].pose_offset;
        offset::compose(self.bodies.rotation[slot], self.translation[slot], offset)
    }

    /// Tells the culler of the bodies of interest that are still there.
    fn look(&mut self) {
        let living = |id: &BodyId| self.ids.slot(*id).is_ok();
        let slots = self.interest.iter().filter(|id| living(id));
        let slots = slots.map(|id| id.slot).collect();
        self.culler.set_interest(Interest::Bodies(slots));
    }

    fn put(&mut self, slot: usize, body: Body) {
        self.regrouped |= self.groups[slot] != body.groups;
        self.bodies.dynamic[slot] = body.dynamic;
        self.bodies.rotation[slot] = body.rotation;
        self.shape[slot] = body.shape;
        self.translation[slot] = body.translation;
        self.groups[slot] = body.groups;
        self.margin[slot] = body.margin;
    }

    fn body_at(&self, slot: usize) -> Body {
        Body {
            shape: self.shape[slot],
            dynamic: self.bodies.dynamic[slot],
            rotation: self.bodies.rotation[slot],
            translation: self.translation[slot],
            groups: self.groups[slot],
            margin: self.margin[slot],
        }
    }

    /// Checks a body that is to take a slot.
    fn check(&self, slot: usize, body: &Body) -> Result<(), ContractError> {
        in_default_mode(|| {
            check_number(slot + 1)?;
            let reach = check_shape(slot, body.shape, &self.shapes)?;
            check_pose(slot, &body.rotation, &body.translation)?;
            check_margin(slot, reach, body.margin)
        })
    }
}
