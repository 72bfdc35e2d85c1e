//! Long-lived worlds: bodies come and go, and every frame asks who might touch.
//!
//! What an engine needs around a [`Culler`]: stable ids, static and dynamic bodies, groups and
//! masks, contact margins, translations in f64, and pairs as a list or as events. The promise is
//! the same, margins included: at every [`World::cull`], if two meshes, each grown by its body's
//! margin and posed at its f64 translation, meet in exact arithmetic, and one of them is dynamic,
//! and their groups collide, and the pair isn't [excluded](World::exclude), it is reported.
//!
//! Bodies that come or go leave what is known of the others: until a sixteenth of all are new, the
//! next cull takes a sort more, and places static bodies anew. Poses, margins and groups change at
//! the price of a copy. Lists, and their order, depend on the bodies as they are now, never on the
//! finder, the CPU or threads ([`World::cull`]).
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

#[cfg(feature = "shapes")]
mod body;
#[cfg(feature = "shapes")]
mod bounds;
mod change_log;
#[cfg(feature = "shapes")]
mod crowds;
#[cfg(all(feature = "shapes", feature = "serde"))]
mod digest;
mod error;
mod events;
#[cfg(feature = "shapes")]
mod excluded;
mod ids;
mod live_pairs;
#[cfg(feature = "shapes")]
mod local;
#[cfg(feature = "shapes")]
mod lookup;
#[cfg(feature = "shapes")]
mod margins;
#[cfg(feature = "shapes")]
mod offset;
mod pair_log;
#[cfg(feature = "shapes")]
mod pair_test;
#[cfg(feature = "shapes")]
mod region;
#[cfg(feature = "shapes")]
mod regions;
#[cfg(feature = "serde")]
mod saved;
#[cfg(feature = "shapes")]
mod shapes;
#[cfg(all(feature = "shapes", feature = "serde"))]
mod snapshot;
#[cfg(feature = "shapes")]
mod volumes;

pub use crate::bodies::Groups;
#[cfg(feature = "shapes")]
pub use body::Body;
pub use error::WorldError;
pub use events::{Event, Events};
pub use ids::BodyId;
#[cfg(feature = "shapes")]
pub use lookup::PairLookup;
pub use pair_log::{PairIds, WorldPairs};
#[cfg(feature = "shapes")]
pub use pair_test::PairTest;
#[cfg(feature = "serde")]
pub use saved::SnapshotError;
#[cfg(all(feature = "shapes", feature = "serde"))]
pub use snapshot::WorldSnapshot;

pub(crate) use self::ids::{Ids, shrink_column};
pub(crate) use self::live_pairs::LivePairs;
#[cfg(feature = "serde")]
pub(crate) use self::saved::{
    IdsSnapshot, PairsSnapshot, Version, check_length, damaged, restored_excluded,
};
#[cfg(feature = "shapes")]
pub(crate) use self::volumes::{ShapeVolumes, compose};
#[cfg(feature = "shapes")]
use self::{
    margins::{Margins, check_margin},
    pair_log::PairLog,
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

/// Bodies in slots, and their culler.
///
/// A clone goes on as the original would, on threads that it starts for itself.
#[cfg(feature = "shapes")]
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
    margins: Margins,
    interest: Vec<BodyId>,
    culler: Culler,
    log: PairLog,
    /// Whether the culler must take up another set of bodies, or another pose of a static one.
    replaced: bool,
    regrouped: bool,
}

#[cfg(feature = "shapes")]
impl World {
    /// A world without bodies, culled with every default ([`Culler::new`]).
    ///
    /// # Errors
    /// A shape beyond the contract.
    pub fn new(shapes: Vec<Shape>) -> Result<Self, WorldError> {
        Self::with(shapes, &Culler::builder())
    }

    /// A world without bodies, culled as the builder says. Bodies of interest, where the strategy
    /// needs them, are set by [`Self::set_interest`].
    ///
    /// # Errors
    /// Settings that can't be carried out, a view cone, a shape beyond the contract, threads that
    /// the system refuses.
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
        self.culler.excluded_mut().remove_all(id.slot);
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

    /// Changes a body in any of its properties. A dynamic body's pose may change by any amount:
    /// nothing is assumed of the way between two culls.
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

    /// Finds the pairs that might touch now, and returns them: the lower slot first, sorted by
    /// slots. Under every strategy, list and order are a function of the bodies as they are now
    /// (with [`Order::OldestAnswer`](crate::Order), also of when pairs were refined, and with a
    /// budget of time, of the clock), whatever the finder, the threads and the calls before. That
    /// holds for translations that f32 has to round, too: the origins about which they are rounded
    /// follow from the bodies as they are now.
    ///
    /// # Errors
    /// Bodies that can't be placed within 2⁶⁰ of an origin, which takes meshes far from their own
    /// origins; [`Self::pairs`] are still those of the cull before.
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

    /// What the last cull reports that it didn't at the last call of this, and the other way round.
    /// The events are apart from the world: bodies may be removed while they are read.
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

    /// The pair finder at work: the one asked for, or what `auto` picked last.
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
