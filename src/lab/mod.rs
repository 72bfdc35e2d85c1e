//! The laboratory: scenes, their simulation, and the studies that judge and measure the culler. An engine needs none of it.

pub mod cost;
pub mod effects;
pub mod hash;
pub mod measure;
pub mod number;
pub mod random;
pub mod record;
pub mod reproduce;
pub mod scene;
pub mod simulate;
pub mod tightness;
pub mod tradeoff;
pub mod verify;
