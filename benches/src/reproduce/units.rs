//! The experiments divided into units, each a scene with one seed. Joined in their order, they give
//! the results of one process: the same counts to the bit, and the times as they were measured.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use miette::{IntoDiagnostic as _, miette};
use serde::{Deserialize, Serialize};

use super::experiment::{Results, StrategyRun, run_pass, variants};
use super::immediate::{self, HandingTimes};
use super::plan::{ExperimentPlan, PaperScene, ReproduceError, STRATEGIES};
use crate::cost::calibrate::{Calibration, Effort};
use crate::cost::pass::Pass;
use crate::hash::volumes_sha256;
use crate::measure::machine::Machine;
use crate::measure::variant::Variant;
use crate::scene::{Scene, SceneFile};
use crate::sweep::{Header, Sweep, digest};

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

/// The result of a unit: a scene with one seed.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct UnitResult {
    /// The scene.
    pub name: PaperScene,
    /// One run per strategy.
    pub runs: Vec<StrategyRun>,
    /// The pass that they were taken from.
    pub pass: Pass,
    /// The strategies as variants.
    pub variants: Vec<Variant>,
    /// The paper's algorithm to the letter, in scenes with the most bodies.
    pub immediacy: Option<HandingTimes>,
}

impl Experiments {
    /// Reads and builds the plan's scenes.
    ///
    /// # Errors
    /// Scene files that can't be read or built.
    pub fn new(plan: &ExperimentPlan) -> Result<Self, ReproduceError> {
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

    /// Results of no unit.
    pub(super) fn nothing_yet(&self) -> Results {
        Results::none(self.plan.clone(), self.inputs[VOLUMES].clone())
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

    /// How many units there are.
    #[must_use]
    pub fn units(&self) -> usize {
        self.plan.steps()
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
    pub fn find(&self, unit: usize) -> Result<UnitResult, ReproduceError> {
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
        let inputs = self.inputs.clone();
        Header::new(NAME, &self.settings(), inputs, self.units()).into_diagnostic()
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

impl ExperimentPlan {
    /// Runs everything in this process. `done` is called as often as
    /// [`ExperimentPlan::steps`] says.
    ///
    /// # Errors
    /// Scene files that can't be read or don't suit the strategies.
    pub fn run(&self, mut done: impl FnMut()) -> Result<Results, ReproduceError> {
        let experiments = Experiments::new(self)?;
        let mut results = experiments.nothing_yet();
        for unit in 0..experiments.units() {
            results.add(experiments.find(unit)?);
            done();
        }
        Ok(results)
    }
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
        Ok(Self::none(plan, volumes.clone()))
    }

    fn none(plan: ExperimentPlan, volumes_sha256: String) -> Self {
        Self {
            plan,
            runs: Vec::new(),
            passes: Vec::new(),
            immediacies: Vec::new(),
            variants: Vec::new(),
            volumes_sha256,
        }
    }

    /// Takes a unit up; units come in their order.
    ///
    /// # Errors
    /// Text that no unit of these experiments gives.
    pub fn take(&mut self, result: &str) -> miette::Result<()> {
        self.add(serde_json::from_str(result).into_diagnostic()?);
        Ok(())
    }

    /// The same of what a unit found.
    pub(super) fn add(&mut self, found: UnitResult) {
        let UnitResult { name, runs, pass, variants, immediacy } = found;
        self.runs.extend(runs);
        self.passes.push((name, pass));
        self.immediacies.extend(immediacy);
        if self.variants.iter().all(|(known, _)| *known != name) {
            self.variants.push((name, variants));
        }
    }
}
