//! Counts compared with the truth: precision, reported pairs per true pair, recall. They are the
//! same to the bit on every machine.

use serde::{Deserialize, Serialize};

use super::truth::{Sample, TruePairs};
use super::variant::Variant;
use crate::hash::PairsHash;
use crate::scene::Scene;
use crate::simulate::SimulationError;
use sdop::counters::{Counters, VolumeCounters};
use sdop::simd::Tier;
use sdop_judge::contestant::Contestant;

/// The counts of a variant on the sample frames of one seed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tally {
    /// Sample frames.
    pub frames: u32,
    /// Pairs whose meshes meet.
    pub truth: u64,
    /// Pairs that the variant reported.
    pub reported: u64,
    /// Reported pairs whose meshes meet.
    pub found: u64,
    /// The culler's counters.
    pub counters: Counters,
    /// The hulls' counters.
    pub hulls: VolumeCounters,
    /// The hash of the reported pairs.
    pub pairs_sha256: String,
}

/// Precision and recall.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Quality {
    /// True pairs / reported pairs; 1 if nothing is reported.
    pub precision: f64,
    /// Reported pairs / true pairs; infinite if there are no true pairs.
    #[serde(deserialize_with = "crate::measure::estimate::or_infinite")]
    pub per_true: f64,
    /// True pairs found / true pairs; 1 if there are no true pairs.
    pub recall: f64,
}

impl Tally {
    /// Culls the sample frames and compares with the truth.
    ///
    /// # Errors
    /// The settings can't be carried out.
    pub fn of(
        scene: &Scene,
        variant: &Variant,
        tier: Tier,
        samples: &[Sample],
        truth: &TruePairs,
    ) -> Result<Self, SimulationError> {
        let mut culling = variant.culling(scene, tier)?;
        let (mut reported, mut found, mut hash) = (0, 0, PairsHash::default());
        for (sample, truth) in samples.iter().zip(truth) {
            culling.frame(&sample.bodies);
            culling.accepted()?;
            let mut pairs = culling.pairs();
            pairs.sort_unstable();
            reported += pairs.len() as u64;
            found += shared(&pairs, truth);
            hash.frame(sample.frame, &pairs);
        }
        Ok(Self {
            frames: samples.len() as u32,
            truth: truth.iter().map(|pairs| pairs.len() as u64).sum(),
            reported,
            found,
            counters: culling.counters(),
            hulls: culling.hull_counters(),
            pairs_sha256: hash.finish(),
        })
    }

    /// The same without a truth: no reported pair counts as true.
    ///
    /// # Errors
    /// The settings can't be carried out.
    pub fn unjudged(
        scene: &Scene,
        variant: &Variant,
        tier: Tier,
        samples: &[Sample],
    ) -> Result<Self, SimulationError> {
        let nothing = vec![Vec::new(); samples.len()];
        Self::of(scene, variant, tier, samples, &nothing)
    }

    /// Pairs reported per frame.
    #[must_use]
    pub fn reported_a_frame(&self) -> f64 {
        self.reported as f64 / f64::from(self.frames)
    }

    /// Precision and recall.
    #[must_use]
    pub fn quality(&self) -> Quality {
        Quality {
            precision: share(self.found, self.reported),
            per_true: self.reported as f64 / self.truth as f64,
            recall: share(self.found, self.truth),
        }
    }
}

/// `part` / `whole`; 1 if both are 0.
pub(super) fn share(part: u64, whole: u64) -> f64 {
    match whole {
        0 => 1.0,
        _ => part as f64 / whole as f64,
    }
}

/// Number of the truth's pairs among the reported; both are sorted.
#[must_use]
pub fn shared(reported: &[[u32; 2]], truth: &[[u32; 2]]) -> u64 {
    let found = truth.iter().filter(|pair| reported.binary_search(pair).is_ok());
    found.count() as u64
}
