//! A comparison divided into units: counts, which depend only on the scene and can be taken on any
//! machine, and times, which need a machine without other load. Joined in their order, they give
//! the results of one process: the same counts to the bit, and the times of the machine that
//! measured them.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use miette::IntoDiagnostic as _;
use serde::{Deserialize, Serialize};

use super::TradeoffError;
use super::budget::{self, BudgetRow, Window};
use super::counts::Tally;
use super::density;
use super::findings::{ComparedVariants, Findings, SeedCounts};
use super::interest;
use super::timing::{PASSES, Windows};
use super::truth::{ExactJudge, Sample, samples};
use super::variant::{self, Variant};
use super::worlds;
use crate::cost::calibrate::{Calibration, Effort};
use crate::cost::pass::{Pass, pass};
use crate::measure::machine::Machine;
use crate::measure::turns::FEWEST_TIMED_FRAMES;
use crate::scene::{Scene, SceneFile};
use crate::sweep::{Header, Sweep, digest};
use sdop::simd::Tier;

/// The name in its files.
pub const NAME: &str = "tradeoff";

/// Pairs on which the narrow phase is timed.
const CHECKED_PAIRS: usize = 2000;
/// Sample frames of a changed scene.
const CHANGED_SAMPLES: u32 = 6;
/// The calibration of a pass.
const EFFORT: Effort = Effort { turns: 1, builds: 5 };

/// The amount of work.
#[derive(Clone, Debug)]
pub struct TradeoffPlan {
    /// Number of seeds from the scene's on, with one run each.
    pub seeds: u64,
    /// Judged frames per run.
    pub samples: u32,
    /// Consecutive frames for time-critical culling.
    pub window: u32,
    /// One in this number of them is judged.
    pub stride: usize,
    /// The SIMD tier.
    pub tier: Tier,
    /// The directory in which truths are stored.
    pub cache: Option<PathBuf>,
}

/// What is compared, how thoroughly, and on what kind of machine: times of different machines can't
/// be joined.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// The scene's name.
    pub scene: String,
    /// Its bodies.
    pub bodies: usize,
    /// Frames of its run.
    pub frames: u32,
    /// The runs' seeds.
    pub seeds: Vec<u64>,
    samples: u32,
    window: u32,
    stride: usize,
    /// The machine.
    pub machine: Machine,
}

/// A comparison, ready to run.
pub struct Comparison {
    file: SceneFile,
    plan: TradeoffPlan,
    /// The scene of the first seed.
    scene: Scene,
    /// Mean sphere hits per frame.
    hits: f64,
    variants: Vec<Variant>,
    units: Vec<TradeoffUnit>,
    /// `None` before the first pass in this process.
    calibration: Mutex<Option<Calibration>>,
}

/// One unit.
#[derive(Clone, Copy, Debug)]
enum TradeoffUnit {
    /// The variants.
    Compared,
    /// The truth of the run of a seed, and every variant's counts.
    Seed(u64),
    /// Time-critical culling by tests.
    Budgets,
    /// Every variant timed once, on the run of a seed.
    Pass(u64),
    /// The price of the exact narrow phase.
    NarrowPhase,
    /// Time-critical culling by the clock.
    Clock,
    /// Culling of interest.
    Interest,
    /// Cullers beside worlds.
    Worlds,
    /// The scene at a multiple of its density.
    Density(f32),
}

impl Comparison {
    /// Builds the scene and the comparison.
    ///
    /// # Errors
    /// The scene can't be built, run or culled.
    pub fn new(file: &SceneFile, plan: &TradeoffPlan) -> Result<Self, TradeoffError> {
        let mut file = file.clone();
        file.spec.frames = file.spec.frames.max(FEWEST_TIMED_FRAMES);
        let scene = Scene { construct_seconds: 0.0, ..file.build()? };
        let spheres = Variant::spheres(&scene.cull);
        let samples = samples(&scene, plan.samples)?;
        let hits = Tally::unjudged(&scene, &spheres, plan.tier, &samples)?.reported_a_frame();
        Ok(Self {
            plan: plan.clone(),
            variants: variant::all(&scene.cull, hits.round() as u64),
            units: units(&seeds(&file, plan), scene.effects.rest.is_some()),
            file,
            scene,
            hits,
            calibration: Mutex::default(),
        })
    }

    /// The settings, of this machine.
    #[must_use]
    pub fn settings(&self) -> Settings {
        let TradeoffPlan { samples, window, stride, tier, .. } = self.plan;
        Settings {
            scene: self.scene.name.clone(),
            bodies: self.scene.bodies.len(),
            frames: self.scene.frames,
            seeds: seeds(&self.file, &self.plan),
            samples,
            window,
            stride,
            machine: Machine::here(tier),
        }
    }

    /// What a unit finds: findings with one part.
    fn find(&self, unit: TradeoffUnit) -> Result<Findings, TradeoffError> {
        let (file, scene, tier) = (&self.file, &self.scene, self.plan.tier);
        let mut found = Findings::default();
        match unit {
            TradeoffUnit::Compared => found.compared = Some(self.compared()),
            TradeoffUnit::Seed(seed) => found.seeds.push(self.counts(seed)?),
            TradeoffUnit::Budgets => found.budgets = self.budgets()?,
            TradeoffUnit::Pass(seed) => found.passes.push(self.pass(seed)?),
            TradeoffUnit::NarrowPhase => {
                let judge = ExactJudge::new(&scene.shapes)?;
                let price = judge.price_of_spheres(scene, &scene.bodies, tier, CHECKED_PAIRS)?;
                found.narrow_phase = Some(price);
            }
            TradeoffUnit::Clock => {
                let frames = self.plan.window.min(scene.frames);
                found.clock = budget::by_clock(scene, tier, frames)?;
            }
            TradeoffUnit::Interest => {
                found.interest = interest::times(scene, tier, self.plan.samples)?;
            }
            TradeoffUnit::Worlds => found.worlds = worlds::times(scene, &self.variants, tier)?,
            TradeoffUnit::Density(factor) => {
                let samples = self.plan.samples.min(CHANGED_SAMPLES);
                found.densities.extend(density::at(file, factor, tier, samples)?);
            }
        }
        Ok(found)
    }

    fn compared(&self) -> ComparedVariants {
        let volume = |own| variant::tightness(own, &self.scene);
        ComparedVariants {
            hits: self.hits,
            variants: self.variants.clone(),
            volumes: self.variants.iter().map(volume).collect(),
        }
    }

    fn counts(&self, seed: u64) -> Result<SeedCounts, TradeoffError> {
        let scene = with_seed(&self.file, seed)?;
        let samples = samples(&scene, self.plan.samples)?;
        let truth = ExactJudge::new(&scene.shapes)?.truth(&samples, self.plan.cache.as_deref())?;
        let tally = |variant| Tally::of(&scene, variant, self.plan.tier, &samples, &truth);
        let interest = if seed == self.scene.seed {
            interest::counts(&scene, self.plan.tier, &samples, &truth)?
        } else {
            Vec::new()
        };
        Ok(SeedCounts {
            tallies: self.variants.iter().map(tally).collect::<Result<_, _>>()?,
            interest,
        })
    }

    fn budgets(&self) -> Result<Vec<BudgetRow>, TradeoffError> {
        let TradeoffPlan { window, stride, tier, ref cache, .. } = self.plan;
        let judge = ExactJudge::new(&self.scene.shapes)?;
        let frames = first_frames(&self.scene, window)?;
        let window = Window { frames: &frames, stride };
        budget::by_tests(&self.scene, tier, window, &judge, cache.as_deref(), self.hits)
    }

    fn pass(&self, seed: u64) -> Result<Pass, TradeoffError> {
        let tier = self.plan.tier;
        let held = self.calibration.lock();
        let mut held = held.unwrap_or_else(PoisonError::into_inner);
        let mut calibration = match held.take() {
            Some(calibration) => calibration,
            None => Calibration::new(&self.scene, &self.variants, tier, EFFORT)?,
        };
        let scene = with_seed(&self.file, seed)?;
        let mut frames = Windows::new(&scene, self.plan.samples)?;
        let own = Some(calibration.round()?);
        let pass = pass(&scene, &self.variants, tier, &mut frames, own, &mut ())?;
        *held = Some(calibration);
        Ok(pass)
    }
}

/// All units: first counts, then times.
fn units(seeds: &[u64], has_rest: bool) -> Vec<TradeoffUnit> {
    // One pass per seed, and not too few.
    let passes = seeds.iter().cycle().take(seeds.len().max(PASSES));
    let once = [TradeoffUnit::NarrowPhase, TradeoffUnit::Clock, TradeoffUnit::Interest];
    let mut units = vec![TradeoffUnit::Compared];
    units.extend(seeds.iter().copied().map(TradeoffUnit::Seed));
    units.push(TradeoffUnit::Budgets);
    units.extend(passes.copied().map(TradeoffUnit::Pass));
    units.extend(once);
    units.extend(has_rest.then_some(TradeoffUnit::Worlds));
    units.extend(density::FACTORS.map(TradeoffUnit::Density));
    units
}

/// The runs' seeds, from the scene's on.
fn seeds(file: &SceneFile, plan: &TradeoffPlan) -> Vec<u64> {
    let seed = |number| file.spec.seed.wrapping_add(number);
    (0..plan.seeds.max(1)).map(seed).collect()
}

fn with_seed(file: &SceneFile, seed: u64) -> Result<Scene, TradeoffError> {
    let mut file = file.clone();
    file.spec.seed = seed;
    Ok(file.build()?)
}

/// Consecutive frames from the first on.
fn first_frames(scene: &Scene, count: u32) -> Result<Vec<Sample>, TradeoffError> {
    let scene = Scene { frames: count.min(scene.frames), ..scene.clone() };
    Ok(samples(&scene, count)?)
}

impl Sweep for Comparison {
    fn header(&self) -> miette::Result<Header> {
        let scene = ("scene".to_owned(), digest(&(&self.file.spec, &self.scene)));
        let inputs = BTreeMap::from([scene]);
        Header::new(NAME, &self.settings(), inputs, self.units.len()).into_diagnostic()
    }

    fn name(&self, unit: usize) -> String {
        match self.units[unit] {
            TradeoffUnit::Compared => "what is compared".to_owned(),
            TradeoffUnit::Seed(seed) => format!("truth and counts of seed {seed}"),
            TradeoffUnit::Budgets => "budgets of tests".to_owned(),
            TradeoffUnit::Pass(seed) => format!("times on seed {seed}"),
            TradeoffUnit::NarrowPhase => "times of the narrow phase".to_owned(),
            TradeoffUnit::Clock => "budgets of time".to_owned(),
            TradeoffUnit::Interest => "times of interest sets".to_owned(),
            TradeoffUnit::Worlds => "times of worlds".to_owned(),
            TradeoffUnit::Density(factor) => format!("{factor} times the density"),
        }
    }

    fn run(&self, unit: usize) -> miette::Result<String> {
        serde_json::to_string(&self.find(self.units[unit])?).into_diagnostic()
    }

    fn timed(&self, unit: usize) -> bool {
        let counts = |unit| {
            matches!(unit, TradeoffUnit::Compared | TradeoffUnit::Seed(_) | TradeoffUnit::Budgets)
        };
        !counts(self.units[unit])
    }
}
