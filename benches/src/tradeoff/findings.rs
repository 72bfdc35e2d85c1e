//! What the units of a comparison have found.

use miette::IntoDiagnostic as _;
use serde::{Deserialize, Serialize};

use super::Estimate;
use super::budget::{BudgetRow, ClockRow};
use super::counts::Tally;
use super::density::Density;
use super::interest;
use super::truth::NarrowPhase;
use super::variant::Variant;
use super::worlds::WorldTimes;
use crate::cost::pass::Pass;

/// The compared variants.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ComparedVariants {
    /// Mean sphere hits per frame.
    pub(super) hits: f64,
    pub(super) variants: Vec<Variant>,
    /// Volume / hull volume of each variant.
    pub(super) volumes: Vec<Option<f64>>,
}

/// Counts of one seed.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SeedCounts {
    /// The counts of each variant.
    pub(super) tallies: Vec<Tally>,
    /// Counts of interest sets, only with the first seed.
    pub(super) interest: Vec<interest::InterestCounts>,
}

/// The results of units so far; those of one unit have one part.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Findings {
    pub(super) compared: Option<ComparedVariants>,
    pub(super) seeds: Vec<SeedCounts>,
    pub(super) budgets: Vec<BudgetRow>,
    pub(super) passes: Vec<Pass>,
    pub(super) narrow_phase: Option<NarrowPhase>,
    pub(super) clock: Vec<ClockRow>,
    /// Eager and lazy.
    pub(super) interest: Vec<[Estimate; 2]>,
    pub(super) worlds: Vec<WorldTimes>,
    pub(super) densities: Vec<Density>,
}

impl Findings {
    /// Reads a unit's result; units come in their order.
    ///
    /// # Errors
    /// The text is not the result of a unit.
    pub fn take(&mut self, result: &str) -> miette::Result<()> {
        let found: Self = serde_json::from_str(result).into_diagnostic()?;
        self.compared = self.compared.take().or(found.compared);
        self.narrow_phase = self.narrow_phase.or(found.narrow_phase);
        self.seeds.extend(found.seeds);
        self.budgets.extend(found.budgets);
        self.passes.extend(found.passes);
        self.clock.extend(found.clock);
        self.interest.extend(found.interest);
        self.worlds.extend(found.worlds);
        self.densities.extend(found.densities);
        Ok(())
    }
}
