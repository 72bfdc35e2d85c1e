//! Sphere-encapsulated or-DOP (S-DOP) collision culling that never misses a pair.
//!
//! Data flows one way: mesh → volume → scene → effects → update → broad_phase → overlap → pairs → cost.

#[cfg(feature = "proptest")]
pub mod arbitrary;
pub mod broad_phase;
pub mod choice;
pub mod cost;
pub mod crew;
pub mod effects;
#[cfg(feature = "cli")]
pub mod estimate;
pub mod mesh;
mod models;
pub mod overlap;
pub mod pairs;
pub mod pipeline;
pub mod places;
#[cfg(feature = "cli")]
pub mod reproduce;
pub mod rounding;
pub mod scene;
pub mod simd;
pub mod simulate;
mod strategy;
#[cfg(feature = "cli")]
pub mod tradeoff;
pub mod update;
#[cfg(feature = "verify")]
pub mod verify;
pub mod volume;
pub mod world;

/// The README's example compiles and runs.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
