//! The runs: every scene with every seed, all strategies on the same frames.

use serde::{Deserialize, Serialize};

use super::immediate::HandingTimes;
use super::plan::{ExperimentPlan, PaperScene};
use crate::cost::calibrate::CalibrationRound;
use crate::cost::pass::{Observer, Pass, SceneFrames, VariantRun, pass};
use crate::cost::table::{self, Cost};
use crate::hash::PairsHash;
use crate::measure::culling::Culling;
use crate::measure::turns::Regime;
use crate::measure::variant::Variant;
use crate::scene::Scene;
use crate::simulate::SimulationError;
use sdop::counters::{Counters, Seconds};
use sdop::settings::Strategy;
use sdop::simd::Tier;
use sdop_judge::contestant::Contestant;

/// One strategy in one run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StrategyRun {
    /// The scene's name.
    pub scene: String,
    /// N.
    pub bodies: usize,
    /// How many of them are static.
    pub statics: usize,
    /// The box's side.
    pub side: f64,
    /// The mean radius of the bodies' spheres.
    pub radius: f64,
    /// The seed.
    pub seed: u64,
    /// Frames culled.
    pub frames: u32,
    /// The strategy.
    pub strategy: Strategy,
    /// Sums over frames.
    pub counters: Counters,
    /// Medians over warm frames, such that the stages add up to the total; `construct` is Co of the
    /// strategy's volumes and its culler, built once for this run.
    pub seconds: Seconds,
    /// Median seconds of a cold frame.
    pub cold: f64,
    /// Mean seconds of a frame, interruptions by other processes included.
    pub mean: f64,
    /// Median seconds of a simulation step.
    pub step: f64,
    /// Hash of all reported pairs; `None` for the control.
    pub pairs_sha256: Option<String>,
}

/// All that was run.
#[derive(Clone, Debug)]
pub struct Results {
    /// The plan.
    pub plan: ExperimentPlan,
    /// One run a seed, scene and strategy.
    pub runs: Vec<StrategyRun>,
    /// One pass a seed and scene, with its calibration: what the runs were taken from.
    pub passes: Vec<(PaperScene, Pass)>,
    /// The paper's sequential algorithm to the letter, a seed and scene of the most objects each.
    pub immediacies: Vec<HandingTimes>,
    /// The strategies as variants, scene by scene.
    pub variants: Vec<(PaperScene, Vec<Variant>)>,
    /// Hash of paper-500's volumes.
    pub volumes_sha256: String,
}

/// The strategies as variants of the scene's settings.
pub(super) fn variants(scene: &Scene, strategies: &[Strategy]) -> Vec<Variant> {
    let variant = |&strategy: &Strategy| Variant::strategy(&scene.cull, strategy);
    strategies.iter().map(variant).collect()
}

/// Runs the first `frames` frames of one scene with all `strategies` side by side.
///
/// # Errors
/// Strategies or effects that the scene can't have.
pub fn run_scene(
    scene: &Scene,
    strategies: &[Strategy],
    frames: u32,
    tier: Tier,
) -> Result<Vec<StrategyRun>, SimulationError> {
    let variants = variants(scene, strategies);
    run_pass(scene, &variants, frames, tier, None).map(|(runs, _)| runs)
}

/// Hashes what each variant reports, between turns.
struct VariantHashes {
    hashes: Vec<PairsHash>,
    /// Variant, frame and pairs.
    reported: Vec<(usize, u32, Vec<[u32; 2]>)>,
}

impl Observer for VariantHashes {
    fn frame(&mut self, number: usize, frame: u32, culling: &Culling) {
        self.reported.push((number, frame, culling.pairs()));
    }

    fn between_turns(&mut self) {
        for (number, frame, mut pairs) in self.reported.drain(..) {
            pairs.sort_unstable();
            self.hashes[number].frame(frame, &pairs);
        }
    }
}

/// The same as a pass, with its calibration.
pub(super) fn run_pass(
    scene: &Scene,
    variants: &[Variant],
    frames: u32,
    tier: Tier,
    calibration: Option<CalibrationRound>,
) -> Result<(Vec<StrategyRun>, Pass), SimulationError> {
    let mut hashing =
        VariantHashes { hashes: vec![PairsHash::default(); variants.len()], reported: Vec::new() };
    let mut simulated = SceneFrames::new(scene, frames)?;
    let pass = pass(scene, variants, tier, &mut simulated, calibration, &mut hashing)?;
    let bodies = &scene.bodies;
    let radius = |&shape: &u32| f64::from(scene.shapes[shape as usize].ball.radius);
    let run = |((variant, culled), hash): ((&Variant, &VariantRun), PairsHash)| {
        let strategy = variant.settings.strategy;
        let warm = culled.times.medians(Regime::Warm);
        StrategyRun {
            scene: scene.name.clone(),
            bodies: bodies.len(),
            statics: bodies.dynamic.iter().filter(|&&dynamic| !dynamic).count(),
            side: f64::from(scene.side.unwrap_or(f32::INFINITY)),
            radius: bodies.shape.iter().map(radius).sum::<f64>() / bodies.len() as f64,
            seed: scene.seed,
            frames,
            strategy,
            counters: culled.counts.culler,
            seconds: Seconds {
                construct: culled.construct,
                effects: 0.0,
                update: warm.update,
                pair_finding: warm.finding,
                ordop: warm.refining,
                total: warm.total(),
            },
            cold: culled.times.medians(Regime::Cold).total(),
            mean: culled.times.mean(),
            step: pass.step,
            pairs_sha256: strategy.scheme().culls().then(|| hash.finish()),
        }
    };
    let runs = variants.iter().zip(&pass.culled).zip(hashing.hashes).map(run).collect();
    Ok((runs, pass))
}

impl Results {
    /// One value a seed of a strategy in a scene, in the order of seeds.
    #[must_use]
    pub fn by_seed(
        &self,
        scene: &str,
        strategy: Strategy,
        value: impl Fn(&StrategyRun) -> f64,
    ) -> Vec<f64> {
        let of = |run: &&StrategyRun| run.scene == scene && run.strategy == strategy;
        self.runs.iter().filter(of).map(value).collect()
    }

    /// Any run of a scene, for what all of them share.
    #[must_use]
    pub fn example(&self, scene: &str) -> Option<&StrategyRun> {
        self.runs.iter().find(|run| run.scene == scene)
    }

    /// Every scene.
    pub fn scenes(&self) -> impl Iterator<Item = &'static str> + '_ {
        self.plan.names.iter().map(|scene| scene.name())
    }

    /// The scenes that share the paper's one box, by number of bodies.
    pub fn paper_scenes(&self) -> impl Iterator<Item = &'static str> + '_ {
        let usual = self.plan.names.iter().filter(|scene| !scene.crowded());
        usual.map(|scene| scene.name())
    }

    /// A scene's passes in the order of time.
    #[must_use]
    pub fn passes_of(&self, scene: PaperScene) -> Vec<&Pass> {
        let passes = self.passes.iter().filter(|(name, _)| *name == scene);
        passes.map(|(_, pass)| pass).collect()
    }

    /// The passes whose rounds calibrated scenes of the same kind as this one, in the order of
    /// time. Such scenes share their prices.
    #[must_use]
    pub fn priced_as(&self, scene: PaperScene) -> Vec<&Pass> {
        let level = |pass: &Pass| Some(pass.prices[0].first()?.level);
        let own = self.passes_of(scene).first().map(|pass| level(pass));
        let passes = self.passes.iter().map(|(_, pass)| pass);
        passes.filter(|pass| Some(level(pass)) == own).collect()
    }

    /// The cost of every strategy in every scene; the control costs nothing that the formula has a
    /// term for.
    #[must_use]
    pub fn costs(&self, regime: Regime) -> Vec<Cost> {
        let mut costs = Vec::new();
        for (scene, variants) in &self.variants {
            let bodies = self.example(scene.name()).map_or(0, |run| run.bodies);
            let passes = (&self.passes_of(*scene)[..], &self.priced_as(*scene)[..]);
            for of in variants.iter().enumerate() {
                costs.extend(table::cost((scene.name(), bodies), of, passes, regime));
            }
        }
        costs
    }
}
