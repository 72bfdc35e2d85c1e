//! Object of interest: precision and cost as the interest set grows from one body to all.

use serde::{Deserialize, Serialize};

use super::Estimate;
use super::counts::Quality;
use super::variant::Variant;
use crate::scene::Scene;
use sdop::settings::{CullSettings, Interest, Strategy, Updates};

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

/// Sizes of the interest set, growing.
pub(super) fn sizes(scene: &Scene) -> Vec<usize> {
    let n = scene.bodies.len();
    let size = |share: f64| ((share * n as f64).round() as usize).clamp(1, n);
    let mut sizes = SHARES.map(size).to_vec();
    sizes.dedup();
    sizes
}

/// A variant per size, with bodies of interest evenly spread: first every or-DOP
/// is posed in each frame, then only those that a pair needs.
pub(super) fn variants(scene: &Scene) -> Vec<Variant> {
    let mut variants = Vec::new();
    for updates in [Updates::Eager, Updates::Lazy] {
        variants.extend(sizes(scene).into_iter().map(|size| {
            let settings = CullSettings {
                strategy: Strategy::SDopObjectOfInterest,
                updates,
                interest: Some(Interest::Bodies(spread(scene.bodies.len(), size))),
                ..scene.cull.clone()
            };
            Variant::of(format!("{size} of interest, {updates}"), settings)
        }));
    }
    variants
}

/// `size` of `n` bodies, evenly spread over their numbers, so that every group of bodies has its
/// part.
pub(super) fn spread(n: usize, size: usize) -> Vec<u32> {
    (0..size).map(|i| (i * n / size) as u32).collect()
}
