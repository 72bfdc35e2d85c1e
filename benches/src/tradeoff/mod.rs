//! What accuracy costs in time: compares every volume and strategy on one scene, judged by the
//! exact truth.
//!
//! > [`truth`] → [`counts`] (precision, recall) → [`timing`] (seconds) → [`pays`] (when does it pay?)
//!
//! The work is divided into units ([`study`]). Counts come first and are reproducible to the bit;
//! time is measured afterwards and never decides a count. Every variant must report every true
//! pair: a recall below 1 is a failed check.

pub mod advise;
pub mod budget;
pub mod counts;
pub mod density;
pub mod interest;
pub mod pays;
mod result;
pub mod study;
pub mod timing;
pub mod truth;
pub mod variant;

pub use crate::measure::estimate::{CONFIDENCE, Estimate};
pub use result::{Tradeoff, VariantResult};
pub use study::{Findings, TradeoffPlan};
