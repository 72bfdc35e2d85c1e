//! The public board: which libraries miss which pairs.
//!
//! > `claims.toml` ([`claims`]) → each adapter judged, a [`Row`] of [`Cell`]s ([`row`]) → one page ([`page`])
//!
//! An adapter is a program on the judge's wire that makes another library answer
//! (`benches/adapters/`). Its cells are the families of cases that its claim has: the first word of
//! a case's name, so that a new group of cases is a new column by itself.

mod claims;
mod page;
mod row;
mod speed;

pub use claims::{Adapter, Claims, NotRun, Unclaimed};
pub use page::page;
pub use row::{Cell, CellVerdict, Counter, Row, judge};
pub use speed::Speed;

use serde::Serialize;

/// All rows.
#[derive(Clone, Debug, Serialize)]
pub struct Board {
    /// The version that judged.
    pub code: String,
    /// One row for each adapter.
    pub adapters: Vec<Row>,
    /// Libraries that nobody has run here.
    pub not_run: Vec<NotRun>,
}
