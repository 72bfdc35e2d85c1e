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

use std::path::PathBuf;

use miette::Diagnostic;
use thiserror::Error;

use crate::scene::SceneError;
use crate::simulate::SimulationError;
use sdop::culler::CullError;

/// Errors of a comparison.
#[derive(Debug, Error, Diagnostic)]
pub enum TradeoffError {
    /// The scene can't be built.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Scene(#[from] SceneError),
    /// The simulation fails.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Simulation(#[from] SimulationError),
    /// A culler can't be built, or rejects bodies.
    #[error("{}", .0.problem())]
    #[diagnostic(help("{}", .0.help()))]
    Cull(CullError),
    /// The exact reference rejects a number.
    #[error("the exact reference refuses the scene: {0}")]
    Refused(#[from] sdop_reference::InvalidInput),
    /// The truth can't be stored.
    #[error("cannot write {}", file.display())]
    #[diagnostic(help("choose a writable directory with --cache"))]
    Cache {
        /// The file.
        file: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
}

crate::remedy::held_with_remedy!(TradeoffError, Cull(CullError));
