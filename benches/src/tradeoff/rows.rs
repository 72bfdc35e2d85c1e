//! The comparison as rows.

use super::Estimate;
use super::result::{Tradeoff, VariantResult};
use crate::cost::rows::{add_cost, add_price};
use crate::measure::row::{Row, Rows};
use crate::measure::turns::Regime;

impl Tradeoff {
    /// Every number of the comparison.
    #[must_use]
    pub fn rows(&self) -> Vec<Row> {
        let mut rows = Rows::new("tradeoff", &self.scene);
        self.rows.iter().for_each(|row| add_variant(&mut rows, row));
        self.prices.iter().for_each(|price| add_price(&mut rows, price));
        self.add_densities(&mut rows);
        self.add_budgets(&mut rows);
        for row in &self.interest {
            let name = format!("{} of interest", row.bodies);
            let mut add = |regime, metric: &str, unit, value| {
                rows.add((&name, regime), metric, unit, value);
            };
            add(None, "or-DOP tests", "per frame", Estimate::alone(row.tests));
            add(None, "reported", "pairs per frame", Estimate::alone(row.reported));
            add(None, "precision", "1", Estimate::alone(row.quality.precision));
            add(None, "recall", "1", Estimate::alone(row.quality.recall));
            add(Some(Regime::Warm), "time", "s per frame", row.seconds);
            add(Some(Regime::Warm), "time, lazy", "s per frame", row.lazy_seconds);
        }
        for row in &self.worlds {
            let mut add = |metric: &str, unit, value| {
                rows.add((&row.variant, Some(Regime::Warm)), metric, unit, value);
            };
            add("reported of a run", "pairs per frame", Estimate::alone(row.reported));
            add("culler's time of a run", "s per frame", row.culler);
            add("world's time of a run", "s per frame", row.world);
        }
        rows.finish()
    }

    /// At each density, pairs and times of every variant, and the price of a check from which an
    /// S-DOP is cheaper than spheres.
    fn add_densities(&self, rows: &mut Rows) {
        for density in &self.densities {
            let at = format!("at {} times the density", density.factor);
            for line in &density.lines {
                let of = (line.name.as_str(), Some(Regime::Warm));
                rows.add(
                    of,
                    format!("reported {at}"),
                    "pairs per frame",
                    Estimate::alone(line.pairs),
                );
                let time = Estimate::in_order(&line.times);
                rows.add(of, format!("time {at}"), "s per frame", time);
            }
            for even in &density.break_even {
                let metric = format!("break-even {at}");
                rows.add((&even.name, None), metric, "s per check", Estimate::alone(even.cp));
            }
        }
    }

    /// Time-critical culling by tests, then by the clock.
    fn add_budgets(&self, rows: &mut Rows) {
        for row in &self.budgets {
            let name = format!("{}, {} tests", row.order, row.tests);
            for (metric, unit, value) in [
                ("refined", "1", row.refined),
                ("precision", "1", row.precision),
                ("recall", "1", row.recall),
                ("mean age", "frames", row.mean_age),
                ("oldest", "frames", row.oldest.into()),
            ] {
                rows.add((&name, None), metric, unit, Estimate::alone(value));
            }
        }
        for row in &self.clock {
            let name = format!("budget of {} µs", row.microseconds);
            for (metric, unit, value) in [
                ("refined", "1", row.refined),
                ("overrun p50", "s per frame", 1e-6 * row.p50),
                ("overrun p99", "s per frame", 1e-6 * row.p99),
            ] {
                rows.add((&name, Some(Regime::Warm)), metric, unit, Estimate::alone(value));
            }
        }
    }
}

/// What a variant reports, how precise and how tight it is, and its time by the formula's terms.
fn add_variant(rows: &mut Rows, row: &VariantResult) {
    let mut add = |metric: &str, unit, value| rows.add((&row.name, None), metric, unit, value);
    let false_pairs = row.reported.mean * (1.0 - row.precision.mean);
    add("reported", "pairs per frame", row.reported);
    add("false pairs", "per frame", Estimate::alone(false_pairs));
    add("precision", "1", row.precision);
    add("reported / true", "1", row.per_true);
    add("recall", "1", Estimate::alone(row.recall));
    if let Some(ratio) = row.volume_over_hull {
        add("volume / hull", "1", Estimate::alone(ratio));
    }
    rows.add((&row.name, Some(Regime::Warm)), "time", "s per frame", row.seconds());
    let costs = [&row.warm, &row.cold].into_iter().flatten();
    costs.for_each(|cost| add_cost(rows, cost));
}
