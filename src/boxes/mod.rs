//! A broad phase for axis-aligned boxes: which of them meet?
//!
//! Use it if your engine has boxes, of any aspect ratio, and needs only a broad phase. A
//! [`BoxCuller`] takes all boxes anew in each frame. In a [`BoxWorld`], boxes come and go, rest or
//! move, and have stable ids, groups and events.
//!
//! The promise: for f32 boxes, exactly those pairs are reported that share a point in exact real
//! arithmetic, touching included. No box is widened, no pair is missed, and no pair that is an ulp
//! apart is reported. Ends may be any finite numbers. Lists depend only on the calls, never on the
//! CPU or on threads.

mod columns;
mod cube_test;
mod cubes;
mod culler;
mod frame;
#[cfg(feature = "serde")]
mod snapshot;
mod world;

pub use crate::bodies::{Aabb, Motion};
#[doc(hidden)]
pub use cube_test::CubeTest;
pub use culler::{BoxCuller, BoxCullerBuilder};
#[cfg(feature = "serde")]
pub use snapshot::BoxWorldSnapshot;
pub use world::{BoxBody, BoxWorld, Boxes};
