//! The cost of each strategy on one scene: passes over seeds, each with its calibration, and the
//! results.

use miette::Diagnostic;
use serde::Serialize;
use thiserror::Error;

use super::calibrate::{Calibration, Effort};
use super::pass::{Pass, SceneFrames, pass};
use super::table::{self, Cost, PriceRow};
use crate::measure::conditions::Conditions;
use crate::measure::machine::Machine;
use crate::measure::turns::Regime;
use crate::measure::variant::Variant;
use crate::scene::{Scene, SceneError, SceneFile};
use crate::simulate::SimulationError;
use sdop::settings::{CullSettings, Strategy};
use sdop::simd::Tier;

/// The amount of measurement.
#[derive(Clone, Debug)]
pub struct CostPlan {
    /// The strategies without the control, for which the formula has no term.
    pub strategies: Vec<Strategy>,
    /// Number of passes. The first has the scene's seed, and each one the next seed.
    pub passes: u64,
    /// Frames of a pass.
    pub frames: u32,
    /// How long to calibrate in each pass.
    pub effort: Effort,
    /// The tier that culls.
    pub tier: Tier,
}

/// The cost of every strategy in one scene.
#[derive(Clone, Debug, Serialize)]
pub struct CostReport {
    /// The scene.
    pub scene: String,
    /// N.
    pub bodies: usize,
    /// Frames of each pass.
    pub frames: u32,
    /// Number of frames of the scene.
    pub scene_frames: u32,
    /// The seeds of the passes, in the order of time.
    pub seeds: Vec<u64>,
    /// The machine and the tier.
    pub machine: Machine,
    /// Other load of the machine.
    pub conditions: Conditions,
    /// Prices of every strategy's volumes, warm and cold.
    pub prices: Vec<PriceRow>,
    /// Predicted and measured times of every strategy, warm and cold.
    pub costs: Vec<Cost>,
}

/// The error of a cost that can't be measured.
#[derive(Debug, Error, Diagnostic)]
pub enum CostError {
    /// The scene can't be built.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Scene(#[from] SceneError),
    /// The scene can't be simulated or culled.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Simulation(#[from] SimulationError),
}

/// The strategies for which a scene has all settings, without the control.
#[must_use]
pub fn possible(scene: &Scene) -> Vec<Strategy> {
    let has = |&strategy: &Strategy| {
        let settings = CullSettings {
            strategy,
            ..scene.cull.clone()
        };
        strategy.scheme().culls() && settings.check(scene.bodies.len()).is_ok()
    };
    Strategy::ALL.iter().copied().filter(has).collect()
}

/// Measures, and calls `done` after each pass.
///
/// # Errors
/// The scene can't be built, simulated or culled.
pub fn study(
    file: &SceneFile,
    plan: &CostPlan,
    mut done: impl FnMut(),
) -> Result<CostReport, CostError> {
    let mut file = file.clone();
    let scene = file.build()?;
    let variants: Vec<Variant> = plan
        .strategies
        .iter()
        .map(|&strategy| Variant::strategy(&scene.cull, strategy))
        .collect();
    let before = Conditions::before();
    let mut calibration = Calibration::new(&scene, &variants, plan.tier, plan.effort)?;
    let seeds: Vec<u64> = (0..plan.passes)
        .map(|n| scene.seed.wrapping_add(n))
        .collect();
    let mut passes: Vec<Pass> = Vec::new();
    for &seed in &seeds {
        file.spec.seed = seed;
        let scene = file.build()?;
        let mut frames = SceneFrames::new(&scene, plan.frames)?;
        let calibration = Some(&mut calibration);
        passes.push(pass(
            &scene,
            &variants,
            plan.tier,
            &mut frames,
            calibration,
            &mut (),
        )?);
        done();
    }
    let passes: Vec<&Pass> = passes.iter().collect();
    let mut costs = Vec::new();
    for of in variants.iter().enumerate() {
        for &regime in Regime::ALL {
            costs.extend(table::cost(
                (&scene.name, scene.bodies.len()),
                of,
                (&passes, &passes),
                regime,
            ));
        }
    }
    let prices = Regime::ALL
        .iter()
        .flat_map(|&regime| table::prices(&passes, regime));
    Ok(CostReport {
        bodies: scene.bodies.len(),
        frames: plan.frames,
        scene_frames: scene.frames,
        seeds,
        machine: Machine::here(plan.tier),
        conditions: before.after(costs.iter().map(|cost: &Cost| cost.frame.measured)),
        prices: prices.collect(),
        costs,
        scene: scene.name,
    })
}
