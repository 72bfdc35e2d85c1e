//! The runs: every scene with every seed, all strategies side by side on the same frames.

use std::path::{Path, PathBuf};
use std::time::Instant;

use miette::Diagnostic;
use serde::Serialize;
use thiserror::Error;

use crate::counters::{Counters, Seconds};
use crate::lab::cost::calibrate::{self, Effort, calibrate, construct};
use crate::lab::cost::predict::{Prices, Volume};
use crate::lab::hash::PairsHash;
use crate::lab::hash::volumes_sha256;
use crate::lab::measure::turns::{Trial, side_by_side};
use crate::lab::scene::{Scene, SceneError, SceneFile};
use crate::lab::simulate::SimulationError;
use crate::settings::{Overlap, Strategy};
use crate::simd::Tier;
use crate::volume::DirectionSet;

/// The paper's strategies, in the order of frame rates that it claims.
pub const STRATEGIES: [Strategy; 6] = [
    Strategy::None,
    Strategy::Sphere,
    Strategy::SDopObjectOfInterest,
    Strategy::SDopSequential,
    Strategy::SDopBatch,
    Strategy::OrDop,
];

/// The paper's scenes: its numbers of objects (350 in the text, 300 in Table 1) in one box, and 500 in a small box.
const SCENES: [&str; 6] = [
    "paper-50",
    "paper-150",
    "paper-300",
    "paper-350",
    "paper-500",
    "crowded-500",
];
/// The scene whose shapes are calibrated and whose or-DOPs are compared by k.
const CALIBRATED: &str = "paper-500";

/// What to run.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Where the scene files are.
    pub scenes: PathBuf,
    /// Their names, without extension.
    pub names: Vec<String>,
    /// One run of each scene a seed.
    pub seeds: Vec<u64>,
    /// Frames a run.
    pub frames: u32,
    /// How long to calibrate.
    pub effort: Effort,
    /// The tier that culls.
    pub tier: Tier,
}

/// One of n parts of a plan, which other machines may run: part i has every n-th seed, beginning with the i-th.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Shard {
    /// Counted from 1.
    pub index: usize,
    /// The number of parts.
    pub of: usize,
}

/// One strategy in one run.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
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
    /// Medians over frames; `construct` is Co of the strategy's volumes, built once for this run.
    pub seconds: Seconds,
    /// Mean seconds a frame, interruptions by other processes included.
    pub mean: f64,
    /// Median seconds of a simulation step.
    pub step: f64,
    /// Hash of all reported pairs; `None` for the control.
    pub pairs_sha256: Option<String>,
}

/// The share of sphere hits that an or-DOP test lets through, in the first frames of the calibrated scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Survival {
    /// The or-DOP.
    pub k: DirectionSet,
    /// Its test.
    pub overlap: Overlap,
    /// One share a seed.
    pub shares: Vec<f64>,
}

/// All that was run.
#[derive(Clone, Debug)]
pub struct Results {
    /// The plan.
    pub plan: Plan,
    /// What calibration found.
    pub prices: Prices,
    /// One run a seed, scene and strategy.
    pub runs: Vec<Run>,
    /// One an or-DOP and test.
    pub survival: Vec<Survival>,
    /// Hash of the calibrated scene's volumes.
    pub volumes_sha256: String,
}

/// Why an experiment can't be run.
#[derive(Debug, Error, Diagnostic)]
pub enum ReproduceError {
    /// A scene file that can't be read or built.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Scene(#[from] SceneError),
    /// A scene that can't be simulated or culled.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Simulation(#[from] SimulationError),
    /// A shard without seeds.
    #[error("shard {index} of {of} has none of the {seeds} seeds")]
    #[diagnostic(help("a shard is i/n with 1 ≤ i ≤ n, and n at most the number of seeds"))]
    Shard {
        /// As given.
        index: usize,
        /// As given.
        of: usize,
        /// The seeds there are.
        seeds: usize,
    },
}

impl Plan {
    /// The paper's scenes in the directory `scenes`, with seeds 1 … `seeds`.
    #[must_use]
    pub fn new(scenes: &Path, seeds: u64, frames: u32, effort: Effort, tier: Tier) -> Self {
        Self {
            scenes: scenes.to_owned(),
            names: SCENES.map(str::to_owned).to_vec(),
            seeds: (1..=seeds).collect(),
            frames,
            effort,
            tier,
        }
    }

    /// Keeps a shard's seeds.
    ///
    /// # Errors
    /// A shard that doesn't exist or has no seed.
    pub fn shard(mut self, shard: Shard) -> Result<Self, ReproduceError> {
        let Shard { index, of } = shard;
        if index == 0 || index > of || index > self.seeds.len() {
            return Err(ReproduceError::Shard {
                index,
                of,
                seeds: self.seeds.len(),
            });
        }
        self.seeds = self.seeds.into_iter().skip(index - 1).step_by(of).collect();
        Ok(self)
    }

    /// How many times [`Plan::run`] reports progress.
    #[must_use]
    pub fn steps(&self) -> usize {
        calibrate::SCENES + self.names.len() * self.seeds.len()
    }

    /// Runs everything. `done` hears what was finished: a calibration scene, a scene and seed.
    ///
    /// # Errors
    /// Scene files that can't be read or don't suit the strategies.
    pub fn run(&self, mut done: impl FnMut(&str)) -> Result<Results, ReproduceError> {
        let load = |name: &str| SceneFile::read(&self.scenes.join(name).with_extension("toml"));
        let mut calibrated = load(CALIBRATED)?;
        let scene = calibrated.build()?;
        let prices = calibrate(&scene, &STRATEGIES, self.tier, self.effort, |_| {
            done("calibration")
        })?;
        let files = self
            .names
            .iter()
            .map(|name| load(name))
            .collect::<Result<Vec<_>, _>>()?;
        let mut runs = Vec::new();
        let mut survival = Survival::every();
        for &seed in &self.seeds {
            for mut file in files.iter().cloned() {
                file.spec.seed = seed;
                let scene = file.build()?;
                runs.extend(run_scene(&scene, &STRATEGIES, self.frames, self.tier)?);
                done(&scene.name);
            }
            calibrated.spec.seed = seed;
            let scene = calibrated.build()?;
            for row in &mut survival {
                row.shares.push(row.share(&scene, self.tier)?);
            }
        }
        Ok(Results {
            plan: self.clone(),
            prices,
            runs,
            survival,
            volumes_sha256: volumes_sha256(&scene.shapes),
        })
    }
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
) -> Result<Vec<Run>, SimulationError> {
    let trial =
        |&strategy: &Strategy| Trial::new(scene, strategy, tier).map_err(SimulationError::from);
    let mut trials = strategies
        .iter()
        .map(trial)
        .collect::<Result<Vec<_>, _>>()?;
    let mut hashes = vec![PairsHash::default(); trials.len()];
    let step = side_by_side(scene, &mut trials, frames, |trial, frame, pairs| {
        hashes[trial].frame(frame, &pairs.sorted());
    })?;
    let bodies = &scene.bodies;
    let radius = |&shape: &u32| f64::from(scene.shapes[shape as usize].ball.radius);
    let run = |(trial, hash): (&Trial, PairsHash)| {
        let strategy = trial.strategy();
        let mut seconds = trial.medians();
        seconds.construct += build(scene, strategy);
        Run {
            scene: scene.name.clone(),
            bodies: bodies.len(),
            statics: bodies.dynamic.iter().filter(|&&dynamic| !dynamic).count(),
            side: f64::from(scene.side.unwrap_or(f32::INFINITY)),
            radius: bodies.shape.iter().map(radius).sum::<f64>() / bodies.len() as f64,
            seed: scene.seed,
            frames,
            strategy,
            counters: *trial.counters(),
            seconds,
            mean: trial.sums().total / f64::from(frames),
            step,
            pairs_sha256: (strategy != Strategy::None).then(|| hash.finish()),
        }
    };
    Ok(trials.iter().zip(hashes).map(run).collect())
}

/// Seconds to build a strategy's volumes of all shapes, once.
fn build(scene: &Scene, strategy: Strategy) -> f64 {
    let start = Instant::now();
    for &volume in Volume::of(strategy) {
        for shape in &scene.shapes {
            construct(volume, shape, scene.cull.axes);
        }
    }
    start.elapsed().as_secs_f64()
}

impl Survival {
    fn every() -> Vec<Self> {
        let with = |&k: &DirectionSet| {
            let row = move |&overlap: &Overlap| Self {
                k,
                overlap,
                shares: Vec::new(),
            };
            Overlap::ALL.iter().map(row)
        };
        DirectionSet::ALL.iter().flat_map(with).collect()
    }

    /// or-DOP hits among the sphere hits of the scene's first frame.
    fn share(&self, scene: &Scene, tier: Tier) -> Result<f64, SimulationError> {
        let mut scene = scene.clone();
        let turned = scene
            .shapes
            .into_iter()
            .map(|shape| shape.with_directions(self.k));
        scene.shapes = turned.collect();
        (scene.cull.k, scene.cull.overlap) = (self.k, self.overlap);
        let mut trial = Trial::new(&scene, Strategy::SDopBatch, tier)?;
        trial.frame(&scene.bodies);
        let ordop = trial.counters().ordop;
        Ok(ordop.hits as f64 / ordop.tests as f64)
    }
}

impl Results {
    /// One value a seed of a strategy in a scene, in the order of seeds.
    #[must_use]
    pub fn by_seed(
        &self,
        scene: &str,
        strategy: Strategy,
        value: impl Fn(&Run) -> f64,
    ) -> Vec<f64> {
        let of = |run: &&Run| run.scene == scene && run.strategy == strategy;
        self.runs.iter().filter(of).map(value).collect()
    }

    /// Any run of a scene, for what all of them share.
    #[must_use]
    pub fn example(&self, scene: &str) -> Option<&Run> {
        self.runs.iter().find(|run| run.scene == scene)
    }

    /// The scenes that share the paper's one box, by number of bodies.
    pub fn paper_scenes(&self) -> impl Iterator<Item = &str> {
        self.plan
            .names
            .iter()
            .map(String::as_str)
            .filter(|name| !name.starts_with("crowded"))
    }
}
