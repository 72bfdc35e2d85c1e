//! Scenes: bodies as columns, their shapes, what is simulated and how it is culled.

pub mod bodies;
pub(crate) mod choice;
pub mod settings;
