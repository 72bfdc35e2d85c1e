//! Object of interest: precision and cost as the interest set grows from one body to all.

use serde::{Deserialize, Serialize};

use super::counts::{Quality, Tally};
use super::timing::measure;
use super::truth::{Sample, TruePairs};
use super::variant::Variant;
use super::{Estimate, TradeoffError};
use crate::cost::pass::medians;
use crate::measure::turns::Regime;
use crate::scene::Scene;
use sdop::settings::{CullSettings, Interest, Strategy, Updates};
use sdop::simd::Tier;

/// Shares of the bodies that are of interest; the first means one body.
const SHARES: [f64; 8] = [0.0, 0.02, 0.05, 0.1, 0.25, 0.5, 0.75, 1.0];

/// One size of the interest set.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct InterestRow {
    /// Bodies of interest.
    pub bodies: usize,
    /// or-DOP tests per frame.
    pub tests: f64,
    /// Pairs reported per frame.
    pub reported: f64,
    /// Precision and recall.
    #[serde(flatten)]
    pub quality: Quality,
    /// Median seconds of a warm frame, all or-DOP poses updated.
    pub seconds: Estimate,
    /// Median seconds of a warm frame, with or-DOP poses updated only if a pair needs them.
    pub lazy_seconds: Estimate,
}

/// The counts of an interest set of one size.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InterestCounts {
    /// Bodies of interest.
    bodies: usize,
    /// Counts on the sample frames.
    tally: Tally,
}

/// Sizes of the interest set, growing.
fn sizes(scene: &Scene) -> Vec<usize> {
    let n = scene.bodies.len();
    let size = |share: f64| ((share * n as f64).round() as usize).clamp(1, n);
    let mut sizes = SHARES.map(size).to_vec();
    sizes.dedup();
    sizes
}

/// A variant with `size` bodies of interest, evenly spread.
fn variant(scene: &Scene, size: usize, updates: Updates) -> Variant {
    let settings = CullSettings {
        strategy: Strategy::SDopObjectOfInterest,
        updates,
        interest: Some(Interest::Bodies(spread(scene.bodies.len(), size))),
        ..scene.cull.clone()
    };
    Variant::of(format!("{size} of interest"), settings)
}

/// Counts for every size.
///
/// # Errors
/// The settings can't be carried out.
pub fn counts(
    scene: &Scene,
    tier: Tier,
    samples: &[Sample],
    truth: &TruePairs,
) -> Result<Vec<InterestCounts>, TradeoffError> {
    let counted = |bodies: usize| {
        let variant = variant(scene, bodies, Updates::Eager);
        let tally = Tally::of(scene, &variant, tier, samples, truth)?;
        Ok(InterestCounts { bodies, tally })
    };
    sizes(scene).into_iter().map(counted).collect()
}

/// Median seconds of a warm frame for every size: with all or-DOP poses updated, and with only
/// those that a pair needs.
///
/// # Errors
/// The settings can't be carried out.
pub fn times(scene: &Scene, tier: Tier, count: u32) -> Result<Vec<[Estimate; 2]>, TradeoffError> {
    let sizes = sizes(scene);
    let all = |updates| sizes.iter().map(move |&size| variant(scene, size, updates));
    let both: Vec<Variant> = all(Updates::Eager).chain(all(Updates::Lazy)).collect();
    let passes = measure(scene, &both, tier, count)?;
    let seconds = |at: usize| medians(&passes, at, Regime::Warm);
    let of = |at: usize| [seconds(at), seconds(sizes.len() + at)];
    Ok((0..sizes.len()).map(of).collect())
}

/// Joins counts and times.
pub(super) fn rows(counts: &[InterestCounts], times: &[[Estimate; 2]]) -> Vec<InterestRow> {
    let row = |(counted, times): (&InterestCounts, &[Estimate; 2])| {
        let InterestCounts { bodies, tally } = counted;
        InterestRow {
            bodies: *bodies,
            tests: tally.counters.ordop.tests as f64 / f64::from(tally.frames),
            reported: tally.reported_a_frame(),
            quality: tally.quality(),
            seconds: times[0],
            lazy_seconds: times[1],
        }
    };
    counts.iter().zip(times).map(row).collect()
}

/// `size` of `n` bodies, evenly spread over their numbers, so that every group of bodies has its
/// part.
pub(super) fn spread(n: usize, size: usize) -> Vec<u32> {
    (0..size).map(|i| (i * n / size) as u32).collect()
}
