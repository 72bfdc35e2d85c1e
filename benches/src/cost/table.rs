//! T of each variant in each regime: the formula's terms, at the mean prices of all rounds of
//! calibration, and the measured times. A term is the printed count times the printed price.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::PRICES;
use super::level::CacheLevel;
use super::pass::{Pass, VariantRun};
use super::predict::Prices;
use super::terms::Terms;
use crate::measure::counts::Volume;
use crate::measure::culling::StageSeconds;
use crate::measure::estimate::Estimate;
use crate::measure::turns::Regime;
use crate::measure::variant::Variant;
use sdop::choice::choices;
use sdop::settings::Strategy;

/// A number as predicted and as measured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CheckedPrediction {
    /// The value from prices and counts.
    pub predicted: Estimate,
    /// The value by the clock.
    pub measured: Estimate,
    /// Measured / predicted − 1, pass by pass. Its interval includes the calibration's uncertainty.
    pub residual: Estimate,
}

impl CheckedPrediction {
    /// Compares predicted and measured values, pass by pass in the order of time, given also the
    /// prediction with each round's own prices.
    #[must_use]
    pub fn of(passes: &[[f64; 2]], rounds: &[f64]) -> Self {
        let over = |value: fn(&[f64; 2]) -> f64| {
            Estimate::in_order(&passes.iter().map(value).collect::<Vec<_>>())
        };
        let by_round = Estimate::in_order(rounds);
        let predicted = widened(over(|[predicted, _]| *predicted), by_round.half_width);
        let residual = over(|[predicted, measured]| measured / predicted - 1.0);
        Self {
            predicted,
            measured: over(|[_, measured]| *measured),
            residual: widened(residual, by_round.relative() * (1.0 + residual.mean)),
        }
    }
}

/// Adds another, independent uncertainty to an estimate.
fn widened(estimate: Estimate, by: f64) -> Estimate {
    Estimate { half_width: estimate.half_width.hypot(by), ..estimate }
}

choices! {
    /// An assumption of a prediction. If the prediction is off, it is the one that fails.
    Assumption, "assumption", {
        /// Neither prices nor frames scatter by more than the residual.
        Steady = "the assumption that the machine worked at one speed while prices and frames were measured",
        /// Updates take as long as in the calibration.
        Updates = "the assumption that an update costs the same here as on the calibration's bodies",
        /// Neither the number of bodies nor how hits lie among misses changes a price.
        Finding = "the assumption that finding and testing cost the same here as at the calibration's densities and numbers of bodies",
        /// Second tests follow one another as in the calibration.
        Refining = "the assumption that a second test costs the same here as on the calibration's pairs",
    }
}

/// The cost of one variant in one scene and regime.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cost {
    /// The scene.
    pub scene: String,
    /// N.
    pub bodies: usize,
    /// The strategy.
    pub strategy: Strategy,
    /// Its name in tables: the strategy's, or a variant's.
    pub variant: String,
    /// Warm or cold frames.
    pub regime: Regime,
    /// The cache that holds the working set; `None` in earlier records.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level: Option<CacheLevel>,
    /// Frames of a pass.
    pub frames: u32,
    /// The terms of each volume, means over passes.
    pub terms: Vec<Terms>,
    /// Half-widths of the terms' intervals over passes; empty in earlier records.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub widths: Vec<Terms>,
    /// Seconds per frame without construction: the terms' sum, and the median over frames.
    pub frame: CheckedPrediction,
    /// Co, seconds.
    pub construct: CheckedPrediction,
    /// T = Co + all frames, seconds.
    pub total: CheckedPrediction,
    /// The assumption that fails, if the residual of a frame is above [`MOST_RIGHT_RESIDUAL`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fails: Option<Assumption>,
}

/// The largest relative error of a prediction that counts as right.
pub const MOST_RIGHT_RESIDUAL: f64 = 0.05;

impl Cost {
    /// A term summed over the variant's volumes.
    pub fn sum(&self, term: fn(&Terms) -> f64) -> f64 {
        self.terms.iter().map(term).sum()
    }
}

/// The cost of variant number `at` from passes over one scene in the order of time; `None` if the
/// formula has no term for it, or if nothing was measured. `priced` are all passes whose rounds
/// calibrated scenes of this kind.
#[must_use]
pub fn cost(
    (scene, bodies): (&str, usize),
    (at, variant): (usize, &Variant),
    (passes, priced): (&[&Pass], &[&Pass]),
    regime: Regime,
) -> Option<Cost> {
    let rounds = rounds(priced, at, regime);
    let prices = Prices::mean(rounds.iter().copied())?;
    let culled: Vec<&VariantRun> =
        passes.iter().map(|pass| pass.culled.get(at)).collect::<Option<_>>()?;
    let terms_at = |prices: &Prices, culled: &VariantRun| {
        prices.predict(&culled.counts, culled.frames, bodies)
    };
    let parts: Vec<Vec<Terms>> = culled.iter().map(|culled| terms_at(&prices, culled)).collect();
    let is_timed = |culled: &&&VariantRun| !culled.times.of(regime).is_empty();
    let (first, last) = (parts.first().filter(|terms| !terms.is_empty())?, culled.last()?);
    if culled.iter().filter(is_timed).count() < culled.len() {
        return None;
    }
    let by_round: Vec<Vec<Terms>> = rounds.iter().map(|prices| terms_at(prices, last)).collect();
    let frames = f64::from(last.frames);
    let seconds: Vec<f64> =
        culled.iter().map(|culled| culled.times.quartiles(regime).median).collect();
    let compared = |predicted: &dyn Fn(&[Terms]) -> f64, measured: &dyn Fn(usize) -> f64| {
        let pass = |(number, terms): (usize, &Vec<Terms>)| [predicted(terms), measured(number)];
        let passes: Vec<_> = parts.iter().enumerate().map(pass).collect();
        let rounds: Vec<_> = by_round.iter().map(|terms| predicted(terms)).collect();
        CheckedPrediction::of(&passes, &rounds)
    };
    let per_frame = |terms: &[Terms]| terms.iter().map(Terms::recurring).sum::<f64>();
    let once = |terms: &[Terms]| terms.iter().map(|terms| terms.construct).sum::<f64>();
    let frame = compared(&per_frame, &|pass| seconds[pass]);
    let of_volume =
        |from: &[Vec<Terms>], at: usize| from.iter().map(|terms| terms[at]).collect::<Vec<_>>();
    let widths = |at| {
        let passes = Terms::widths(&of_volume(&parts, at))?;
        Some(passes.joined(Terms::widths(&of_volume(&by_round, at))?))
    };
    let terms: Vec<Terms> =
        (0..first.len()).filter_map(|at| Terms::mean(&of_volume(&parts, at))).collect();
    Some(Cost {
        scene: scene.to_owned(),
        bodies,
        strategy: variant.settings.strategy,
        variant: variant.name.clone(),
        regime,
        level: Some(prices.level),
        frames: last.frames,
        widths: (0..first.len()).filter_map(widths).collect(),
        fails: (frame.residual.mean.abs() > MOST_RIGHT_RESIDUAL)
            .then(|| failing(&frame, &terms, &culled, regime)),
        terms,
        frame,
        construct: compared(&once, &|pass| culled[pass].construct),
        total: compared(&|terms| once(terms) + frames * per_frame(terms), &|pass| {
            culled[pass].construct + frames * seconds[pass]
        }),
    })
}

/// The assumption that fails: a steady machine if the residual is within its own interval,
/// otherwise that of the stage with the largest error.
fn failing(
    frame: &CheckedPrediction,
    terms: &[Terms],
    culled: &[&VariantRun],
    regime: Regime,
) -> Assumption {
    if frame.residual.half_width.is_finite() && frame.residual.covers(0.0) {
        return Assumption::Steady;
    }
    let stages: Vec<StageSeconds> =
        culled.iter().map(|culled| culled.times.medians(regime)).collect();
    let measured = |stage: fn(&StageSeconds) -> f64| {
        stages.iter().map(stage).sum::<f64>() / stages.len() as f64
    };
    let update: f64 = terms.iter().map(|terms| terms.update).sum();
    let refining: f64 = terms.iter().skip(1).map(|terms| terms.test).sum();
    let off = [
        (Assumption::Updates, measured(|s| s.update) - update),
        (Assumption::Refining, measured(|s| s.refining + s.hulls) - refining),
        (Assumption::Finding, frame.measured.mean - frame.predicted.mean),
    ];
    if terms.len() == 1 {
        let [updates, _, whole] = off;
        return if updates.1.abs() > 0.5 * whole.1.abs() { updates.0 } else { whole.0 };
    }
    let [updates, refining, (finding, whole)] = off;
    let off = [updates, refining, (finding, whole - updates.1 - refining.1)];
    let farthest = off.into_iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    farthest.map_or(finding, |(assumption, _)| assumption)
}

/// The prices of variant number `at` from each round.
fn rounds<'a>(priced: &[&'a Pass], at: usize, regime: Regime) -> Vec<&'a Prices> {
    let of = |pass: &&'a Pass| pass.prices[regime as usize].get(at);
    priced.iter().filter_map(of).collect()
}

/// The prices of a volume: means over passes, with the half-widths of their intervals.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PriceRow {
    /// The variant.
    pub variant: String,
    /// The volume.
    pub volume: Volume,
    /// The regime.
    pub regime: Regime,
    /// The cache that holds the working set; `None` in earlier records.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level: Option<CacheLevel>,
    /// Each price by its [key](super::PriceKind::key), in seconds.
    #[serde(flatten)]
    pub prices: BTreeMap<String, Estimate>,
}

/// The prices from the rounds of some passes, in the order of variants and tests.
#[must_use]
pub fn prices(priced: &[&Pass], regime: Regime) -> Vec<PriceRow> {
    let variants = priced.first().map_or(0, |pass| pass.prices[regime as usize].len());
    let mut rows = Vec::new();
    for at in 0..variants {
        let rounds = rounds(priced, at, regime);
        for (number, price) in rounds[0].volumes.iter().enumerate() {
            let prices = PRICES.map(|kind| {
                let of = |round: &&Prices| kind.value(round.volumes[number].costs);
                let rounds: Vec<f64> = rounds.iter().map(of).collect();
                (kind.key.to_owned(), Estimate::in_order(&rounds))
            });
            rows.push(PriceRow {
                variant: rounds[0].variant.clone(),
                volume: price.volume,
                regime,
                level: Some(rounds[0].level),
                prices: prices.into(),
            });
        }
    }
    rows
}
