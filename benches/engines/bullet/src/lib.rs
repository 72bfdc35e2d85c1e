//! S-DOP culling between Bullet's broad phase and its narrow phase, and a program that checks
//! contacts and times steps.
#![cfg(feature = "debian")]

#[path = "../../rapier/src/forms.rs"]
pub mod forms;
mod native;
pub mod plan;
pub mod stage;
pub mod study;
#[path = "../../rapier/src/whole.rs"]
pub mod whole;
