//! Sweeps: work that is split into units, so that many processes and machines can share it. Units
//! have a fixed order, and results are merged in that order, so that the whole does not depend on
//! which process did which unit, or when.
//!
//! > [`Sweep`] → [`run_in_process()`] → [`OrderedResults`] → the result; or in shards, by
//! > files and [`merge()`], or by ranks and [`on_ranks`]
//!
//! A shard's file has some of the units. It begins with a [`Header`] that identifies the work, and
//! is rejected for any other work.

mod file;
mod header;
mod in_process;
mod merge;
mod order;
mod ranks;
mod shard;

pub use file::{Units, write_shard};
pub use header::{Header, code, digest};
pub use in_process::run_in_process;
pub use merge::{MergedUnits, merge};
pub use order::OrderedResults;
pub use ranks::on_ranks;
pub use shard::{Shard, ShardError};

use std::panic::{AssertUnwindSafe, catch_unwind};

use miette::{WrapErr as _, miette};

/// Work cut into units.
pub trait Sweep: Sync {
    /// What the work is: equal headers, equal results.
    ///
    /// # Errors
    /// Settings that have no form as text.
    fn header(&self) -> miette::Result<Header>;

    /// What people call a unit.
    fn name(&self, unit: usize) -> String;

    /// Does a unit: its result as a line of text, which any process can take.
    ///
    /// # Errors
    /// Why the unit can't be done.
    fn run(&self, unit: usize) -> miette::Result<String>;

    /// Whether a unit is timed, so that none may run next to it on a machine.
    fn timed(&self, _unit: usize) -> bool {
        false
    }

    /// Whether a unit uses all threads of a process itself, or must have them: such units are done
    /// one after the other.
    fn alone(&self, unit: usize) -> bool {
        self.timed(unit)
    }

    /// Whether a unit may still be started; otherwise it is left out.
    fn starts(&self, _unit: usize) -> bool {
        true
    }
}

/// Called when a unit ends, with its result, or without one when it was too late to start it.
pub type EndHandler<'a> = &'a mut dyn FnMut(usize, Option<String>) -> miette::Result<()>;

/// Does a unit; what goes wrong names it, a panic included.
fn attempt(work: &dyn Sweep, unit: usize) -> miette::Result<String> {
    let run = AssertUnwindSafe(|| work.run(unit));
    let ended = catch_unwind(run).unwrap_or_else(|_| Err(miette!("it panicked, which is a bug")));
    ended.wrap_err_with(|| format!("unit {unit}, {}, failed", work.name(unit)))
}
