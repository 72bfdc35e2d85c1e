//! `sdop cost`: the formula per strategy, predicted against measured.

use std::fmt::Write as _;

use comfy_table::Table;
use miette::miette;
use sdop::lab::cost::calibrate::{self, Effort, calibrate};
use sdop::lab::cost::predict::{Price, Prices};
use sdop::lab::reproduce::terms::{self, Cost};
use sdop::lab::reproduce::{Run, run_scene};
use sdop::lab::scene::Scene;
use sdop::settings::{CullSettings, Strategy};
use serde::Serialize;

use super::output::{Format, emit, progress, rows, table};
use super::scene_args::{MachineArgs, SceneArgs};
use super::{Outcome, prices};

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
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u64).range(1..=100_000))]
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
    let tier = args.machine.tier();
    let frames = args.scene.frames().unwrap_or(FRAMES.min(scene.frames));
    let strategies = match args.scene.strategy() {
        Some(Strategy::None) => {
            return Err(miette!(
                help = "leave --strategy out to compare all that do",
                "the control culls nothing: the formula has no term for it"
            ));
        }
        Some(strategy) => vec![strategy],
        None => possible(&scene),
    };
    let bar = progress(calibrate::SCENES as u64 + args.seeds, &scene.name);
    let prices = calibrate(&scene, &strategies, tier, EFFORT, |_| bar.inc(1))?;
    let seed = |n| scene.seed.wrapping_add(n);
    let seeds: Vec<u64> = (0..args.seeds).map(seed).collect();
    let mut runs = Vec::new();
    for &seed in &seeds {
        file.spec.seed = seed;
        runs.extend(run_scene(&file.build()?, &strategies, frames, tier)?);
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
        simd: tier.name(),
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
    let [total_predicted, total_measured] = cost.totals(frames);
    Line {
        cost,
        total_predicted,
        total_measured,
    }
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
    let calibrated = calibrate::SCENES;
    let price = |price: &Price| prices::cells(price, hundredths);
    writeln!(
        out,
        "\nPrices, calibrated on {calibrated} other scenes\n{}",
        rows(&prices::COLUMNS, &report.prices.0, price)
    )?;
    writeln!(
        out,
        "\nµs a frame, and ms for all {frames} frames with construction\n{}",
        strategy_rows(report)
    )?;
    writeln!(
        out,
        "measured: median over frames, mean over seeds ± its 95 % interval"
    )
}

fn strategy_rows(report: &Report) -> Table {
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
        let a_frame = [
            cost.sum(|t| t.update),
            cost.sum(|t| t.finding),
            cost.sum(|t| t.test),
            cost.predicted,
            cost.measured.mean,
            cost.measured.half_width,
        ];
        let totals = [line.total_predicted, line.total_measured];
        let mut row = vec![cost.strategy.to_string()];
        row.extend(a_frame.map(|seconds| hundredths(1e6 * seconds)));
        row.push(format!("{:+.1} %", 100.0 * cost.residual));
        row.extend(totals.map(|seconds| hundredths(1e3 * seconds)));
        rows.add_row(row);
    }
    rows
}

fn hundredths(value: f64) -> String {
    format!("{value:.2}")
}
