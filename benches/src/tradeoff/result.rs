//! The results of a comparison: of every variant, density, budget and interest set; and the same as
//! rows.

use serde::{Deserialize, Serialize};

use super::Estimate;
use super::budget::{BudgetRow, ClockRow};
use super::density::Density;
use super::interest::InterestRow;
use super::pays::{CheapestRange, Standing};
use super::truth::NarrowPhase;
use crate::measure::conditions::Conditions;
use crate::measure::machine::Machine;
use crate::measure::row::{Row, Rows};
use crate::measure::turns::Regime;

/// One variant's result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VariantResult {
    /// Its name in tables.
    pub name: String,
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
    /// Seconds of a warm frame per pass, in the order of time.
    pub times: Vec<f64>,
    /// Co, seconds once; `None` in earlier records.
    pub construct: Option<Estimate>,
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
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Tradeoff {
    /// The command that repeats it.
    pub command: String,
    /// The machine and the SIMD tier.
    pub machine: Machine,
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
    /// Other load of the machine.
    pub conditions: Conditions,
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

    /// Every number of the comparison.
    #[must_use]
    pub fn rows(&self) -> Vec<Row> {
        let warm = Some(Regime::Warm);
        let mut rows = Rows::new("tradeoff", &self.scene);
        let mut add = |name: &str, regime, numbers: &[(&str, &'static str, Estimate)]| {
            for &(metric, unit, value) in numbers {
                rows.add((name, regime), metric, unit, value);
            }
        };
        let alone = Estimate::alone;
        for row in &self.rows {
            let false_pairs = row.reported.mean * (1.0 - row.precision.mean);
            add(
                &row.name,
                None,
                &[
                    ("reported", "pairs per frame", row.reported),
                    ("false pairs", "per frame", alone(false_pairs)),
                    ("precision", "1", row.precision),
                    ("reported / true", "1", row.per_true),
                    ("recall", "1", alone(row.recall)),
                ],
            );
            if let Some(ratio) = row.volume_over_hull {
                add(&row.name, None, &[("volume / hull", "1", alone(ratio))]);
            }
            add(&row.name, warm, &[("time", "s per frame", row.seconds())]);
            if let Some(construct) = row.construct {
                add(&row.name, None, &[("Co", "s", construct)]);
            }
        }
        for density in &self.densities {
            for line in &density.lines {
                let time = Estimate::in_order(&line.times);
                let reported = (&*density.metric("reported"), "pairs per frame", alone(line.pairs));
                add(&line.name, warm, &[reported, (&density.metric("time"), "s per frame", time)]);
            }
            for even in &density.break_even {
                add(
                    &even.name,
                    None,
                    &[(&density.metric("break-even"), "s per check", alone(even.cp))],
                );
            }
        }
        for row in &self.budgets {
            add(
                &format!("{}, {} tests", row.order, row.tests),
                None,
                &[
                    ("refined", "1", alone(row.refined)),
                    ("precision", "1", alone(row.precision)),
                    ("recall", "1", alone(row.recall)),
                    ("mean age", "frames", alone(row.mean_age)),
                    ("oldest", "frames", alone(row.oldest.into())),
                ],
            );
        }
        for row in &self.clock {
            add(
                &format!("budget of {} µs", row.microseconds),
                warm,
                &[
                    ("refined", "1", alone(row.refined)),
                    ("overrun p50", "s per frame", alone(1e-6 * row.p50)),
                    ("overrun p99", "s per frame", alone(1e-6 * row.p99)),
                ],
            );
        }
        for row in &self.interest {
            let name = format!("{} of interest", row.bodies);
            add(
                &name,
                None,
                &[
                    ("or-DOP tests", "per frame", alone(row.tests)),
                    ("reported", "pairs per frame", alone(row.reported)),
                    ("precision", "1", alone(row.quality.precision)),
                    ("recall", "1", alone(row.quality.recall)),
                ],
            );
            let times = [("time", row.seconds), ("time, lazy", row.lazy_seconds)];
            add(&name, warm, &times.map(|(metric, seconds)| (metric, "s per frame", seconds)));
        }
        rows.finish()
    }
}
