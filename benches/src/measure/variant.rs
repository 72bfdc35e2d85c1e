//! A way to cull, as a contestant is made from it: culling settings, the shapes that they need, and
//! hulls behind them.

use super::counts::Volume;
use super::culling::Culling;
use crate::scene::Scene;
use sdop::culler::CullError;
use sdop::settings::{CullSettings, Strategy};
use sdop::simd::Tier;
use sdop::volume::Shape;

/// One way to cull.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Variant {
    /// What tables call it.
    pub name: String,
    /// Its culling settings.
    pub settings: CullSettings,
    /// Whether pairs that the settings report are then tested by their convex hulls.
    pub hulls: bool,
}

impl Variant {
    /// Culling by some settings.
    #[must_use]
    pub fn of(name: String, settings: CullSettings) -> Self {
        Self {
            name,
            settings,
            hulls: false,
        }
    }

    /// A strategy with a scene's other settings, called by the strategy's name.
    #[must_use]
    pub fn strategy(own: &CullSettings, strategy: Strategy) -> Self {
        let settings = CullSettings {
            strategy,
            ..own.clone()
        };
        Self::of(strategy.name().to_owned(), settings)
    }

    /// Spheres alone, with a scene's other settings.
    #[must_use]
    pub fn spheres(own: &CullSettings) -> Self {
        Self::strategy(own, Strategy::Sphere)
    }

    /// Spheres, then convex hulls.
    #[must_use]
    pub fn hulls(own: &CullSettings) -> Self {
        Self {
            name: "sphere + hull".into(),
            hulls: true,
            ..Self::spheres(own)
        }
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

    /// The scene culled this way, its shapes' or-DOPs rebuilt where it wants others.
    #[must_use]
    pub fn apply(&self, scene: &Scene) -> Scene {
        Scene {
            shapes: self.shapes(scene),
            cull: self.settings.clone(),
            ..scene.clone()
        }
    }

    /// The scene's shapes with the or-DOPs that the settings ask for.
    #[must_use]
    pub fn shapes(&self, scene: &Scene) -> Vec<Shape> {
        let CullSettings { axes, k, .. } = self.settings;
        let refit = |shape: &Shape| {
            if axes == scene.cull.axes && k == shape.ordop.directions {
                return shape.clone();
            }
            Shape {
                ordop: shape.ordop_along(axes, k),
                ..shape.clone()
            }
        };
        scene.shapes.iter().map(refit).collect()
    }

    /// The contestant that culls the scene's bodies this way.
    ///
    /// # Errors
    /// Settings that can't be carried out.
    pub fn culling(&self, scene: &Scene, tier: Tier) -> Result<Culling, CullError> {
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
    ) -> Result<Culling, CullError> {
        let culling = Culling::new(shapes, &scene.bodies, &self.settings, tier)?;
        Ok(if self.hulls {
            culling.with_hulls(shapes)
        } else {
            culling
        })
    }
}
