//! Worlds: for a scene in which bodies fall asleep, the time of a culler, which is given every pose
//! in every frame, beside that of a world, which keeps the pairs of bodies that stay.

use serde::{Deserialize, Serialize};

use super::density::lines_of_a_run;
use super::pays::Line;
use super::variant::Variant;
use super::{Estimate, TradeoffError};
use crate::scene::Scene;
use sdop::simd::Tier;

/// A variant in a culler and in a world, on the same frames.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WorldTimes {
    /// The variant.
    pub variant: String,
    /// Pairs reported per frame, by either.
    pub reported: f64,
    /// T of a culler: seconds per warm frame of a run.
    pub culler: Estimate,
    /// T of a world, which is given the poses that have changed.
    pub world: Estimate,
}

/// Times those of the variants that a world can have, in turns.
///
/// # Errors
/// The settings can't be carried out, or a body leaves the contract.
pub fn times(
    scene: &Scene,
    variants: &[Variant],
    tier: Tier,
) -> Result<Vec<WorldTimes>, TradeoffError> {
    let alone = variants.iter().filter(|variant| variant.may_be_in_world());
    let in_worlds = alone.clone().cloned().map(Variant::in_world);
    let both: Vec<Variant> = alone.cloned().chain(in_worlds).collect();
    let lines = lines_of_a_run(scene, &both, tier)?;
    let (cullers, worlds) = lines.split_at(both.len() / 2);
    let row = |(culler, world): (&Line, &Line)| WorldTimes {
        variant: culler.name.clone(),
        reported: culler.pairs,
        culler: Estimate::in_order(&culler.times),
        world: Estimate::in_order(&world.times),
    };
    Ok(cullers.iter().zip(worlds).map(row).collect())
}
