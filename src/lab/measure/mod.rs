//! Measuring: contestants in turns, the machine they ran on, and estimates with their uncertainty.

pub mod contestant;
pub mod estimate;
pub mod machine;
pub mod turns;
