//! Measuring: contestants in turns, the machine they ran on, and estimates with their uncertainty.

pub mod conditions;
pub mod counts;
pub mod culling;
pub mod estimate;
pub mod machine;
pub mod row;
mod scene_world;
pub mod turns;
pub mod variant;
pub mod waiting_time;
