//! Bounding volumes, built once per mesh (the paper's Co) in the body frame.
//!
//! There is one file per volume. In exact arithmetic each volume contains the shape's f32 vertices,
//! before it is inflated for rounding.

mod ball;
mod basis;
mod contract;
mod flat_hull;
mod hull;
mod jacobi;
mod ordop;
mod principal;
mod shape;
mod swept;

pub use crate::settings::{Axes, DirectionSet};
pub use ball::Ball;
pub use basis::Basis;
pub use contract::check_bodies;
pub(crate) use contract::{check_shape, has_sound_size};
pub use hull::Hull;
pub use ordop::OrDop;
pub use shape::{Origin, Shape, ShapeSpec, VolumeError};
