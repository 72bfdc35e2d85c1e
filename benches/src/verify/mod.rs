//! The optimised culler against the exact reference ([`sdop_judge::ours`]), on scenes and shared
//! among many.
//!
//! When a pair is missed, [`shrink`] makes the smallest scene that shows it.

pub mod scenes;
pub mod shrink;
pub mod units;
