//! What accuracy costs in time: every volume and strategy on one scene, judged by the exact truth.
//!
//! > [`truth`] → [`counts`] (precision, recall) → [`timing`] (T, nanoseconds) → [`pays`], [`decide`] (when does it pay?)
//!
//! Done in [`units`]. Counts come first and reproduce to the bit; time is measured afterwards and
//! never decides a count. Every variant must report every true pair: a recall below 1 is a failed
//! check.

pub mod advise;
pub mod budget;
pub mod counts;
pub mod decide;
pub mod density;
pub mod interest;
pub mod pays;
mod result;
pub mod safety;
pub mod shapes;
mod study;
pub mod timing;
pub mod truth;
pub mod units;
pub mod variant;
pub mod vary;

pub use crate::measure::estimate::{CONFIDENCE, Estimate};
pub use result::{Tradeoff, VariantResult};
pub use study::{Findings, Plan};

use std::path::PathBuf;

use miette::Diagnostic;
use thiserror::Error;

use crate::scene::SceneError;
use crate::simulate::SimulationError;
use sdop::culler::CullError;

/// Why there is no answer.
#[derive(Debug, Error, Diagnostic)]
pub enum TradeoffError {
    /// The scene can't be built.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Scene(#[from] SceneError),
    /// The scene can't be run on.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Simulation(#[from] SimulationError),
    /// A culler that can't be made, or bodies that it refuses.
    #[error(transparent)]
    #[diagnostic(help("{}", .0.help()))]
    Cull(#[from] CullError),
    /// A number that the exact reference refuses to judge.
    #[error("the exact reference refuses the scene: {0}")]
    Refused(#[from] sdop_reference::InvalidInput),
    /// A shape can't be made.
    #[error(transparent)]
    #[diagnostic(help("{}", .0.help()))]
    Form(#[from] sdop::mesh::shapes::ShapeError),
    /// A shape can't be bounded.
    #[error(transparent)]
    #[diagnostic(help("{}", .0.help()))]
    Volume(#[from] sdop::volume::VolumeError),
    /// The truth can't be kept.
    #[error("cannot write {}", file.display())]
    #[diagnostic(help("choose a writable directory with --cache"))]
    Cache {
        /// The file.
        file: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
}
