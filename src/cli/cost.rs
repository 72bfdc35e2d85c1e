//! `sdop cost`: the formula per strategy, predicted against measured.

use std::fmt::Write as _;

use sdop::cost::calibrate::{self, Effort, calibrate};
use sdop::cost::predict::{Prices, Terms};
use sdop::reproduce::terms::{self, Cost};
use sdop::reproduce::{Run, run_scene};
use sdop::scene::Scene;
use sdop::scene::settings::{CullSettings, Strategy};
use serde::Serialize;

use super::Outcome;
use super::output::{Format, emit, progress, table};
use super::scene_args::{MachineArgs, SceneArgs};

/// Frames measured when neither the scene nor a flag wants fewer.
const FRAMES: u32 = 200;
const EFFORT: Effort = Effort {
    frames: 60,
    builds: 5,
};

/// What each strategy costs: predicted by the formula against measured
///
/// T = Co + Nu·Cu + F + Nv·Cv: construction, updates, pair finding, tests. Counts are those of the scene's runs; prices come
/// from a calibration on other seeds, other numbers of bodies and other boxes, so that the formula predicts. The residual is
/// measured over predicted, less one. Without --strategy, every strategy is measured that the scene has settings for.
#[derive(clap::Args)]
#[command(after_help = "Example: sdop cost data/scenes/paper-500.toml --seeds 5")]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    /// Runs to measure: the scene's seed and those after it
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u64).range(1..))]
    seeds: u64,
    #[command(flatten)]
    machine: MachineArgs,
    /// How the result is printed; CSV has the strategies alone
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

#[derive(Serialize)]
struct Report {
    scene: String,
    bodies: usize,
    frames: u32,
    seeds: Vec<u64>,
    simd: &'static str,
    prices: Prices,
    strategies: Vec<Line>,
}

#[derive(Serialize)]
struct Line {
    #[serde(flatten)]
    cost: Cost,
    /// T of the whole run, construction included, in seconds.
    total_predicted: f64,
    total_measured: f64,
}

/// Runs the command.
///
/// # Errors
/// A bad scene, settings that it can't have.
pub fn run(args: &Args) -> miette::Result<Outcome> {
    let report = measure(args)?;
    match args.format {
        Format::Csv => emit(Format::Csv, &report.strategies, |_| String::new())?,
        format => emit(format, &report, text)?,
    }
    Ok(Outcome::Passed)
}

fn measure(args: &Args) -> miette::Result<Report> {
    let mut file = args.scene.read()?;
    let scene = file.build()?;
    let level = args.machine.level();
    let frames = args.scene.frames().unwrap_or(FRAMES.min(scene.frames));
    let strategies = match args.scene.strategy() {
        Some(strategy) => vec![strategy],
        None => possible(&scene),
    };
    let bar = progress(calibrate::SCENES as u64 + args.seeds, &scene.name);
    let prices = calibrate(&scene, &strategies, level, EFFORT, |_| bar.inc(1))?;
    let seeds: Vec<u64> = (scene.seed..).take(args.seeds as usize).collect();
    let mut runs = Vec::new();
    for &seed in &seeds {
        file.spec.seed = seed;
        runs.extend(run_scene(&file.build()?, &strategies, frames, level)?);
        bar.inc(1);
    }
    bar.finish_and_clear();
    let line = |&strategy: &Strategy| {
        let of: Vec<&Run> = runs.iter().filter(|run| run.strategy == strategy).collect();
        terms::cost(&prices, &of).map(|cost| line(cost, frames))
    };
    Ok(Report {
        strategies: strategies.iter().filter_map(line).collect(),
        scene: scene.name,
        bodies: scene.bodies.len(),
        frames,
        seeds,
        simd: level.name(),
        prices,
    })
}

/// The strategies that the scene has all settings for.
fn possible(scene: &Scene) -> Vec<Strategy> {
    let has = |&strategy: &Strategy| {
        let settings = CullSettings {
            strategy,
            ..scene.cull.clone()
        };
        strategy != Strategy::None && settings.check(scene.bodies.len()).is_ok()
    };
    Strategy::ALL.iter().copied().filter(has).collect()
}

fn line(cost: Cost, frames: u32) -> Line {
    let frames = f64::from(frames);
    Line {
        total_predicted: sum(&cost, |terms| terms.construct) + frames * cost.predicted,
        total_measured: cost.construct.mean + frames * cost.measured.mean,
        cost,
    }
}

fn sum(cost: &Cost, term: fn(&Terms) -> f64) -> f64 {
    cost.terms.iter().map(term).sum()
}

fn text(report: &Report) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = write_text(&mut text, report);
    text
}

fn write_text(out: &mut String, report: &Report) -> std::fmt::Result {
    let Report {
        scene,
        bodies,
        frames,
        seeds,
        simd,
        ..
    } = report;
    writeln!(
        out,
        "{scene}: {bodies} bodies, {frames} frames, {} seeds; {simd}, 1 thread",
        seeds.len()
    )?;
    writeln!(
        out,
        "\nPrices, calibrated on {} other scenes",
        calibrate::SCENES
    )?;
    let mut rows = table(&[
        "volume",
        "Co, ms",
        "Cu, ns",
        "F, ns a frame",
        "F, ns a body",
        "Cv hit, ns",
        "Cv miss, ns",
    ]);
    for price in &report.prices.0 {
        let costs = price.costs;
        let mut row = vec![
            price.volume.to_string(),
            format!("{:.2}", 1e3 * costs.construct),
        ];
        row.extend(
            [costs.update, costs.frame, costs.body, costs.hit, costs.miss]
                .map(|seconds| format!("{:.2}", 1e9 * seconds)),
        );
        rows.add_row(row);
    }
    writeln!(out, "{rows}")?;
    writeln!(
        out,
        "\nµs a frame, and ms for all {frames} frames with construction"
    )?;
    let mut rows = table(&[
        "strategy",
        "Nu·Cu",
        "F",
        "Nv·Cv",
        "predicted",
        "measured",
        "±",
        "residual",
        "T predicted",
        "T measured",
    ]);
    for line in &report.strategies {
        let cost = &line.cost;
        let mut row = vec![cost.strategy.to_string()];
        let terms = [
            sum(cost, |t| t.update),
            sum(cost, |t| t.finding),
            sum(cost, |t| t.test),
        ];
        row.extend(terms.map(|seconds| format!("{:.2}", 1e6 * seconds)));
        let sides = [cost.predicted, cost.measured.mean, cost.measured.half_width];
        row.extend(sides.map(|seconds| format!("{:.2}", 1e6 * seconds)));
        row.push(format!("{:+.1} %", 100.0 * cost.residual));
        row.extend(
            [line.total_predicted, line.total_measured]
                .map(|seconds| format!("{:.2}", 1e3 * seconds)),
        );
        rows.add_row(row);
    }
    writeln!(out, "{rows}")?;
    writeln!(
        out,
        "measured: median over frames, mean over seeds ± its 95 % interval"
    )
}
