//! [`Variant`]: culling settings with a name, from which a contestant is built.

use super::counts::Volume;
use super::culling::Culling;
use crate::scene::Scene;
use sdop::settings::{CullSettings, Strategy};
use sdop::simd::Tier;
use sdop::volume::Shape;
use sdop::world::WorldError;

/// A named way to cull.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Variant {
    /// Its name in tables.
    pub name: String,
    /// Its culling settings.
    pub settings: CullSettings,
    /// Whether reported pairs are then tested by their convex hulls.
    pub hulls: bool,
    /// Whether a world culls, which keeps the pairs of bodies that haven't moved.
    #[serde(default)]
    pub in_world: bool,
}

impl Variant {
    /// Culling by some settings.
    #[must_use]
    pub fn of(name: String, settings: CullSettings) -> Self {
        Self { name, settings, hulls: false, in_world: false }
    }

    /// The same in a world.
    #[must_use]
    pub fn in_world(self) -> Self {
        Self { name: format!("{}, world", self.name), in_world: true, ..self }
    }

    /// A strategy with a scene's other settings, named after the strategy.
    #[must_use]
    pub fn strategy(own: &CullSettings, strategy: Strategy) -> Self {
        let settings = CullSettings { strategy, ..own.clone() };
        Self::of(strategy.name().to_owned(), settings)
    }

    /// Whether a world can cull in this way and keep pairs, by a strategy that lists what its first
    /// test doesn't reject.
    #[must_use]
    pub fn may_be_in_world(&self) -> bool {
        use Strategy::{Aabb, KDop, SDopSequential, Sphere};
        let strategy = self.settings.strategy;
        !self.hulls && matches!(strategy, Sphere | SDopSequential | Aabb | KDop)
    }

    /// Spheres alone, with a scene's other settings.
    #[must_use]
    pub fn spheres(own: &CullSettings) -> Self {
        Self::strategy(own, Strategy::Sphere)
    }

    /// Spheres, then convex hulls.
    #[must_use]
    pub fn hulls(own: &CullSettings) -> Self {
        Self { name: "sphere + hull".into(), hulls: true, ..Self::spheres(own) }
    }

    /// The volumes that it tests, in the order of the tests.
    #[must_use]
    pub fn volumes(&self) -> Vec<Volume> {
        let mut volumes = Volume::of(self.settings.strategy);
        volumes.extend(self.hulls.then_some(Volume::Hull));
        volumes
    }

    /// The volume that decides last; none for the control.
    #[must_use]
    pub fn decides(&self) -> Option<Volume> {
        self.volumes().pop()
    }

    /// The scene's shapes with the or-DOPs that the settings need.
    #[must_use]
    pub fn shapes(&self, scene: &Scene) -> Vec<Shape> {
        let CullSettings { axes, k, .. } = self.settings;
        let refit = |shape: &Shape| {
            if axes == scene.cull.axes && k == shape.ordop.directions {
                return shape.clone();
            }
            Shape { ordop: shape.ordop_along(axes, k), ..shape.clone() }
        };
        scene.shapes.iter().map(refit).collect()
    }

    /// The contestant that culls the scene's bodies this way.
    ///
    /// # Errors
    /// Invalid settings.
    pub fn culling(&self, scene: &Scene, tier: Tier) -> Result<Culling, WorldError> {
        self.culling_of(&self.shapes(scene), scene, tier)
    }

    /// The same with [`Self::shapes`] made before.
    ///
    /// # Errors
    /// As [`Self::culling`].
    pub fn culling_of(
        &self,
        shapes: &[Shape],
        scene: &Scene,
        tier: Tier,
    ) -> Result<Culling, WorldError> {
        if self.in_world {
            return Culling::in_world(shapes, &scene.bodies, &self.settings, tier);
        }
        let culling = Culling::new(shapes, &scene.bodies, &self.settings, tier)?;
        Ok(if self.hulls { culling.with_hulls(shapes) } else { culling })
    }
}
