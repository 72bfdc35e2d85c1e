//! Scenes: bodies as columns, their shapes, what is simulated and how it is culled.
//!
//! A scene file (TOML) is read into a [`SceneFile`], in which a caller may still change seed, frames or culling, and
//! built into a [`Scene`]: meshes become shapes, and bodies are placed by the seed. The same file and seed give the
//! same bodies on every platform.

pub mod bodies;
mod build;
pub mod contract;
mod density;
pub mod error;
pub mod file;
mod group;
mod library;
pub mod number;
mod placement;
pub mod random;
pub mod settings;

pub use error::SceneError;
pub use file::SceneFile;

use crate::effects::EffectsSpec;
use crate::rounding::pose;
use crate::volume::Shape;
use bodies::Bodies;
use settings::CullSettings;

/// A scene ready to run.
#[derive(Clone, Debug)]
pub struct Scene {
    /// What records and tables call it.
    pub name: String,
    /// Where all random draws started.
    pub seed: u64,
    /// Frames to cull: the initial state and `frames − 1` steps.
    pub frames: u32,
    /// Seconds a step.
    pub dt: f32,
    /// Distance between opposite walls of the box about the origin, if there is one.
    pub side: Option<f32>,
    /// What the bodies look like, each built once.
    pub shapes: Vec<Shape>,
    /// The initial state.
    pub bodies: Bodies,
    /// What is simulated.
    pub effects: EffectsSpec,
    /// How it is culled.
    pub cull: CullSettings,
    /// Seconds that building the shapes' volumes took: the cost formula's Co.
    pub construct_seconds: f64,
}

/// The world position of a body-frame point, computed in f64 and rounded once; t itself for the body origin.
pub(crate) fn world_centre(point: [f32; 3], q: &[f32; 4], t: &[f32; 3]) -> [f32; 3] {
    if point == [0.0; 3] {
        return *t;
    }
    pose::transform(&pose::rotation(*q), point, *t).map(|x| x as f32)
}
