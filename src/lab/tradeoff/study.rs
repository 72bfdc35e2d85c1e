//! The whole comparison of one scene, seed by seed.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::budget::{self, BudgetRow, ClockRow, Window};
use super::counts::{Tally, share};
use super::density::{self, Density};
use super::interest::{self, InterestRow};
use super::pays::{self, Line, Stretch};
use super::safety::{self, SafetyRow};
use super::shapes::{self, ShapeSurvival};
use super::timing::{self, VariantPrices, VolumeTerms};
use super::truth::{Judge, NarrowPhase, Sample, Truth, samples};
use super::variant::{self, Variant};
use super::{Estimate, TradeoffError};
use crate::culler::Culler;
use crate::lab::cost::calibrate::Effort;
use crate::lab::scene::{Scene, SceneFile};
use crate::simd::Tier;
use crate::volume::Shape;

/// How much is done.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Seeds from the scene's on; a run each.
    pub seeds: u64,
    /// Judged frames a run.
    pub samples: u32,
    /// Random pairs a shape.
    pub pairs: u32,
    /// Consecutive frames for time-critical culling.
    pub window: u32,
    /// Every so many of them are judged.
    pub stride: usize,
    /// The SIMD tier.
    pub tier: Tier,
    /// Where truths are kept.
    pub cache: Option<PathBuf>,
}

/// One variant's result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// What tables call it.
    pub name: String,
    /// The strategy.
    pub strategy: String,
    /// The volume that decides last.
    pub volume: String,
    /// Half-spaces, where the strategy has or-DOPs or k-DOPs.
    pub k: Option<usize>,
    /// The or-DOP's axes, where it has or-DOPs.
    pub axes: Option<String>,
    /// The overlap test, where it has or-DOPs.
    pub overlap: Option<String>,
    /// Pairs reported a frame.
    pub reported: Estimate,
    /// True pairs / reported pairs.
    pub precision: Estimate,
    /// Reported pairs / true pairs.
    pub per_true: Estimate,
    /// True pairs found / true pairs, over all seeds.
    pub recall: f64,
    /// Mean volume over hull volume; none when a hull is flat.
    pub volume_over_hull: Option<f64>,
    /// Counts and prices of each volume; means over seeds.
    pub volumes: Vec<VolumeTerms>,
    /// T = Nu·Cu + Nv·Cv + Co over the run, predicted, seconds a frame.
    pub predicted: f64,
    /// Measured seconds a frame, construction not included.
    pub seconds: Estimate,
    /// On the Pareto front of time and precision.
    pub front: bool,
    /// The hash of the pairs reported on the sample frames, a seed.
    pub pairs_sha256: Vec<String>,
}

/// Everything about one scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tradeoff {
    /// The scene.
    pub scene: String,
    /// Its bodies.
    pub bodies: usize,
    /// Frames of its run.
    pub frames: u32,
    /// Judged frames of each run.
    pub samples: usize,
    /// The runs' seeds.
    pub seeds: Vec<u64>,
    /// The SIMD tier.
    pub simd: String,
    /// True pairs a frame.
    pub truth: Estimate,
    /// Sphere overlaps a body.
    pub partners: f64,
    /// The exact reference as narrow phase.
    pub narrow_phase: NarrowPhase,
    /// Every variant.
    pub rows: Vec<Row>,
    /// The cheapest variant as Cp grows.
    pub cheapest: Vec<Stretch>,
    /// The scene at other densities.
    pub densities: Vec<Density>,
    /// Time-critical culling by tests.
    pub budgets: Vec<BudgetRow>,
    /// Time-critical culling by the clock.
    pub clock: Vec<ClockRow>,
    /// Interest sets.
    pub interest: Vec<InterestRow>,
    /// The scene's shapes and some of known form, each against itself.
    pub shapes: Vec<ShapeSurvival>,
    /// Margins, arithmetic and tiers.
    pub safety: Vec<SafetyRow>,
    /// What to do.
    pub advice: String,
}

impl Tradeoff {
    /// The variants that missed a true pair.
    pub fn failures(&self) -> impl Iterator<Item = &str> {
        let rows = self.rows.iter().filter(|row| row.recall != 1.0);
        let budgets = self.budgets.iter().filter(|row| row.recall != 1.0);
        let interest = self.interest.iter().filter(|row| row.quality.recall != 1.0);
        rows.map(|row| row.name.as_str())
            .chain(budgets.map(|row| row.order.as_str()))
            .chain(interest.map(|_| "s-dop of interest"))
    }
}

/// One seed's run.
struct Run {
    scene: Scene,
    samples: Vec<Sample>,
    truth: Truth,
    tallies: Vec<Tally>,
    seconds: Vec<f64>,
}

/// Compares everything on one scene. `step` hears what is being done, often.
///
/// # Errors
/// A scene that can't be built, run or judged; a cache that can't be written.
pub fn study(
    file: &SceneFile,
    plan: &Plan,
    step: &mut dyn FnMut(&'static str),
) -> Result<Tradeoff, TradeoffError> {
    let mut runs = Vec::new();
    for seed in 0..plan.seeds.max(1) {
        step("truth");
        runs.push(judged_run(file, plan, file.spec.seed.wrapping_add(seed))?);
    }
    let hits = sphere_hits(&runs[0], plan.tier)?;
    let variants = variant::all(&runs[0].scene, hits.round() as u64);
    for run in &mut runs {
        for variant in &variants {
            step("counts");
            let tally = Tally::of(&run.scene, variant, plan.tier, &run.samples, &run.truth)?;
            run.tallies.push(tally);
        }
    }
    for run in &mut runs {
        let (scene, samples) = (&run.scene, &run.samples);
        run.seconds = timing::measure(scene, &variants, plan.tier, samples, 2, || step("time"))?;
    }
    let first = &runs[0];
    let effort = Effort {
        frames: 6,
        builds: 1,
    };
    let prices = timing::prices(&first.scene, &variants, plan.tier, effort, || {
        step("prices")
    })?;
    let rows = rows(&variants, &runs, &prices);
    finish(file, plan, first, &runs, rows, hits, step)
}

/// How many times [`study`] calls `step`.
///
/// # Errors
/// A scene that can't be built.
pub fn steps(file: &SceneFile, plan: &Plan) -> Result<u64, TradeoffError> {
    let scene = file.build()?;
    let variants = variant::all(&scene, 1).len() as u64;
    let samples = u64::from(plan.samples.clamp(1, scene.frames));
    let runs = plan.seeds.max(1);
    Ok(runs * (1 + variants + variants * samples) + variants + density::steps() + 5)
}

fn judged_run(file: &SceneFile, plan: &Plan, seed: u64) -> Result<Run, TradeoffError> {
    let mut file = file.clone();
    file.spec.seed = seed;
    let scene = file.build()?;
    let samples = samples(&scene, plan.samples)?;
    let truth = Judge::new(&scene.shapes)?.truth(&samples, plan.cache.as_deref())?;
    Ok(Run {
        scene,
        samples,
        truth,
        tallies: Vec::new(),
        seconds: Vec::new(),
    })
}

/// Mean sphere hits a frame.
fn sphere_hits(run: &Run, tier: Tier) -> Result<f64, TradeoffError> {
    let spheres = Variant::spheres(&run.scene.cull);
    let tally = Tally::of(&run.scene, &spheres, tier, &run.samples, &run.truth)?;
    Ok(tally.reported as f64 / f64::from(tally.frames))
}

fn rows(variants: &[Variant], runs: &[Run], prices: &[VariantPrices]) -> Vec<Row> {
    let mut rows: Vec<Row> = variants
        .iter()
        .enumerate()
        .map(|(at, variant)| row(variant, at, runs, &prices[at]))
        .collect();
    let points: Vec<_> = rows
        .iter()
        .map(|row| (row.seconds.mean, row.precision.mean))
        .collect();
    for (row, front) in rows.iter_mut().zip(pays::front(&points)) {
        row.front = front && row.recall == 1.0;
    }
    rows
}

fn row(variant: &Variant, at: usize, runs: &[Run], prices: &VariantPrices) -> Row {
    let over_runs = |value: &dyn Fn(&Run, &Tally) -> f64| {
        let values: Vec<f64> = runs
            .iter()
            .map(|run| value(run, &run.tallies[at]))
            .collect();
        Estimate::of(&values)
    };
    let scene = &runs[0].scene;
    let settings = &variant.settings;
    let ordop = variant.volume() == "or-dop";
    let terms: Vec<Vec<VolumeTerms>> = runs
        .iter()
        .map(|run| prices.terms(variant, &run.tallies[at], scene.bodies.len()))
        .collect();
    let volumes = timing::mean(&terms);
    let recurring: f64 = volumes.iter().map(VolumeTerms::recurring).sum();
    let construct: f64 = volumes.iter().map(|v| v.co).sum();
    let total =
        |count: fn(&Tally) -> u64| runs.iter().map(|run| count(&run.tallies[at])).sum::<u64>();
    Row {
        name: variant.name.clone(),
        strategy: settings.strategy.to_string(),
        volume: variant.volume().to_owned(),
        k: (ordop || variant.volume() == "k-dop").then(|| settings.k.k()),
        axes: ordop.then(|| settings.axes.to_string()),
        overlap: ordop.then(|| settings.overlap.to_string()),
        reported: over_runs(&|_, t| t.reported as f64 / f64::from(t.frames)),
        precision: over_runs(&|_, t| t.quality().precision),
        per_true: over_runs(&|_, t| t.quality().per_true),
        recall: share(total(|t| t.found), total(|t| t.truth)),
        volume_over_hull: variant.tightness(scene),
        volumes,
        predicted: recurring + construct / f64::from(scene.frames),
        seconds: over_runs(&|run, _| run.seconds[at]),
        front: false,
        pairs_sha256: runs
            .iter()
            .map(|run| run.tallies[at].pairs_sha256.clone())
            .collect(),
    }
}

fn finish(
    file: &SceneFile,
    plan: &Plan,
    first: &Run,
    runs: &[Run],
    rows: Vec<Row>,
    hits: f64,
    step: &mut dyn FnMut(&'static str),
) -> Result<Tradeoff, TradeoffError> {
    let (scene, tier) = (&first.scene, plan.tier);
    let judge = Judge::new(&scene.shapes)?;
    step("narrow phase");
    let narrow_phase = narrow_phase(&judge, first, tier)?;
    step("budgets");
    let window = first_frames(scene, plan.window)?;
    let window = Window {
        frames: &window,
        stride: plan.stride,
    };
    let budgets = budget::by_tests(scene, tier, window, &judge, plan.cache.as_deref(), hits)?;
    let clock = budget::by_clock(scene, tier, window)?;
    step("interest");
    let interest = interest::sweep(scene, tier, &first.samples, &first.truth)?;
    let densities = density::sweep(file, tier, plan.samples.min(6), || step("density"))?;
    step("safety");
    let safety = safety::compare(scene, &first.samples)?;
    step("shapes");
    let builtin = shapes::builtin()?;
    let shapes = distinct(scene)
        .chain(&builtin)
        .map(|shape| shapes::survival(shape, plan.pairs, tier))
        .collect::<Result<Vec<_>, _>>()?;
    let lines: Vec<Line> = rows.iter().map(line).collect();
    let cheapest = pays::envelope(&lines);
    Ok(Tradeoff {
        scene: scene.name.clone(),
        bodies: scene.bodies.len(),
        frames: scene.frames,
        samples: first.samples.len(),
        seeds: runs.iter().map(|run| run.scene.seed).collect(),
        simd: tier.name().to_owned(),
        truth: true_pairs(runs),
        partners: 2.0 * hits / scene.bodies.len() as f64,
        advice: pays::advice(&cheapest, &narrow_phase),
        narrow_phase,
        rows,
        cheapest,
        densities,
        budgets,
        clock,
        interest,
        shapes,
        safety,
    })
}

/// Consecutive frames from the first on.
fn first_frames(scene: &Scene, count: u32) -> Result<Vec<Sample>, TradeoffError> {
    let scene = Scene {
        frames: count.min(scene.frames),
        ..scene.clone()
    };
    Ok(samples(&scene, count)?)
}

/// Pairs a frame whose meshes meet.
fn true_pairs(runs: &[Run]) -> Estimate {
    let meetings = |run: &Run| run.truth.iter().map(Vec::len).sum::<usize>() as f64;
    let a_frame = |run: &Run| meetings(run) / run.samples.len() as f64;
    Estimate::of(&runs.iter().map(a_frame).collect::<Vec<_>>())
}

fn line(row: &Row) -> Line {
    Line {
        name: row.name.clone(),
        time: row.seconds.mean,
        pairs: row.reported.mean,
    }
}

/// Times the exact narrow phase on pairs whose spheres overlap.
fn narrow_phase(judge: &Judge, run: &Run, tier: Tier) -> Result<NarrowPhase, TradeoffError> {
    let settings = Variant::spheres(&run.scene.cull).settings;
    let bodies = &run.samples[0].bodies;
    let mut culler = Culler::new(&run.scene.shapes, bodies, &settings, tier)?;
    Ok(judge.price(bodies, culler.cull(bodies).iter(), 2000)?)
}

/// One shape a mesh name: sizes of one mesh let the same shares through.
fn distinct(scene: &Scene) -> impl Iterator<Item = &Shape> {
    let shapes = &scene.shapes;
    let first = |name: &str| shapes.iter().position(|shape| shape.name == name);
    shapes
        .iter()
        .enumerate()
        .filter(move |(at, shape)| first(&shape.name) == Some(*at))
        .map(|(_, shape)| shape)
}
