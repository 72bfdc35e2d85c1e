//! The cost of each strategy in scenes of one kind: passes over seeds, each with its calibration,
//! and the results.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;

use super::calibrate::{Calibration, Effort};
use super::level::CacheLevel;
use super::pass::{Pass, SceneFrames, pass};
use super::table::{self, Cost, PriceRow};
use crate::measure::conditions::Conditions;
use crate::measure::machine::Machine;
use crate::measure::turns::{FEWEST_TIMED_FRAMES, Regime};
use crate::measure::variant::Variant;
use crate::scene::{Scene, SceneFile};
use sdop::settings::{CullSettings, Strategy};
use sdop::simd::Tier;
use sdop::volume::Shape;

/// The amount of measurement.
#[derive(Clone, Debug)]
pub struct CostPlan {
    /// The strategies without the control, for which the formula has no term.
    pub strategies: Vec<Strategy>,
    /// Number of passes. The first has the scene's seed, and each one the next seed.
    pub passes: u64,
    /// Frames of a pass, or all of a scene that has fewer.
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

/// A scene, and its passes so far.
struct StudiedScene {
    file: SceneFile,
    scene: Scene,
    frames: u32,
    passes: Vec<Pass>,
}

impl StudiedScene {
    fn new(file: &SceneFile, plan: &CostPlan) -> miette::Result<Self> {
        let scene = file.build()?;
        let frames = plan.frames.min(scene.frames);
        Ok(Self {
            file: file.clone(),
            frames: frames.max(FEWEST_TIMED_FRAMES.get()),
            scene,
            passes: Vec::new(),
        })
    }

    /// Checks that this scene and the first one have the same calibration scenes.
    fn is_like(&self, first: &Self) -> miette::Result<()> {
        let rests = |studied: &Self| studied.scene.effects.rest.is_some();
        let differ = if self.scene.cull != first.scene.cull {
            "`[cull]` tables"
        } else if rests(self) != rests(first) {
            "effects, one with `rest` and one without it,"
        } else if self.meshes() != first.meshes() {
            "meshes or radii"
        } else {
            return Ok(());
        };
        miette::bail!(
            help = "run `sdop cost` for each kind of scene by itself",
            "{} and {} can't have the same prices: their {differ} differ",
            self.scene.name,
            first.scene.name
        )
    }

    /// The bits of the vertices of each shape, each once.
    fn meshes(&self) -> BTreeSet<Vec<[u32; 3]>> {
        let bits = |shape: &Shape| shape.vertices.iter().map(|v| v.map(f32::to_bits)).collect();
        self.scene.shapes.iter().map(bits).collect()
    }

    /// The scene of pass number `n`, which has the nth next seed.
    fn of_pass(&mut self, n: u64) -> miette::Result<Scene> {
        self.file.spec.seed = self.scene.seed.wrapping_add(n);
        Ok(self.file.build()?)
    }

    fn level(&self) -> CacheLevel {
        CacheLevel::of(self.scene.bodies.len())
    }
}

/// The strategies for which a scene has all settings, without the control.
#[must_use]
pub fn possible(scene: &Scene) -> Vec<Strategy> {
    let has = |&strategy: &Strategy| {
        let settings = CullSettings { strategy, ..scene.cull.clone() };
        strategy.scheme().culls() && settings.check(scene.bodies.len()).is_ok()
    };
    Strategy::ALL.iter().copied().filter(has).collect()
}

/// Measures scenes of one kind, calls `done` after each pass, and returns a report per scene. In a
/// pass, all scenes with working sets of one cache level have the same prices.
///
/// # Errors
/// A scene can't be built, simulated or culled, or is of another kind than the first.
pub fn study(
    files: &[SceneFile],
    plan: &CostPlan,
    mut done: impl FnMut(),
) -> miette::Result<Vec<CostReport>> {
    let scenes = files.iter().map(|file| StudiedScene::new(file, plan));
    let mut scenes = scenes.collect::<Result<Vec<_>, _>>()?;
    let Some(first) = scenes.first() else {
        return Ok(Vec::new());
    };
    scenes.iter().try_for_each(|other| other.is_like(first))?;
    let of_strategy = |&strategy| Variant::strategy(&first.scene.cull, strategy);
    let variants: Vec<Variant> = plan.strategies.iter().map(of_strategy).collect();
    let mut calibrations: BTreeMap<CacheLevel, Calibration> = BTreeMap::new();
    for studied in &scenes {
        if let Entry::Vacant(free) = calibrations.entry(studied.level()) {
            let (tier, effort) = (plan.tier, plan.effort);
            free.insert(Calibration::new(&studied.scene, &variants, tier, effort)?);
        }
    }
    let before = Conditions::before();
    for n in 0..plan.passes {
        for (&level, calibration) in &mut calibrations {
            let round = calibration.round()?;
            let of_level = scenes.iter_mut().filter(|studied| studied.level() == level);
            for studied in of_level {
                let scene = studied.of_pass(n)?;
                let mut frames = SceneFrames::new(&scene, studied.frames)?;
                let round = Some(round.clone());
                let pass = pass(&scene, &variants, plan.tier, &mut frames, round, &mut ())?;
                studied.passes.push(pass);
                done();
            }
        }
    }
    let report = |studied| report(studied, &variants, plan, before);
    Ok(scenes.into_iter().map(report).collect())
}

fn report(
    studied: StudiedScene,
    variants: &[Variant],
    plan: &CostPlan,
    before: Conditions,
) -> CostReport {
    let StudiedScene { scene, frames, .. } = studied;
    let passes: Vec<&Pass> = studied.passes.iter().collect();
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
    let prices = Regime::ALL.iter().flat_map(|&regime| table::prices(&passes, regime));
    CostReport {
        bodies: scene.bodies.len(),
        frames,
        scene_frames: scene.frames,
        seeds: (0..plan.passes).map(|n| scene.seed.wrapping_add(n)).collect(),
        machine: Machine::here(plan.tier),
        conditions: before.after(costs.iter().map(|cost: &Cost| cost.frame.measured)),
        prices: prices.collect(),
        costs,
        scene: scene.name,
    }
}
