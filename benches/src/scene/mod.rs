//! Scenes: bodies as columns, their shapes, what is simulated and how it is culled.
//!
//! A scene file (TOML) is read into a [`SceneFile`], in which a caller may still change seed,
//! frames or culling, and built into a [`Scene`]: meshes become shapes, and bodies are placed by
//! the seed. The same file and seed give the same bodies on every platform.

mod build;
mod density;
pub mod error;
pub mod file;
mod fine_translations;
mod group;
mod library;
mod placement;
mod share;

pub use error::SceneError;
pub use file::SceneFile;
pub use fine_translations::FineTranslations;
pub use share::Share;

use crate::effects::{EffectError, Effects, EffectsSpec, InitialState, Velocities};
use sdop::bodies::Bodies;
use sdop::settings::CullSettings;
use sdop::volume::Shape;

/// A scene ready to run.
#[derive(Clone, Debug)]
pub struct Scene {
    /// What records and tables call it.
    pub name: String,
    /// The seed of all random draws.
    pub seed: u64,
    /// Frames to cull: the initial state and `frames − 1` steps.
    pub frames: u32,
    /// Seconds per step.
    pub dt: f32,
    /// Distance between opposite walls of the box about the origin, if there is one.
    pub side: Option<f32>,
    /// What the bodies look like, each built once.
    pub shapes: Vec<Shape>,
    /// The initial poses.
    pub bodies: Bodies,
    /// The initial translations that f32 doesn't hold.
    pub fine: FineTranslations,
    /// Which bodies of the scene these are, if not all.
    pub share: Option<Share>,
    /// The initial velocities.
    pub velocities: Velocities,
    /// What is simulated.
    pub effects: EffectsSpec,
    /// How it is culled.
    pub cull: CullSettings,
    /// Seconds that building the shapes' volumes took: the cost formula's Co.
    pub construct_seconds: f64,
}

impl Scene {
    /// Which bodies of the scene these are.
    #[must_use]
    pub fn share(&self) -> Share {
        let all = || Share::whole(&self.bodies);
        self.share.clone().unwrap_or_else(all)
    }

    /// The scene's effects, for a run from its initial state.
    ///
    /// # Errors
    /// An effect that the scene can't have, such as walls without a box.
    pub fn start_effects(&self) -> Result<Effects, EffectError> {
        let share = self.share();
        let start = InitialState {
            seed: self.seed,
            dt: self.dt,
            side: self.side,
            shapes: &self.shapes,
            bodies: &self.bodies,
            moving: &share.moving,
            velocities: &self.velocities,
        };
        Effects::new(&self.effects, &start)
    }
}
