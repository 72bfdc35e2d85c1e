//! The paper's experiments. Each of its strategies culls the same seeded trajectories, for each of
//! its numbers of objects. From these runs follow verdicts about the paper's results and about our
//! reading of them.
//!
//! > [`ExperimentPlan`] → [`StrategyRun`]s → Table 1 ([`readings`]), frame rates ([`rates`]),
//! > T ([`Results::costs`]), [`claims`], [`study`]
//!
//! Everything after the runs is a pure function of them, so that runs made elsewhere can be joined.
//! Counts and hashes are equal on every CPU; seconds are this machine's.

pub mod check;
pub mod claims;
mod experiment;
pub mod immediate;
pub mod paper;
mod plan;
pub mod rates;
pub mod readings;
pub mod rows;
pub mod study;

pub use crate::measure::estimate::{CONFIDENCE, Estimate};
pub use experiment::{
    ExperimentSettings, Experiments, NAME, Results, StrategyRun, UnitResult, run_scene,
};
pub use plan::{ExperimentPlan, PaperScene, STRATEGIES};

use sdop::settings::Strategy;

/// What the paper calls a strategy in its tables and figures.
#[must_use]
pub const fn paper_name(strategy: Strategy) -> &'static str {
    match strategy {
        Strategy::None => "No BV",
        Strategy::Sphere => "Sphere",
        Strategy::OrDop => "or-DOPs",
        Strategy::SDopSequential => "Seq S-DOP",
        Strategy::SDopBatch => "ALL S-DOP",
        Strategy::SDopObjectOfInterest => "OoI S-DOP",
        other => other.name(),
    }
}
