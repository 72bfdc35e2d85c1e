//! T per strategy and N: the formula's terms, predicted from prices that calibration found on other scenes, beside what
//! the runs took.

use serde::Serialize;

use super::Estimate;
use super::experiment::{Results, Run, STRATEGIES};
use crate::lab::cost::predict::{Prices, Terms};
use crate::settings::Strategy;

/// The cost of one strategy in one scene. Seconds a frame, but for the construction.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Cost {
    /// The scene.
    pub scene: String,
    /// N.
    pub bodies: usize,
    /// The strategy.
    pub strategy: Strategy,
    /// The terms of each volume, means over seeds.
    pub terms: Vec<Terms>,
    /// Their sum without construction: predicted seconds a frame.
    pub predicted: f64,
    /// Measured seconds a frame: the median over frames, averaged over seeds.
    pub measured: Estimate,
    /// Measured over predicted, less one.
    pub residual: f64,
    /// Co as measured: the strategy's volumes and its culler, built once a seed.
    pub construct: Estimate,
}

impl Cost {
    /// A term summed over the strategy's volumes.
    pub fn sum(&self, term: fn(&Terms) -> f64) -> f64 {
        self.terms.iter().map(term).sum()
    }

    /// T of so many frames, construction included, in seconds: predicted and measured.
    #[must_use]
    pub fn totals(&self, frames: u32) -> [f64; 2] {
        let frames = f64::from(frames);
        [
            self.sum(|t| t.construct) + frames * self.predicted,
            self.construct.mean + frames * self.measured.mean,
        ]
    }
}

/// Costs, scene by scene, strategy by strategy; the control costs nothing that the formula has a term for.
#[must_use]
pub fn table(results: &Results) -> Vec<Cost> {
    let mut costs = Vec::new();
    for scene in &results.plan.names {
        for strategy in STRATEGIES.into_iter().filter(|&s| s != Strategy::None) {
            let of = |run: &&Run| run.scene == *scene && run.strategy == strategy;
            let runs: Vec<&Run> = results.runs.iter().filter(of).collect();
            costs.extend(cost(&results.prices, &runs));
        }
    }
    costs
}

/// The cost of runs of one strategy and scene, one a seed; `None` of none.
#[must_use]
pub fn cost(prices: &Prices, runs: &[&Run]) -> Option<Cost> {
    let first = runs.first()?;
    let mut terms: Vec<Terms> = Vec::new();
    for run in runs {
        let weight = 1.0 / runs.len() as f64;
        for (i, one) in prices
            .predict(run.strategy, &run.counters, run.frames, run.bodies)
            .into_iter()
            .enumerate()
        {
            let a_frame = weight / f64::from(run.frames);
            let one = Terms {
                volume: one.volume,
                construct: weight * one.construct,
                update: a_frame * one.update,
                finding: a_frame * one.finding,
                test: a_frame * one.test,
            };
            match terms.get_mut(i) {
                None => terms.push(one),
                Some(sum) => sum.add(&one),
            }
        }
    }
    let predicted = terms.iter().map(Terms::recurring).sum::<f64>();
    let of = |value: fn(&Run) -> f64| {
        Estimate::of(&runs.iter().map(|run| value(run)).collect::<Vec<_>>())
    };
    let measured = of(|run| run.seconds.total);
    Some(Cost {
        scene: first.scene.clone(),
        bodies: first.bodies,
        strategy: first.strategy,
        terms,
        predicted,
        measured,
        residual: measured.mean / predicted - 1.0,
        construct: of(|run| run.seconds.construct),
    })
}
