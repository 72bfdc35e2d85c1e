//! S-DOP culling between Bullet's broad phase and its narrow phase, and the proof by running:
//! contacts judged, steps timed.
#![cfg(feature = "debian")]

#[path = "../../rapier/src/forms.rs"]
pub mod forms;
mod native;
pub mod plan;
pub mod stage;
pub mod study;
#[path = "../../rapier/src/whole.rs"]
pub mod whole;
