//! The runs: every scene with every seed, all strategies on the same frames. A scene with one seed
//! is a unit. Joined in their order, units give the results of one process: the same counts to the
//! bit, and the times as they were measured.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use miette::{IntoDiagnostic as _, miette};
use serde::{Deserialize, Serialize};

use super::immediate::{self, HandingTimes};
use super::plan::{ExperimentPlan, PaperScene, STRATEGIES};
use crate::cost::calibrate::{Calibration, CalibrationRound, Effort};
use crate::cost::pass::{Observer, Pass, SceneFrames, VariantRun, pass};
use crate::cost::table::{self, Cost};
use crate::hash::{PairsHash, volumes_sha256};
use crate::measure::culling::Culling;
use crate::measure::machine::Machine;
use crate::measure::turns::Regime;
use crate::measure::variant::Variant;
use crate::scene::{Scene, SceneFile};
use crate::simulate::SimulationError;
use crate::sweep::{Header, Sweep, digest};
use sdop::counters::Counters;
use sdop::settings::Strategy;
use sdop::simd::Tier;
use sdop_judge::contestant::Contestant;

/// What its files are called.
pub const NAME: &str = "reproduce";

/// The input that says what the compared scene's volumes are.
const VOLUMES: &str = "volumes";

/// The requested experiments, and the kind of machine: times from different kinds can't be joined.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExperimentSettings {
    names: Vec<PaperScene>,
    seeds: Vec<u64>,
    frames: u32,
    effort: Effort,
    /// The machine.
    pub machine: Machine,
}

/// The experiments, ready to run.
pub struct Experiments {
    plan: ExperimentPlan,
    prepared: Vec<PreparedScene>,
    inputs: BTreeMap<String, String>,
    /// The calibration of each scene, made with its first unit in this process.
    calibrations: Mutex<BTreeMap<PaperScene, Calibration>>,
}

/// A scene of the plan, and what is made for it once.
struct PreparedScene {
    name: PaperScene,
    file: SceneFile,
    /// Whether no scene has more bodies.
    largest: bool,
    variants: Vec<Variant>,
}

impl Experiments {
    /// Reads and builds the plan's scenes.
    ///
    /// # Errors
    /// Scene files that can't be read or built.
    pub fn new(plan: &ExperimentPlan) -> miette::Result<Self> {
        let load = |scene: PaperScene| {
            SceneFile::read(&plan.scenes.join(scene.name()).with_extension("toml"))
        };
        let mut inputs = BTreeMap::new();
        let volumes = volumes_sha256(&load(PaperScene::Paper500)?.build()?.shapes);
        inputs.insert(VOLUMES.to_owned(), volumes);
        let mut scenes = Vec::new();
        for &name in &plan.names {
            let file = load(name)?;
            let scene = Scene { construct_seconds: 0.0, ..file.build()? };
            inputs.insert(name.to_string(), digest(&scene));
            scenes.push((name, file, scene));
        }
        let most = scenes.iter().map(|(.., scene)| scene.bodies.len()).max();
        let prepared = scenes.into_iter().map(|(name, file, scene)| PreparedScene {
            name,
            file,
            largest: Some(scene.bodies.len()) == most,
            variants: variants(&scene, &STRATEGIES),
        });
        Ok(Self {
            plan: plan.clone(),
            prepared: prepared.collect(),
            inputs,
            calibrations: Mutex::default(),
        })
    }

    /// The settings, of this machine.
    #[must_use]
    pub fn settings(&self) -> ExperimentSettings {
        ExperimentSettings {
            names: self.plan.names.clone(),
            seeds: self.plan.seeds.clone(),
            frames: self.plan.frames,
            effort: self.plan.effort,
            machine: Machine::here(self.plan.tier),
        }
    }

    /// The scene and the seed of a unit.
    fn unit(&self, unit: usize) -> (&PreparedScene, u64) {
        let scenes = self.prepared.len();
        (&self.prepared[unit % scenes], self.plan.seeds[unit / scenes])
    }

    /// Runs a unit.
    ///
    /// # Errors
    /// Scenes that can't be built with the seed or don't suit the strategies.
    fn find(&self, unit: usize) -> miette::Result<UnitResult> {
        let (PreparedScene { name, file, largest, variants }, seed) = self.unit(unit);
        let ExperimentPlan { frames, tier, effort, .. } = self.plan;
        let held = self.calibrations.lock();
        let mut held = held.unwrap_or_else(PoisonError::into_inner);
        let mut calibration = match held.remove(name) {
            Some(calibration) => calibration,
            None => Calibration::new(&file.build()?, variants, tier, effort)?,
        };
        let mut file = file.clone();
        file.spec.seed = seed;
        let scene = file.build()?;
        let (runs, pass) = run_pass(&scene, variants, frames, tier, Some(calibration.round()?))?;
        held.insert(*name, calibration);
        let immediacy = largest.then(|| immediate::measure(&scene, *name, tier));
        Ok(UnitResult {
            name: *name,
            runs,
            pass,
            variants: variants.clone(),
            immediacy: immediacy.transpose()?,
        })
    }
}

impl Sweep for Experiments {
    fn header(&self) -> miette::Result<Header> {
        let units = self.prepared.len() * self.plan.seeds.len();
        let inputs = self.inputs.clone();
        Header::new(NAME, &self.settings(), inputs, units).into_diagnostic()
    }

    fn name(&self, unit: usize) -> String {
        let (scene, seed) = self.unit(unit);
        format!("{}, seed {seed}", scene.name)
    }

    fn run(&self, unit: usize) -> miette::Result<String> {
        serde_json::to_string(&self.find(unit)?).into_diagnostic()
    }

    fn timed(&self, _: usize) -> bool {
        true
    }
}

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
    /// Median seconds of a warm frame.
    pub warm: f64,
    /// Median seconds of a cold frame.
    pub cold: f64,
    /// Hash of all reported pairs; `None` for the control.
    pub pairs_sha256: Option<String>,
}

/// The result of a unit: a scene with one seed.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct UnitResult {
    /// The scene.
    pub name: PaperScene,
    /// One run per strategy.
    pub runs: Vec<StrategyRun>,
    /// The pass that they were taken from, with its calibration.
    pub pass: Pass,
    /// The strategies as variants.
    pub variants: Vec<Variant>,
    /// The paper's sequential algorithm to the letter, in scenes with the most bodies.
    pub immediacy: Option<HandingTimes>,
}

/// All that was run.
#[derive(Clone, Debug)]
pub struct Results {
    /// The plan.
    pub plan: ExperimentPlan,
    /// What units found, in their order.
    pub units: Vec<UnitResult>,
    /// Hash of paper-500's volumes.
    pub volumes_sha256: String,
}

/// The strategies as variants of the scene's settings.
fn variants(scene: &Scene, strategies: &[Strategy]) -> Vec<Variant> {
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
fn run_pass(
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
        let seconds = |regime| culled.times.quartiles(regime).median;
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
            warm: seconds(Regime::Warm),
            cold: seconds(Regime::Cold),
            pairs_sha256: strategy.scheme().culls().then(|| hash.finish()),
        }
    };
    let runs = variants.iter().zip(&pass.culled).zip(hashing.hashes).map(run).collect();
    Ok((runs, pass))
}

impl Results {
    /// Nothing yet of the experiments of a header.
    ///
    /// # Errors
    /// Another command's header, a tier that this CPU lacks.
    pub fn of_header(header: &Header) -> miette::Result<Self> {
        let settings: ExperimentSettings = header.settings().into_diagnostic()?;
        let plan = ExperimentPlan {
            scenes: Default::default(),
            names: settings.names,
            seeds: settings.seeds,
            frames: settings.frames,
            effort: settings.effort,
            tier: settings.machine.simd.parse().into_diagnostic()?,
        };
        let volumes = header.inputs.get(VOLUMES);
        let volumes = volumes.ok_or_else(|| miette!("the header has no digest of volumes"))?;
        Ok(Self { plan, units: Vec::new(), volumes_sha256: volumes.clone() })
    }

    /// Reads a unit's result; units come in their order.
    ///
    /// # Errors
    /// The text is not the result of a unit.
    pub fn take(&mut self, result: &str) -> miette::Result<()> {
        self.units.push(serde_json::from_str(result).into_diagnostic()?);
        Ok(())
    }

    /// One run per seed, scene and strategy.
    pub fn runs(&self) -> impl Iterator<Item = &StrategyRun> {
        self.units.iter().flat_map(|unit| &unit.runs)
    }

    /// One value a seed of a strategy in a scene, in the order of seeds.
    #[must_use]
    pub fn by_seed(
        &self,
        scene: &str,
        strategy: Strategy,
        value: impl Fn(&StrategyRun) -> f64,
    ) -> Vec<f64> {
        let of = |run: &&StrategyRun| run.scene == scene && run.strategy == strategy;
        self.runs().filter(of).map(value).collect()
    }

    /// Any run of a scene, for what all of them share.
    #[must_use]
    pub fn example(&self, scene: &str) -> Option<&StrategyRun> {
        self.runs().find(|run| run.scene == scene)
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
        let of = self.units.iter().filter(|unit| unit.name == scene);
        of.map(|unit| &unit.pass).collect()
    }

    /// The passes whose rounds calibrated scenes of the same kind as this one, in the order of
    /// time. Such scenes share their prices.
    #[must_use]
    pub fn priced_as(&self, scene: PaperScene) -> Vec<&Pass> {
        let level = |pass: &Pass| Some(pass.prices[0].first()?.level);
        let own = self.passes_of(scene).first().map(|pass| level(pass));
        let passes = self.units.iter().map(|unit| &unit.pass);
        passes.filter(|pass| Some(level(pass)) == own).collect()
    }

    /// The cost of every strategy in every scene; the control costs nothing that the formula has a
    /// term for.
    #[must_use]
    pub fn costs(&self, regime: Regime) -> Vec<Cost> {
        let mut costs = Vec::new();
        for &scene in &self.plan.names {
            let Some(unit) = self.units.iter().find(|unit| unit.name == scene) else {
                continue;
            };
            let passes = (&self.passes_of(scene)[..], &self.priced_as(scene)[..]);
            for of in unit.variants.iter().enumerate() {
                let bodies = unit.runs.first().map_or(0, |run| run.bodies);
                costs.extend(table::cost((scene.name(), bodies), of, passes, regime));
            }
        }
        costs
    }
}
