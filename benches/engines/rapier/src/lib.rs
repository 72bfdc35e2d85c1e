//! S-DOP culling between rapier's broad phase and its narrow phase.
#![allow(
    clippy::duplicate_mod,
    clippy::unnecessary_cast,
    reason = "one source serves rapier's two crates, f32 and f64"
)]

pub mod case;
pub mod double;
pub mod forms;
pub mod plan;
pub mod record;
pub mod single;
pub mod whole;
