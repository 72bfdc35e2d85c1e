//! The whole comparison of one scene, seed by seed.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::budget::{self, BudgetRow, ClockRow, Window};
use super::counts::{Tally, share};
use super::decide::{self, Decision};
use super::density::{self, Density};
use super::interest::{self, InterestRow};
use super::pays::{self, Line, Point, Standing, Stretch};
use super::safety::{self, SafetyRow};
use super::shapes::{self, ShapeSurvival};
use super::timing::{PASSES, Windows};
use super::truth::{Judge, NarrowPhase, Sample, Truth, samples};
use super::variant::{self, Variant};
use super::{Estimate, TradeoffError};
use crate::culler::Culler;
use crate::lab::cost::calibrate::{Calibration, Effort};
use crate::lab::cost::pass::{Pass, pass};
use crate::lab::cost::table::{self, Cost, PriceRow};
use crate::lab::measure::conditions::Conditions;
use crate::lab::measure::counts::Volume;
use crate::lab::measure::turns::Regime;
use crate::lab::scene::{Scene, SceneFile};
use crate::settings::{Axes, Overlap, Strategy};
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
    pub strategy: Strategy,
    /// Whether hulls stand behind it.
    pub hulls: bool,
    /// The volume that decides last.
    pub volume: Option<Volume>,
    /// Half-spaces, where the strategy has or-DOPs or k-DOPs.
    pub k: Option<usize>,
    /// The or-DOP's axes, where it has or-DOPs.
    pub axes: Option<Axes>,
    /// The overlap test, where it has or-DOPs.
    pub overlap: Option<Overlap>,
    /// Pairs reported a frame.
    pub reported: Estimate,
    /// True pairs / reported pairs.
    pub precision: Estimate,
    /// The same, a seed each.
    pub precisions: Vec<f64>,
    /// Reported pairs / true pairs.
    pub per_true: Estimate,
    /// True pairs found / true pairs, over all seeds.
    pub recall: f64,
    /// Mean volume over hull volume; none when a hull is flat.
    pub volume_over_hull: Option<f64>,
    /// The formula beside the clock, warm frames.
    pub warm: Option<Cost>,
    /// The same, cold frames.
    pub cold: Option<Cost>,
    /// Seconds of a warm frame, a pass each in the order of time.
    pub times: Vec<f64>,
    /// How it stands to the Pareto front of time and precision.
    pub standing: Standing,
    /// The hash of the pairs reported on the sample frames, a seed.
    pub pairs_sha256: Vec<String>,
}

impl Row {
    /// Seconds of a warm frame, construction not included.
    #[must_use]
    pub fn seconds(&self) -> Estimate {
        Estimate::in_order(&self.times)
    }
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
    /// Prices of every variant's volumes, warm and cold.
    pub prices: Vec<PriceRow>,
    /// Which variant for which density, class of shapes and price of a check.
    pub decisions: Vec<Decision>,
    /// What else the machine did.
    pub conditions: Conditions,
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
            .chain(budgets.map(|row| row.order.name()))
            .chain(interest.map(|_| "s-dop of interest"))
    }
}

/// One seed's run.
struct Run {
    scene: Scene,
    samples: Vec<Sample>,
    truth: Truth,
    tallies: Vec<Tally>,
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
    let first = &runs[0];
    let before = Conditions::before();
    let effort = Effort {
        turns: 1,
        builds: 5,
    };
    let mut calibration = Calibration::new(&first.scene, &variants, plan.tier, effort)?;
    let mut passes = Vec::new();
    for number in 0..passes_of(plan) {
        let scene = &runs[number % runs.len()].scene;
        let mut frames = Windows::new(scene, plan.samples)?;
        step("time");
        let calibration = Some(&mut calibration);
        let pass = pass(
            scene,
            &variants,
            plan.tier,
            &mut frames,
            calibration,
            &mut |_, _, _| (),
        )?;
        passes.push(pass);
    }
    let rows = rows(&variants, &runs, &passes);
    let measured = Measured {
        prices: Regime::ALL
            .iter()
            .flat_map(|&regime| table::prices(&passes.iter().collect::<Vec<_>>(), regime))
            .collect(),
        conditions: before.after(rows.iter().map(Row::seconds)),
        rows,
        hits,
    };
    finish(file, plan, &runs, measured, step)
}

/// How many passes are timed: one a seed, three at least.
fn passes_of(plan: &Plan) -> usize {
    (plan.seeds as usize).max(PASSES)
}

/// What is known of the variants.
struct Measured {
    rows: Vec<Row>,
    prices: Vec<PriceRow>,
    conditions: Conditions,
    /// Mean sphere hits per frame.
    hits: f64,
}

/// How many times [`study`] calls `step`.
///
/// # Errors
/// A scene that can't be built.
pub fn steps(file: &SceneFile, plan: &Plan) -> Result<u64, TradeoffError> {
    let scene = file.build()?;
    let variants = variant::all(&scene, 1).len() as u64;
    let runs = plan.seeds.max(1);
    Ok(runs * (1 + variants) + passes_of(plan) as u64 + density::steps() + 5)
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
    })
}

/// Mean sphere hits a frame.
fn sphere_hits(run: &Run, tier: Tier) -> Result<f64, TradeoffError> {
    let spheres = Variant::spheres(&run.scene.cull);
    let tally = Tally::of(&run.scene, &spheres, tier, &run.samples, &run.truth)?;
    Ok(tally.reported as f64 / f64::from(tally.frames))
}

fn rows(variants: &[Variant], runs: &[Run], passes: &[Pass]) -> Vec<Row> {
    let mut rows: Vec<Row> = variants
        .iter()
        .enumerate()
        .map(|(at, variant)| row(variant, at, runs, passes))
        .collect();
    let point = |row: &Row| Point {
        times: row.times.clone(),
        precisions: row.precisions.clone(),
    };
    let points: Vec<Point> = rows.iter().map(point).collect();
    for (row, standing) in rows.iter_mut().zip(pays::standings(&points)) {
        row.standing = standing;
    }
    rows
}

fn row(variant: &Variant, at: usize, runs: &[Run], passes: &[Pass]) -> Row {
    let over_runs = |value: &dyn Fn(&Tally) -> f64| {
        let values: Vec<f64> = runs.iter().map(|run| value(&run.tallies[at])).collect();
        Estimate::of(&values)
    };
    let scene = &runs[0].scene;
    let settings = &variant.settings;
    let volume = variant.decides();
    let ordop = volume == Some(Volume::OrDop);
    let total =
        |count: fn(&Tally) -> u64| runs.iter().map(|run| count(&run.tallies[at])).sum::<u64>();
    let all: Vec<&Pass> = passes.iter().collect();
    let cost = |regime| {
        let of = (scene.name.as_str(), scene.bodies.len());
        table::cost(of, (at, variant), &all, regime)
    };
    let time = |pass: &Pass| pass.culled[at].times.quartiles(Regime::Warm).median;
    Row {
        name: variant.name.clone(),
        strategy: settings.strategy,
        hulls: variant.hulls,
        volume,
        k: (ordop || volume == Some(Volume::KDop)).then(|| settings.k.k()),
        axes: ordop.then_some(settings.axes),
        overlap: ordop.then_some(settings.overlap),
        reported: over_runs(&|t| t.reported as f64 / f64::from(t.frames)),
        precision: over_runs(&|t| t.quality().precision),
        precisions: runs
            .iter()
            .map(|run| run.tallies[at].quality().precision)
            .collect(),
        per_true: over_runs(&|t| t.quality().per_true),
        recall: share(total(|t| t.found), total(|t| t.truth)),
        volume_over_hull: variant::tightness(variant, scene),
        warm: cost(Regime::Warm),
        cold: cost(Regime::Cold),
        times: passes.iter().map(time).collect(),
        standing: Standing::Front,
        pairs_sha256: runs
            .iter()
            .map(|run| run.tallies[at].pairs_sha256.clone())
            .collect(),
    }
}

fn finish(
    file: &SceneFile,
    plan: &Plan,
    runs: &[Run],
    measured: Measured,
    step: &mut dyn FnMut(&'static str),
) -> Result<Tradeoff, TradeoffError> {
    let first = &runs[0];
    let Measured {
        rows,
        prices,
        conditions,
        hits,
    } = measured;
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
    let clock = budget::by_clock(scene, tier, plan.window.min(scene.frames))?;
    step("interest");
    let interest = interest::sweep(scene, tier, &first.samples, &first.truth)?;
    let densities = density::sweep(file, tier, plan.samples.min(6), || step("density"))?;
    step("safety");
    let safety = safety::compare(scene, plan.samples)?;
    step("shapes");
    let builtin = shapes::builtin()?;
    let shapes = distinct(scene)
        .chain(&builtin)
        .map(|shape| shapes::survival(shape, plan.pairs, tier))
        .collect::<Result<Vec<_>, _>>()?;
    let lines: Vec<Line> = rows.iter().map(line).collect();
    let cheapest = pays::envelope(&lines);
    Ok(Tradeoff {
        decisions: decide::table(&densities, &shapes),
        prices,
        conditions,
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
        decides: row.volume,
        ordop: None,
        times: row.times.clone(),
        pairs: row.reported.mean,
    }
}

/// Times the exact narrow phase on pairs whose spheres overlap.
fn narrow_phase(judge: &Judge, run: &Run, tier: Tier) -> Result<NarrowPhase, TradeoffError> {
    let settings = Variant::spheres(&run.scene.cull).settings;
    let bodies = &run.samples[0].bodies;
    let mut culler = Culler::builder()
        .settings(&settings)
        .tier(tier)
        .build(&run.scene.shapes, bodies)?;
    Ok(judge.price(bodies, culler.cull(bodies)?.iter(), 2000)?)
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
