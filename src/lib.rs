//! Sphere-encapsulated or-DOP (S-DOP) collision culling that never misses a pair.
//!
//! Data flows one way: mesh → volume → bodies → update → broad_phase → overlap → pairs.

pub mod bodies;
pub mod broad_phase;
mod choice;
pub mod counters;
pub mod culler;
#[cfg(feature = "lab")]
pub mod lab;
pub mod mesh;
pub mod overlap;
pub mod pairs;
pub mod rounding;
pub mod settings;
pub mod simd;
mod strategy;
pub mod threads;
pub mod update;
pub mod volume;
pub mod world;

/// The README's example compiles and runs.
#[cfg(all(doctest, feature = "lab"))]
#[doc = include_str!("../README.md")]
struct Readme;
