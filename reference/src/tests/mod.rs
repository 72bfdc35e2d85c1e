//! Suites that need whole shapes. Tests of a single formula are next to that formula.
#![allow(clippy::unwrap_used, reason = "a test that cannot build its input has failed")]

mod common_points;
mod containment;
mod exact_maps;
mod exact_meshes;
mod exact_volumes;
mod hard;
mod rational;
mod scenes;
mod shapes;
mod strategies;
mod wide_poses;
