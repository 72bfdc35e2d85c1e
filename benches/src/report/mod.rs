//! Measurements that can be cited: records, comparing two records, and pages that take every number
//! from a record.
//!
//! A record is a directory `data/record/<machine>/<experiment>` of tables and one [`Manifest`],
//! which holds the command, the commit, the machine and a digest of every file. A page quotes
//! records through its template (`pages`); rendering again must change nothing.

mod clock;
mod columns;
mod compare;
mod costs;
pub mod digits;
mod engines;
mod experiment;
#[cfg(feature = "maintain")]
mod fill;
mod manifest;
#[cfg(feature = "maintain")]
pub mod pages;
mod peers;
mod provenance;
mod requirements;
mod step;
mod store;
mod table;

pub use compare::{MeasuredChange, RecordComparison, compare};
pub use digits::{Quantities, Quantity};
pub use experiment::experiments;
pub use manifest::{FILE, Manifest, ManifestError};
pub use provenance::{CodeVersion, Load, caches};
pub use step::{Experiment, ExperimentStep};
pub use store::{Store, StoreError};
pub use table::{Table, TableError};
