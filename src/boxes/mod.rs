//! A broad phase for axis-aligned boxes: which of them meet?
//!
//! For engines that have boxes, of any aspect ratio, and need only a broad phase. A [`BoxCuller`]
//! gets all boxes anew in each frame; in a [`BoxWorld`] they come and go, rest or move, with stable
//! ids, groups and events.
//!
//! The promise: for boxes given as f32, exactly those pairs are reported that share a point in
//! exact real arithmetic, touching included. No box is widened, no pair is missed, and none is
//! reported that is an ulp apart. Ends are any finite numbers. Lists depend on the calls alone,
//! never on the CPU or on threads.

mod crowds;
mod cubes;
mod culler;
mod excluded;
mod frame;
mod movers;
#[cfg(feature = "serde")]
mod snapshot;
mod world;

pub use crate::bodies::{Aabb, Motion};
pub use culler::{BoxCuller, BoxCullerBuilder};
#[cfg(feature = "serde")]
pub use snapshot::BoxWorldSnapshot;
pub use world::{BoxBody, BoxWorld};
