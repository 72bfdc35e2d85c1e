//! For `rapier3d`, whose numbers are f32.

pub use rapier3d as rapier;

#[path = "proof/mod.rs"]
pub mod proof;
