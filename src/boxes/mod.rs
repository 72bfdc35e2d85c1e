//! Boxes on the world's axes, given by whoever has them: which of them meet?
//!
//! For engines that keep boxes of their own, of any aspect, and want a broad phase and nothing
//! else. A [`BoxCuller`] takes all boxes anew in each frame; in a [`BoxWorld`] they come and go,
//! rest or move, with stable ids, groups and events.
//!
//! The promise: of boxes given as f32, exactly those pairs are reported that have a point in
//! common, touching included, in exact real arithmetic. No box is widened, none is missed, and none
//! is reported that is an ulp away. Ends are any finite numbers. Lists depend on the calls alone,
//! never on the CPU or on threads.

mod crowds;
mod cubes;
mod culler;
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
