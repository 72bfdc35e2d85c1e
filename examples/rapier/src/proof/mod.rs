//! The proof by running.

pub mod calls;
pub mod scenes;
