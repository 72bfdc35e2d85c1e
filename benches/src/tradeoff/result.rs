//! The results of comparing variants on one scene.

use serde::{Deserialize, Serialize};

use super::Estimate;
use super::budget::{BudgetRow, ClockRow};
use super::density::Density;
use super::interest::InterestRow;
use super::pays::{CheapestRange, Standing};
use super::truth::NarrowPhase;
use super::worlds::WorldTimes;
use crate::cost::table::{Cost, PriceRow};
use crate::measure::conditions::Conditions;
use crate::measure::counts::Volume;
use sdop::settings::{Axes, Overlap, Strategy};

/// One variant's result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VariantResult {
    /// Its name in tables.
    pub name: String,
    /// The strategy.
    pub strategy: Strategy,
    /// Whether hulls are tested after it.
    pub hulls: bool,
    /// The volume that decides last.
    pub volume: Option<Volume>,
    /// Half-spaces, if the strategy has or-DOPs or k-DOPs.
    pub k: Option<usize>,
    /// The or-DOP's axes, if it has or-DOPs.
    pub axes: Option<Axes>,
    /// The overlap test, if it has or-DOPs.
    pub overlap: Option<Overlap>,
    /// Pairs reported per frame.
    pub reported: Estimate,
    /// True pairs / reported pairs.
    pub precision: Estimate,
    /// Precision per seed.
    pub precisions: Vec<f64>,
    /// Reported pairs / true pairs.
    pub per_true: Estimate,
    /// True pairs found / true pairs, over all seeds.
    pub recall: f64,
    /// Mean volume / hull volume; `None` if a hull is flat.
    pub volume_over_hull: Option<f64>,
    /// Predicted and measured cost of warm frames.
    pub warm: Option<Cost>,
    /// Predicted and measured cost of cold frames.
    pub cold: Option<Cost>,
    /// Seconds of a warm frame per pass, in the order of time.
    pub times: Vec<f64>,
    /// Its relation to the Pareto front of time and precision.
    pub standing: Standing,
    /// The hash of the pairs reported on the sample frames, per seed.
    pub pairs_sha256: Vec<String>,
}

impl VariantResult {
    /// Seconds of a warm frame, without construction.
    #[must_use]
    pub fn seconds(&self) -> Estimate {
        Estimate::in_order(&self.times)
    }
}

/// All results of one scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tradeoff {
    /// The scene.
    pub scene: String,
    /// Its bodies.
    pub bodies: usize,
    /// Frames of its run.
    pub frames: u32,
    /// Judged frames of each run.
    pub samples: usize,
    /// The runs' seeds.
    pub seeds: Vec<u64>,
    /// The SIMD tier.
    pub simd: String,
    /// True pairs per frame.
    pub truth: Estimate,
    /// Sphere overlaps per body.
    pub partners: f64,
    /// The exact reference as narrow phase.
    pub narrow_phase: NarrowPhase,
    /// Every variant.
    pub rows: Vec<VariantResult>,
    /// The cheapest variant as Cp grows.
    pub cheapest: Vec<CheapestRange>,
    /// The scene at other densities.
    pub densities: Vec<Density>,
    /// Time-critical culling by tests.
    pub budgets: Vec<BudgetRow>,
    /// Time-critical culling by the clock.
    pub clock: Vec<ClockRow>,
    /// Interest sets.
    pub interest: Vec<InterestRow>,
    /// Worlds, if bodies of the scene fall asleep.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub worlds: Vec<WorldTimes>,
    /// Prices of every variant's volumes, warm and cold.
    pub prices: Vec<PriceRow>,
    /// Other load of the machine.
    pub conditions: Conditions,
    /// The advice.
    pub advice: String,
}

impl Tradeoff {
    /// The variants that missed a true pair.
    pub fn failures(&self) -> impl Iterator<Item = &str> {
        let rows = self.rows.iter().filter(|row| row.recall != 1.0);
        let budgets = self.budgets.iter().filter(|row| row.recall != 1.0);
        let interest = self.interest.iter().filter(|row| row.quality.recall != 1.0);
        rows.map(|row| row.name.as_str())
            .chain(budgets.map(|row| row.order.name()))
            .chain(interest.map(|_| "s-dop of interest"))
    }
}
