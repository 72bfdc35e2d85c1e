//! The share of sphere hits that or-DOPs do not separate, by k and overlap test.

use crate::measure::variant::Variant;
use crate::scene::Scene;
use crate::simulate::SimulationError;
use sdop::settings::{CullSettings, Overlap, Strategy};
use sdop::simd::Tier;
use sdop::volume::DirectionSet;
use sdop_judge::contestant::Contestant as _;

/// The share of sphere hits that an or-DOP test lets through, in the first frames of the calibrated
/// scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Survival {
    /// The or-DOP.
    pub k: DirectionSet,
    /// Its test.
    pub overlap: Overlap,
    /// One share a seed.
    pub shares: Vec<f64>,
}

impl Survival {
    /// Every or-DOP with every test, not measured yet.
    pub(super) fn every() -> Vec<Self> {
        let with = |&k: &DirectionSet| {
            let row = move |&overlap: &Overlap| Self { k, overlap, shares: Vec::new() };
            Overlap::ALL.iter().map(row)
        };
        DirectionSet::ALL.iter().flat_map(with).collect()
    }

    /// or-DOP hits among the sphere hits of the scene's first frame.
    pub(super) fn share(&self, scene: &Scene, tier: Tier) -> Result<f64, SimulationError> {
        let variant = Variant::of(
            String::new(),
            CullSettings {
                strategy: Strategy::SDopBatch,
                k: self.k,
                overlap: self.overlap,
                ..scene.cull.clone()
            },
        );
        let mut culling = variant.culling(scene, tier)?;
        culling.frame(&scene.bodies);
        culling.accepted()?;
        let ordop = culling.counters().ordop;
        Ok(ordop.hits as f64 / ordop.tests as f64)
    }
}
