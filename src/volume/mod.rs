//! Bounding volumes, built once per mesh (the paper's Co) in the body frame.
//!
//! One file a volume; each contains the f32 vertices as culled in exact arithmetic, before any inflation for rounding.

mod ball;
mod basis;
mod directions;
mod fingerprint;
mod hull;
mod ordop;
mod principal;
mod shape;
mod size;
mod tightness;

pub use ball::Ball;
pub use basis::{Axes, Basis};
pub use directions::DirectionSet;
pub use fingerprint::volumes_sha256;
pub use hull::Hull;
pub use ordop::OrDop;
pub use shape::{Origin, Shape, ShapeSpec, VolumeError};
pub use size::Size;
pub use tightness::mean_world_aligned_volume;
