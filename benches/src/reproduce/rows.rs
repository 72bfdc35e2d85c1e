//! The results as rows: Table 1, frame rates, T by its terms, prices.

use super::experiment::{Results, StrategyRun};
use super::plan::STRATEGIES;
use super::rates::{self, Rate};
use super::readings::{self, Table1Cell};
use super::{Estimate, PaperScene};
use crate::cost::rows::{add_cost, add_price};
use crate::cost::table::{Cost, PriceRow, prices};
use crate::measure::row::{Row, Rows};
use crate::measure::turns::Regime;

/// The prices of a scene's strategies, for warm frames and for cold ones.
#[must_use]
pub fn scene_prices(results: &Results, scene: PaperScene) -> Vec<PriceRow> {
    let passes = results.priced_as(scene);
    Regime::ALL.iter().flat_map(|&regime| prices(&passes, regime)).collect()
}

/// Every number of the experiments.
#[must_use]
pub fn rows(results: &Results) -> Vec<Row> {
    let table_1 = readings::table(results);
    let rates = rates::table(results);
    let costs: Vec<Cost> = Regime::ALL.iter().flat_map(|&regime| results.costs(regime)).collect();
    let mut all = Vec::new();
    for &scene in &results.plan.names {
        let mut rows = Rows::new("reproduce", scene.name());
        let name = scene.name();
        table_1.iter().filter(|cell| cell.scene == name).for_each(|cell| add_cell(&mut rows, cell));
        rates.iter().filter(|rate| rate.scene == name).for_each(|rate| add_rate(&mut rows, rate));
        add_times(&mut rows, results, name);
        costs.iter().filter(|cost| cost.scene == name).for_each(|cost| add_cost(&mut rows, cost));
        scene_prices(results, scene).iter().for_each(|price| add_price(&mut rows, price));
        all.extend(rows.finish());
    }
    all
}

/// Collisions in percent of tests under a reading, and the paper's percentage.
fn add_cell(rows: &mut Rows, cell: &Table1Cell) {
    let of = (cell.strategy.name(), None);
    rows.add(of, cell.reading.name(), "%", cell.measured);
    if let Some(mean) = cell.paper {
        let metric = format!("{}, the paper's", cell.reading);
        rows.add(of, metric, "%", Estimate::alone(mean));
    }
}

fn add_rate(rows: &mut Rows, rate: &Rate) {
    let (of, f) = ((rate.strategy.name(), Some(Regime::Warm)), 1e3 * rate.elsewhere);
    rows.add(of, format!("frame rate, F = {f} ms"), "frames per s", rate.fps);
}

/// Times that the formula has no term for.
fn add_times(rows: &mut Rows, results: &Results, scene: &str) {
    for strategy in STRATEGIES {
        let over_seeds = |value: fn(&StrategyRun) -> f64| {
            Estimate::in_order(&results.by_seed(scene, strategy, value))
        };
        let mut add = |regime, value| {
            rows.add((strategy.name(), Some(regime)), "time", "s per frame", over_seeds(value));
        };
        add(Regime::Warm, |run| run.warm);
        add(Regime::Cold, |run| run.cold);
    }
}
