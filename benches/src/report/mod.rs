//! Measurements that can be cited: records, comparing two records, and pages that take every number
//! from a record.
//!
//! A record is a directory `data/record/<machine>/<experiment>` of tables and one [`Manifest`],
//! which holds the command, the commit, the machine and a digest of every file. A page quotes
//! records through its template (`pages`); rendering again must change nothing.

mod columns;
mod compare;
pub mod digits;
mod experiment;
#[cfg(feature = "maintain")]
mod fill;
mod manifest;
#[cfg(feature = "maintain")]
pub mod pages;
mod provenance;
mod store;
mod table;

pub use compare::{CountDifference, MeasuredChange, RecordComparison, compare};
pub use digits::{Quantities, Quantity};
pub use experiment::{Experiment, ExperimentStep, experiments};
pub use manifest::{FILE, Manifest};
pub use provenance::CodeVersion;
pub use store::Store;
pub use table::Table;
