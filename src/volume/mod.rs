//! Bounding volumes, built once per mesh (the paper's Co) in the body frame.
//!
//! One file a volume; each contains the f32 vertices as culled in exact arithmetic, before any
//! inflation for rounding.

mod ball;
mod basis;
mod directions;
mod flat_hull;
mod hull;
mod jacobi;
mod ordop;
mod principal;
mod shape;
mod swept;

pub use ball::Ball;
pub use basis::{Axes, Basis};
pub use directions::DirectionSet;
pub use hull::Hull;
pub use ordop::OrDop;
pub use shape::{Origin, Shape, ShapeSpec, VolumeError};
