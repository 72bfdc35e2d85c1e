//! The experiments divided into units: a scene with one seed, the survivors of one seed, or one
//! interpretation of what the paper leaves open. Joined in their order, they give the results of
//! one process: the same counts to the bit, and the times as they were measured.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use miette::{IntoDiagnostic as _, miette};
use serde::{Deserialize, Serialize};

use super::experiment::{Results, StrategyRun, run_pass, variants};
use super::immediate::{self, HandingTimes};
use super::plan::{ExperimentPlan, PaperScene, ReproduceError, STRATEGIES, SURVIVAL_SCENE};
use super::sensitivity::{self, TestCounts};
use super::survival::Survival;
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
    interpretations: bool,
    /// The machine.
    pub machine: Machine,
}

/// The experiments, ready to run.
pub struct Experiments {
    plan: ExperimentPlan,
    interpretations: bool,
    compared: SceneFile,
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

/// One unit.
enum ReproduceUnit {
    /// A scene, by its number, with a seed.
    Scene(usize, u64),
    /// The survivors of a seed.
    Survival(u64),
    /// A way to read the paper, by its number.
    Reading(usize),
}

/// What a unit found.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum UnitResult {
    /// A scene with one seed.
    Scene {
        /// Which.
        name: PaperScene,
        /// A run a strategy.
        runs: Vec<StrategyRun>,
        /// What they were taken from.
        pass: Pass,
        /// The strategies as variants.
        variants: Vec<Variant>,
        /// The paper's algorithm to the letter.
        immediacy: Option<HandingTimes>,
    },
    /// A share an or-DOP and test.
    Survival(Vec<f64>),
    /// What is counted under a reading, by its number.
    Reading(usize, Vec<TestCounts>),
}

impl Experiments {
    /// Reads and builds the plan's scenes. With `interpretations`, what the paper doesn't state is
    /// swept too.
    ///
    /// # Errors
    /// Scene files that can't be read or built.
    pub fn new(plan: &ExperimentPlan, interpretations: bool) -> Result<Self, ReproduceError> {
        let load = |scene: PaperScene| {
            SceneFile::read(&plan.scenes.join(scene.name()).with_extension("toml"))
        };
        let compared = load(SURVIVAL_SCENE)?;
        let mut inputs = BTreeMap::new();
        let volumes = volumes_sha256(&compared.build()?.shapes);
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
            interpretations,
            compared,
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
            interpretations: self.interpretations,
            machine: Machine::here(self.plan.tier),
        }
    }

    /// How many units there are.
    #[must_use]
    pub fn units(&self) -> usize {
        let readings = if self.interpretations { sensitivity::ways().len() } else { 0 };
        self.plan.steps() + readings
    }

    fn unit(&self, unit: usize) -> ReproduceUnit {
        let of_seed = self.prepared.len() + 1;
        match self.plan.seeds.get(unit / of_seed) {
            Some(&seed) if unit % of_seed < self.prepared.len() => {
                ReproduceUnit::Scene(unit % of_seed, seed)
            }
            Some(&seed) => ReproduceUnit::Survival(seed),
            None => ReproduceUnit::Reading(unit - self.plan.steps()),
        }
    }

    /// Runs a unit.
    ///
    /// # Errors
    /// Scenes that can't be built with the seed or don't suit the strategies.
    pub fn find(&self, unit: usize) -> Result<UnitResult, ReproduceError> {
        match self.unit(unit) {
            ReproduceUnit::Scene(number, seed) => self.scene(&self.prepared[number], seed),
            ReproduceUnit::Survival(seed) => {
                let scene = with_seed(&self.compared, seed)?;
                let share = |row: Survival| row.share(&scene, self.plan.tier);
                let shares = Survival::every().into_iter().map(share);
                Ok(UnitResult::Survival(shares.collect::<Result<_, _>>()?))
            }
            ReproduceUnit::Reading(number) => {
                let counted = sensitivity::counted(&self.plan, sensitivity::ways()[number])?;
                Ok(UnitResult::Reading(number, counted))
            }
        }
    }

    fn scene(&self, prepared: &PreparedScene, seed: u64) -> Result<UnitResult, ReproduceError> {
        let PreparedScene { name, file, largest, variants } = prepared;
        let ExperimentPlan { frames, tier, effort, .. } = self.plan;
        let held = self.calibrations.lock();
        let mut held = held.unwrap_or_else(PoisonError::into_inner);
        let mut calibration = match held.remove(name) {
            Some(calibration) => calibration,
            None => Calibration::new(&file.build()?, variants, tier, effort)?,
        };
        let scene = with_seed(file, seed)?;
        let (runs, pass) = run_pass(&scene, variants, frames, tier, Some(calibration.round()?))?;
        held.insert(*name, calibration);
        let immediacy = largest.then(|| immediate::measure(&scene, *name, tier));
        Ok(UnitResult::Scene {
            name: *name,
            runs,
            pass,
            variants: variants.clone(),
            immediacy: immediacy.transpose()?,
        })
    }
}

fn with_seed(file: &SceneFile, seed: u64) -> Result<Scene, ReproduceError> {
    let mut file = file.clone();
    file.spec.seed = seed;
    Ok(file.build()?)
}

impl Sweep for Experiments {
    fn header(&self) -> miette::Result<Header> {
        let inputs = self.inputs.clone();
        Header::new(NAME, &self.settings(), inputs, self.units()).into_diagnostic()
    }

    fn name(&self, unit: usize) -> String {
        match self.unit(unit) {
            ReproduceUnit::Scene(number, seed) => {
                format!("{}, seed {seed}", self.prepared[number].name)
            }
            ReproduceUnit::Survival(seed) => format!("survivors of seed {seed}"),
            ReproduceUnit::Reading(number) => {
                let (start, bounce) = sensitivity::ways()[number];
                format!("Table 1 with start: {start}, bounce: {bounce}")
            }
        }
    }

    fn run(&self, unit: usize) -> miette::Result<String> {
        serde_json::to_string(&self.find(unit)?).into_diagnostic()
    }

    fn timed(&self, _: usize) -> bool {
        true
    }
}

impl ExperimentPlan {
    /// Runs everything except the interpretations, in this process. `done` is called as often as
    /// [`ExperimentPlan::steps`] says.
    ///
    /// # Errors
    /// Scene files that can't be read or don't suit the strategies.
    pub fn run(&self, mut done: impl FnMut()) -> Result<Results, ReproduceError> {
        let experiments = Experiments::new(self, false)?;
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
            survival: Survival::every(),
            interpretations: Vec::new(),
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
        match found {
            UnitResult::Scene { name, runs, pass, variants, immediacy } => {
                self.runs.extend(runs);
                self.passes.push((name, pass));
                self.immediacies.extend(immediacy);
                if self.variants.iter().all(|(known, _)| *known != name) {
                    self.variants.push((name, variants));
                }
            }
            UnitResult::Survival(shares) => {
                for (row, share) in self.survival.iter_mut().zip(shares) {
                    row.shares.push(share);
                }
            }
            UnitResult::Reading(number, counted) => {
                if let Some(&way) = sensitivity::ways().get(number) {
                    let found = sensitivity::interpretations(&self.plan, way, &counted);
                    self.interpretations.extend(found);
                    sensitivity::sort(&mut self.interpretations);
                }
            }
        }
    }
}
