//! Long-lived worlds: bodies come and go, and every frame asks who might touch.
//!
//! What an engine needs around a [`Culler`]: stable ids, static and dynamic bodies, groups and masks, contact margins,
//! translations in f64, and pairs as a list or as events. The promise is the same, margins included: at every
//! [`World::cull`], if two meshes, each grown by its body's margin and posed at its f64 translation, meet in exact
//! arithmetic, and one of them is dynamic, and their groups collide, the pair is reported.
//!
//! Bodies that come or go leave what is known of the others: until a sixteenth of all are new, the next cull takes a sort
//! more, and places static bodies anew. Poses, margins and groups change at the price of a copy. Lists depend on the calls alone, never on the CPU or on threads.
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
//! assert_eq!(world.events().begun, [[still, moving]]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod body;
mod error;
mod events;
mod ids;
mod local;
mod lookup;
mod margins;
mod pair_test;
mod regions;

pub use crate::bodies::Groups;
pub use body::Body;
pub use error::WorldError;
pub use events::Events;
pub use ids::BodyId;
pub use lookup::PairLookup;
pub use pair_test::PairTest;

pub(crate) use self::events::Watch;
pub(crate) use self::ids::Ids;
use self::local::Local;
use self::margins::{Margins, check_margin};
use crate::bodies::Bodies;
use crate::bodies::contract::{ContractError, check_number, check_pose, check_shape};
use crate::counters::{Counters, Seconds};
use crate::culler::{CullError, Culler, CullerBuilder};
use crate::settings::{Interest, SettingsError};
use crate::volume::Shape;

/// Bodies in slots, and their culler.
#[derive(Debug)]
pub struct World {
    shapes: Vec<Shape>,
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
    watch: Watch,
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
        let culler = culler.build(&shapes, &Bodies::default())?;
        Ok(Self {
            models: (0..shapes.len() as u32).collect(),
            shapes,
            bodies: Bodies::default(),
            ids: Ids::default(),
            shape: Vec::new(),
            translation: Vec::new(),
            margin: Vec::new(),
            groups: Vec::new(),
            margins: Margins::default(),
            interest: Vec::new(),
            culler,
            watch: Watch::default(),
            replaced: false,
            regrouped: false,
        })
    }

    /// Adds a shape. Bodies take it by the returned number.
    ///
    /// # Errors
    /// A shape beyond the contract, or with other slab directions than those before; nothing is added.
    pub fn add_shape(&mut self, shape: Shape) -> Result<u32, WorldError> {
        let model = self.culler.add_shape(&shape)?;
        self.models.push(model);
        self.shapes.push(shape);
        Ok(self.shapes.len() as u32 - 1)
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
        self.bodies.dynamic[slot] = body.dynamic;
        self.bodies.rotation[slot] = body.rotation;
        self.shape[slot] = body.shape;
        self.translation[slot] = body.translation;
        self.margin[slot] = body.margin;
        self.regrouped |= self.groups[slot] != body.groups;
        self.groups[slot] = body.groups;
        self.replaced = true;
        Ok(self.ids.id(slot as u32))
    }

    /// Removes a body. Pairs of the last cull still name it; the next cull's don't.
    ///
    /// # Errors
    /// A body that has been removed before.
    pub fn remove(&mut self, id: BodyId) -> Result<(), WorldError> {
        self.ids.remove(id)?;
        self.replaced = true;
        Ok(())
    }

    /// The body as it is now.
    ///
    /// # Errors
    /// A body that has been removed.
    pub fn body(&self, id: BodyId) -> Result<Body, WorldError> {
        let slot = self.ids.slot(id)?;
        Ok(Body {
            shape: self.shape[slot],
            dynamic: self.bodies.dynamic[slot],
            rotation: self.bodies.rotation[slot],
            translation: self.translation[slot],
            groups: self.groups[slot],
            margin: self.margin[slot],
        })
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
        self.regrouped |= self.groups[slot] != body.groups;
        self.bodies.dynamic[slot] = body.dynamic;
        self.bodies.rotation[slot] = body.rotation;
        self.shape[slot] = body.shape;
        self.translation[slot] = body.translation;
        self.groups[slot] = body.groups;
        self.margin[slot] = body.margin;
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
        check_pose(slot, &rotation, &translation)?;
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

    /// Finds the pairs that might touch now.
    ///
    /// # Errors
    /// Never for bodies that this world has taken.
    pub fn cull(&mut self) -> Result<(), WorldError> {
        self.place();
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
        self.culler.cull(&self.bodies)?;
        Ok(())
    }

    /// The pairs of the last cull, the lower slot first.
    pub fn pairs(&self) -> impl ExactSizeIterator<Item = [BodyId; 2]> + '_ {
        let pairs = self.culler.pairs().iter();
        pairs.map(|pair| pair.map(|slot| self.ids.id(slot)))
    }

    /// What the last cull reports that it didn't at the last call of this, and the other way round.
    pub fn events(&mut self) -> &Events {
        let (pairs, ids) = (self.culler.pairs().iter(), &self.ids);
        self.watch
            .look(pairs.map(|pair| pair.map(|slot| ids.id(slot))))
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

    /// Brings all bodies near local origins, in the models that their margins and rounding call for.
    fn place(&mut self) {
        let ids = &self.ids;
        let present = (0..ids.slots()).filter(|&slot| ids.present()[slot]);
        let reach = |slot: usize| self.shapes[self.shape[slot] as usize].reach;
        let size = |slot| f64::from(reach(slot)) + f64::from(self.margin[slot]);
        let local = Local::of(present.clone().map(|slot| (slot, self.translation[slot], size(slot))));
        let mut changed = false;
        for slot in present {
            let (place, moved) = local.place(slot, self.translation[slot]);
            let (number, margin) = (self.models[self.shape[slot] as usize], self.margin[slot]);
            let grow = |model, margin| self.culler.grow(model, margin);
            let model = self
                .margins
                .model(number, reach(slot), margin, moved, grow);
            let other_model = self.bodies.shape[slot] != model;
            let other_place = self.bodies.translation[slot] != place;
            changed |= other_model;
            self.replaced |= !self.bodies.dynamic[slot] && (other_model || other_place);
            self.bodies.shape[slot] = model;
            self.bodies.translation[slot] = place;
        }
        if changed && !self.replaced {
            self.culler.reread_shapes(&self.bodies);
        }
    }

    /// Tells the culler of the bodies of interest that are still there.
    fn look(&mut self) {
        let living = |id: &BodyId| self.ids.slot(*id).is_ok();
        let slots = self.interest.iter().filter(|id| living(id));
        let slots = slots.map(|id| id.slot).collect();
        self.culler.set_interest(Interest::Bodies(slots));
    }

    /// Checks a body that is to take a slot.
    fn check(&self, slot: usize, body: &Body) -> Result<(), ContractError> {
        check_number(slot + 1)?;
        check_shape(slot, body.shape, &self.shapes)?;
        check_pose(slot, &body.rotation, &body.translation)?;
        check_margin(slot, self.shapes[body.shape as usize].reach, body.margin)
    }
}
