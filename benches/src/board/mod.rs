//! The public board: which libraries miss which pairs.
//!
//! > `engines.toml` ([`crate::roster`]) → each engine judged, a [`Row`] of [`Cell`]s ([`row`]) → one
//! > page ([`page`])
//!
//! An adapter is a program that answers the judge's cases with another library
//! (`benches/adapters/`). It has one cell for each family of its claim's cases. A family is the
//! first word of a case's name, so that a new family automatically gets a column.

mod page;
mod row;
mod speed;

pub use page::page;
pub use row::{Cell, CellVerdict, Counter, Row, judge};
pub use speed::Speed;

use serde::Serialize;

use crate::roster::NotRun;

/// All rows.
#[derive(Clone, Debug, Serialize)]
pub struct Board {
    /// The version of the judge.
    pub code: String,
    /// One row for each adapter.
    pub adapters: Vec<Row>,
    /// Libraries that were not run.
    pub not_run: Vec<NotRun>,
    /// Times of an earlier run, for the page alone.
    #[serde(skip)]
    pub times: Vec<Speed>,
}
