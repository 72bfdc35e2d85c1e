//! For `rapier3d-f64`, whose numbers are f64.

pub use rapier3d_f64 as rapier;

#[path = "proof/mod.rs"]
pub mod proof;
