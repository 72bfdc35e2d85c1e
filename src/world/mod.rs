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

mod bounds;
mod bounds_tree;
mod digest;
mod local_origins;
mod margins;
mod meshes;
mod pair_test;
mod periodic;
mod query;
mod region;
mod regions;
mod shapes;
#[cfg(feature = "serde")]
mod snapshot;

pub use crate::bodies::Body;
#[cfg(feature = "serde")]
pub use crate::living::SnapshotError;
pub use crate::living::{
    BodyId, Event, Events, Groups, Motion, PairIds, PairLookup, WorldError, WorldPairs,
};
pub use meshes::Meshes;
pub use pair_test::PairTest;
pub use periodic::PeriodicWorld;
#[cfg(feature = "serde")]
pub use snapshot::WorldSnapshot;

pub(crate) use self::digest::of as digest_of;
use self::margins::check_margin;
pub(crate) use self::query::renew;
use crate::bodies::contract::check_pose;
use crate::bodies::{Bodies, UNTURNED};
use crate::counters::{Counters, Seconds};
use crate::culler::{CullError, Culler, CullerBuilder};
use crate::living::LivingSet;
use crate::settings::{Finder, Interest, SettingsError};
use crate::simd::in_default_mode;
use crate::volume::Shape;

/// A long-lived set of posed meshes and their culler: ids that stay, bodies at rest, groups,
/// margins, translations in f64, and pairs as a list or as events. See [`LivingSet`].
pub type World = LivingSet<Meshes>;

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
        Ok(Self::of(Meshes::new(&shapes, culler)))
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
        let Self { members, volumes } = self;
        let row = members.ids.slot(id)?;
        in_default_mode(|| check_pose(id.slot(), &rotation, &translation))?;
        if !volumes.is_at(row, rotation, translation) || volumes.rounded[row] != rounded {
            members.note(row, !volumes.bodies.dynamic[row]);
            volumes.bodies.rotation[row] = rotation;
            volumes.translation[row] = translation;
            volumes.rounded[row] = rounded;
        }
        Ok(())
    }

    /// Sets the bodies of interest, for the strategies that use them.
    ///
    /// # Errors
    /// A body that has been removed.
    pub fn set_interest(&mut self, ids: &[BodyId]) -> Result<(), WorldError> {
        let Self { members, volumes } = self;
        for &id in ids {
            members.ids.slot(id)?;
        }
        let former = std::mem::replace(&mut volumes.interest, ids.to_vec());
        for id in former.iter().chain(ids) {
            if let Ok(row) = members.ids.slot(*id) {
                volumes.is_of_interest[row] = false;
                members.note(row, false);
            }
        }
        volumes.look(&members.ids);
        Ok(())
    }

    /// The pair finder in use: the chosen one, or the last choice of `auto`.
    #[must_use]
    pub fn finder(&self) -> Finder {
        self.volumes.culler.finder()
    }

    /// Counters summed over all culls.
    #[must_use]
    pub fn counters(&self) -> &Counters {
        self.volumes.culler.counters()
    }

    /// Seconds summed over all culls.
    #[must_use]
    pub fn seconds(&self) -> &Seconds {
        self.volumes.culler.seconds()
    }
}
