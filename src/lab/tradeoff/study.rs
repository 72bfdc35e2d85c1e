//! The whole comparison of one scene, seed by seed.

use std::path::PathBuf;

use super::budget::{self, Window};
use super::counts::{Tally, share};
use super::decide;
use super::density;
use super::interest;
use super::pays::{self, Line, Point, Standing};
use super::result::{Tradeoff, VariantResult};
use super::safety;
use super::shapes;
use super::timing::{PASSES, Windows};
use super::truth::{Judge, Sample, Truth, samples};
use super::variant::{self, Variant};
use super::vary;
use super::{Estimate, TradeoffError};
use crate::choice::choices;
use crate::lab::cost::calibrate::{Calibration, Effort};
use crate::lab::cost::pass::{Pass, pass};
use crate::lab::cost::table::{self, PriceRow};
use crate::lab::measure::conditions::Conditions;
use crate::lab::measure::counts::Volume;
use crate::lab::measure::turns::Regime;
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

choices! {
    /// What is measured once, after the runs.
    Once, "measurement", {
        /// What the exact narrow phase costs.
        NarrowPhase = "narrow phase",
        /// Time-critical culling.
        Budgets = "budgets",
        /// Culling of interest.
        Interest = "interest",
        /// Margins, arithmetic and tiers.
        Safety = "safety",
        /// Shapes, each against itself.
        Shapes = "shapes",
    }
}

/// One seed's run.
struct Run {
    scene: Scene,
    samples: Vec<Sample>,
    truth: Truth,
    tallies: Vec<Tally>,
}

/// Compares everything on one scene. `step` is called with what is being done, often.
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
            &mut (),
        )?;
        passes.push(pass);
    }
    let rows = rows(&variants, &runs, &passes);
    let measured = Measured {
        prices: Regime::ALL
            .iter()
            .flat_map(|&regime| table::prices(&passes.iter().collect::<Vec<_>>(), regime))
            .collect(),
        conditions: before.after(rows.iter().map(VariantResult::seconds)),
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
    rows: Vec<VariantResult>,
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
    let once = Once::ALL.len() as u64;
    Ok(runs * (1 + variants) + passes_of(plan) as u64 + density::steps() + vary::steps() + once)
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

fn rows(variants: &[Variant], runs: &[Run], passes: &[Pass]) -> Vec<VariantResult> {
    let mut rows: Vec<VariantResult> = variants
        .iter()
        .enumerate()
        .map(|(at, variant)| row(variant, at, runs, passes))
        .collect();
    let point = |row: &VariantResult| Point {
        times: row.times.clone(),
        precisions: row.precisions.clone(),
    };
    let points: Vec<Point> = rows.iter().map(point).collect();
    for (row, standing) in rows.iter_mut().zip(pays::standings(&points)) {
        row.standing = standing;
    }
    rows
}

fn row(variant: &Variant, at: usize, runs: &[Run], passes: &[Pass]) -> VariantResult {
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
    VariantResult {
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
    step(Once::NarrowPhase.name());
    let narrow_phase =
        judge.price_of_spheres(&first.scene, &first.samples[0].bodies, tier, 2000)?;
    step(Once::Budgets.name());
    let window = first_frames(scene, plan.window)?;
    let window = Window {
        frames: &window,
        stride: plan.stride,
    };
    let budgets = budget::by_tests(scene, tier, window, &judge, plan.cache.as_deref(), hits)?;
    let clock = budget::by_clock(scene, tier, plan.window.min(scene.frames))?;
    step(Once::Interest.name());
    let interest = interest::sweep(scene, tier, &first.samples, &first.truth)?;
    let densities = density::sweep(file, tier, plan.samples.min(6), || step("density"))?;
    let variations = vary::sweep(file, tier, plan.samples.min(6), || step("variations"))?;
    step(Once::Safety.name());
    let safety = safety::compare(scene, plan.samples)?;
    step(Once::Shapes.name());
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
        variations,
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

fn line(row: &VariantResult) -> Line {
    Line {
        name: row.name.clone(),
        decides: row.volume,
        ordop: None,
        times: row.times.clone(),
        pairs: row.reported.mean,
        construct: row
            .warm
            .as_ref()
            .map_or(0.0, |cost| cost.construct.measured.mean),
    }
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
