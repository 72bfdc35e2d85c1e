//! The proof by running: scenes stepped with and without the filter, contacts compared, steps
//! timed.

pub mod calls;
pub mod case;
pub mod check;
pub mod measure;
pub mod scenes;
pub mod sim;
mod zoo;

use std::path::Path;

use miette::Result;
use sdop::mesh::TriangleMesh;

use self::sim::Sim;
use crate::plan::{Mode, Plan};
use crate::record::{Check, Prices, Share};

/// Checks every step of a filtered run, with a bug planted if `without_margin`. The first dropped
/// pair is saved in `cases`.
///
/// # Errors
/// A case that can't be written.
pub fn check(
    plan: Plan,
    forms: &[TriangleMesh],
    mode: Mode,
    steps: usize,
    without_margin: bool,
    cases: &Path,
) -> Result<Check> {
    let mut sim = Sim::new(plan, forms, mode);
    if without_margin {
        sim = sim.without_margin();
    }
    let mut saved = Ok(());
    let found = check::check(&mut sim, steps, |world, pair| {
        let comment = format!("touching by rapier, dropped by the filter: {mode}, {plan:?}");
        saved = crate::case::write(cases, &case::case_of(world, pair), &comment).map(|_| ());
    });
    saved.map(|()| found)
}

/// Measures the scene in these modes, in turns, and takes prices from another run of `calibrate`
/// steps.
#[must_use]
pub fn measure(
    plan: Plan,
    forms: &[TriangleMesh],
    modes: &[Mode],
    steps: usize,
    calibrate: usize,
) -> (Vec<Share>, Prices) {
    let prices = measure::calibrate(plan, forms, calibrate);
    (measure::measure(plan, forms, modes, steps), prices)
}
