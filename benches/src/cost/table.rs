//! T of each variant in each regime: the formula's terms, predicted from prices of other scenes,
//! beside what runs took.

use serde::{Deserialize, Serialize};

use super::VolumeCosts;
use super::pass::Pass;
use super::predict::{Prices, TermWidths, Terms};
use crate::measure::counts::Volume;
use crate::measure::estimate::Estimate;
use crate::measure::turns::{Quartiles, Regime};
use crate::measure::variant::Variant;
use sdop::settings::Strategy;

/// A number as predicted and as measured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Compared {
    /// From prices and counts.
    pub predicted: Estimate,
    /// By the clock.
    pub measured: Estimate,
    /// Measured over predicted, less one, pass by pass: its interval holds the calibration's
    /// uncertainty as well.
    pub residual: Estimate,
}

impl Compared {
    /// From predicted and measured values, pass by pass in the order of time.
    #[must_use]
    pub fn of(passes: &[[f64; 2]]) -> Self {
        let over = |value: fn(&[f64; 2]) -> f64| {
            Estimate::in_order(&passes.iter().map(value).collect::<Vec<_>>())
        };
        Self {
            predicted: over(|[predicted, _]| *predicted),
            measured: over(|[_, measured]| *measured),
            residual: over(|[predicted, measured]| measured / predicted - 1.0),
        }
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
    /// What tables call it: the strategy's name, or a variant's.
    pub variant: String,
    /// What the culler found in the caches.
    pub regime: Regime,
    /// Frames of a pass.
    pub frames: u32,
    /// The terms of each volume, means over passes.
    pub terms: Vec<Terms>,
    /// Half-widths of their intervals over passes; empty in earlier records.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub widths: Vec<TermWidths>,
    /// Seconds per frame without construction: the terms' sum, and the median over frames.
    pub frame: Compared,
    /// The frames' quartiles, means over passes.
    pub quartiles: Quartiles,
    /// Co, seconds.
    pub construct: Compared,
    /// T = Co + all frames, seconds.
    pub total: Compared,
}

impl Cost {
    /// A term summed over the variant's volumes.
    pub fn sum(&self, term: fn(&Terms) -> f64) -> f64 {
        self.terms.iter().map(term).sum()
    }

    /// Whether the formula misses the frames by more than a share.
    #[must_use]
    pub fn misses(&self, share: f64) -> bool {
        self.frame.residual.mean.abs() > share
    }
}

/// The cost of variant number `at` from passes over one scene in the order of time; `None` where
/// the formula has no term for it, or nothing was measured.
#[must_use]
pub fn cost(
    (scene, bodies): (&str, usize),
    (at, variant): (usize, &Variant),
    passes: &[&Pass],
    regime: Regime,
) -> Option<Cost> {
    let place = Regime::ALL.iter().position(|&other| other == regime)?;
    let mut parts: Vec<Vec<Terms>> = Vec::new();
    let (mut frame, mut construct, mut total) = (Vec::new(), Vec::new(), Vec::new());
    let mut quartiles = Vec::new();
    for pass in passes {
        let (culled, prices) = (pass.culled.get(at)?, pass.prices[place].get(at)?);
        let terms = Prices::predict(prices, &culled.counts, culled.frames, bodies);
        if terms.is_empty() || culled.times.of(regime).is_empty() {
            return None;
        }
        let of = |term: fn(&Terms) -> f64| terms.iter().map(term).sum::<f64>();
        let seconds = culled.times.quartiles(regime);
        let per_frame = [of(Terms::recurring), seconds.median];
        let once = [of(|t| t.construct), culled.construct];
        let frames = f64::from(culled.frames);
        total.push([0, 1].map(|i| once[i] + frames * per_frame[i]));
        frame.push(per_frame);
        construct.push(once);
        quartiles.push(seconds);
        parts.push(terms);
    }
    let first = parts.first()?;
    let of_volume = |at: usize| parts.iter().map(|terms| terms[at]).collect::<Vec<_>>();
    let volumes = || (0..first.len()).map(of_volume);
    Some(Cost {
        scene: scene.to_owned(),
        bodies,
        strategy: variant.settings.strategy,
        variant: variant.name.clone(),
        regime,
        frames: passes.first()?.culled.get(at)?.frames,
        terms: volumes()
            .filter_map(|passes| Terms::mean(&passes))
            .collect(),
        widths: volumes()
            .filter_map(|passes| TermWidths::of(&passes))
            .collect(),
        frame: Compared::of(&frame),
        quartiles: Quartiles::mean(&quartiles),
        construct: Compared::of(&construct),
        total: Compared::of(&total),
    })
}

/// A volume's prices: means over passes, with the half-widths of their intervals.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PriceRow {
    /// The variant.
    pub variant: String,
    /// The volume.
    pub volume: Volume,
    /// The regime.
    pub regime: Regime,
    /// Co, seconds: all shapes' volumes and an empty culler.
    pub construct: Estimate,
    /// Co per body, seconds.
    pub construct_body: Estimate,
    /// Cu, seconds.
    pub update: Estimate,
    /// F per frame, seconds.
    pub frame: Estimate,
    /// F per body and frame, seconds.
    pub body: Estimate,
    /// F per pair handed on, seconds.
    pub handle: Estimate,
    /// Cv of a hit, seconds.
    pub hit: Estimate,
    /// Cv of a miss, seconds.
    pub miss: Estimate,
}

/// The prices that some passes found, in the order of variants and tests.
#[must_use]
pub fn prices(passes: &[&Pass], regime: Regime) -> Vec<PriceRow> {
    let place = Regime::ALL
        .iter()
        .position(|&other| other == regime)
        .unwrap_or(0);
    let Some(first) = passes.first() else {
        return Vec::new();
    };
    let mut rows = Vec::new();
    for (at, prices) in first.prices[place].iter().enumerate() {
        for (number, price) in prices.volumes.iter().enumerate() {
            let over = |value: fn(&VolumeCosts) -> f64| {
                let of = |pass: &&Pass| value(&pass.prices[place][at].volumes[number].costs);
                Estimate::in_order(&passes.iter().map(of).collect::<Vec<_>>())
            };
            rows.push(PriceRow {
                variant: prices.variant.clone(),
                volume: price.volume,
                regime,
                construct: over(|c| c.construct),
                construct_body: over(|c| c.construct_body),
                update: over(|c| c.update),
                frame: over(|c| c.frame),
                body: over(|c| c.body),
                handle: over(|c| c.handle),
                hit: over(|c| c.hit),
                miss: over(|c| c.miss),
            });
        }
    }
    rows
}
