//! Object of interest: precision and cost as the interest set grows from one body to all.

use serde::{Deserialize, Serialize};

use super::TradeoffError;
use super::counts::{Quality, Tally};
use super::timing::measure;
use super::truth::{Sample, Truth};
use super::variant::Variant;
use crate::lab::scene::Scene;
use crate::settings::{CullSettings, Interest, Strategy, Updates};
use crate::simd::Tier;

/// Parts of the bodies that are of interest; the first is one body.
const SHARES: [f64; 8] = [0.0, 0.02, 0.05, 0.1, 0.25, 0.5, 0.75, 1.0];

/// One size of the interest set.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct InterestRow {
    /// Bodies of interest.
    pub bodies: usize,
    /// or-DOP tests a frame.
    pub tests: f64,
    /// Pairs reported a frame.
    pub reported: f64,
    /// Precision and recall.
    #[serde(flatten)]
    pub quality: Quality,
    /// Median seconds a frame, all or-DOP poses updated.
    pub seconds: f64,
    /// Median seconds a frame, poses updated where a pair needs them.
    pub lazy_seconds: f64,
}

/// Grows the interest set over evenly spread bodies.
///
/// # Errors
/// Settings that can't be carried out.
pub fn sweep(
    scene: &Scene,
    tier: Tier,
    samples: &[Sample],
    truth: &Truth,
) -> Result<Vec<InterestRow>, TradeoffError> {
    let n = scene.bodies.len();
    let mut sizes = SHARES
        .map(|share| ((share * n as f64).round() as usize).clamp(1, n))
        .to_vec();
    sizes.dedup();
    let variant = |&size: &usize, updates| Variant {
        name: format!("{size} of interest"),
        settings: CullSettings {
            strategy: Strategy::SDopObjectOfInterest,
            updates,
            interest: Some(Interest::Bodies(spread(n, size))),
            ..scene.cull.clone()
        },
        hulls: false,
    };
    let eager: Vec<_> = sizes
        .iter()
        .map(|size| variant(size, Updates::Eager))
        .collect();
    let lazy: Vec<_> = sizes
        .iter()
        .map(|size| variant(size, Updates::Lazy))
        .collect();
    let seconds = measure(
        scene,
        &[&eager[..], &lazy].concat(),
        tier,
        samples,
        3,
        || (),
    )?;
    let (of_eager, of_lazy) = seconds.split_at(sizes.len());
    let mut rows = Vec::new();
    for (at, variant) in eager.iter().enumerate() {
        let tally = Tally::of(scene, variant, tier, samples, truth)?;
        rows.push(InterestRow {
            bodies: sizes[at],
            tests: tally.counters.ordop.tests as f64 / f64::from(tally.frames),
            reported: tally.reported as f64 / f64::from(tally.frames),
            quality: tally.quality(),
            seconds: of_eager[at],
            lazy_seconds: of_lazy[at],
        });
    }
    Ok(rows)
}

/// `size` of `n` bodies, evenly spread over their numbers, so that every group of bodies has its part.
fn spread(n: usize, size: usize) -> Vec<u32> {
    (0..size).map(|i| (i * n / size) as u32).collect()
}
