//! Verifies the optimised culler by the exact reference ([`sdop_judge::truth`]) on scenes, and
//! divides the work among processes.
//!
//! If a pair is missed, [`shrink`] makes the smallest scene that shows it.

pub mod scenes;
pub mod shrink;
pub mod units;
