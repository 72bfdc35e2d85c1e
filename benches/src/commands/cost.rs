//! `sdop cost`: prints the formula's predicted time and the measured time per strategy.

pub mod lines;

use std::fmt::Write as _;
use std::path::PathBuf;

use comfy_table::Table;
use miette::{IntoDiagnostic, miette};
use sdop_bench::cost::calibrate::Effort;
use sdop_bench::cost::design;
use sdop_bench::cost::level::CacheLevel;
use sdop_bench::cost::study::{CostPlan, CostReport, possible, study};
use sdop_bench::cost::table::{CheckedPrediction, Cost, MOST_RIGHT_RESIDUAL, PriceRow};
use sdop_bench::cost::terms::Terms;
use sdop_bench::measure::turns::Regime;
use sdop_bench::reproduce::Estimate;

use super::files::write;
use super::output::{Format, decimal, emit, progress, rows, table};
use super::reproduce::draw_costs;
use super::scene_args::{MachineArgs, SceneArgs};
use super::{Outcome, prices};

/// Frames per pass, unless the scene or a flag has fewer.
const DEFAULT_FRAMES: u32 = 200;
const EFFORT: Effort = Effort { turns: 1, builds: 9 };

/// Predict each strategy's cost by the formula, and measure it
///
/// T = Co + Nu·Cu + F + Nv·Cv: construction, updates, pair finding, tests. The paper's equation has
/// no F. Counts come from the scene's runs. Prices belong to the machine, the volume and the
/// regime: warm frames, which follow one another, or cold ones, before which other cullers ran, and
/// the cache that holds the working set. They come from calibration scenes that are made from the
/// scene's shapes alone, so that T is a true prediction; scenes named by --also have the same
/// prices. The residual is measured / predicted - 1; if it exceeds 5 %, the row names the
/// assumption that fails. Without --strategy, all strategies for which the scene has settings are
/// measured. A scene with `rest` is also culled by worlds, which keep the pairs of sleeping bodies:
/// F is then a price per queried, thawed and kept body.
#[derive(clap::Args)]
#[command(after_help = "Example: sdop cost data/scenes/paper-500.toml --plot cost.svg")]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    /// Another scene with the same meshes and [cull], predicted by the same prices; repeatable
    #[arg(long, value_name = "SCENE")]
    also: Vec<PathBuf>,
    /// Write each scene's result to SCENE.json in this directory
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Passes to measure, at different times: with the scene's seed and those after it
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    seeds: u64,
    #[command(flatten)]
    machine: MachineArgs,
    /// Draw the terms and the measured times to this SVG file
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Output format; CSV has one line per term
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Runs the command.
///
/// # Errors
/// A bad scene, settings that it can't have.
pub fn run(args: &Args) -> miette::Result<Outcome> {
    let reports = measure(args)?;
    let [first, others @ ..] = &*reports else {
        return Ok(Outcome::Passed);
    };
    if let Some(path) = &args.plot {
        let warm: Vec<&Cost> = of(first, Regime::Warm).collect();
        write(path, &draw_costs(&first.scene, &warm)?)?;
    }
    if let Some(directory) = &args.out {
        for report in &reports {
            let json = serde_json::to_string_pretty(report).into_diagnostic()?;
            let name = format!("{}.json", report.scene);
            write(&directory.join(name), &(json + "\n"))?;
        }
    }
    match args.format {
        Format::Csv => {
            let lines: Vec<_> = reports.iter().flat_map(lines::of_report).collect();
            emit(Format::Csv, &lines, |_| String::new())?;
        }
        Format::Json if others.is_empty() => emit(Format::Json, first, text)?,
        format => emit(format, &reports, |reports| {
            reports.iter().map(text).collect::<Vec<_>>().join("\n\n")
        })?,
    }
    Ok(Outcome::Passed)
}

/// The report of each scene.
fn measure(args: &Args) -> miette::Result<Vec<CostReport>> {
    let also = args.also.iter().map(|path| args.scene.read_other(path));
    let mut files = vec![args.scene.read()?];
    files.extend(also.collect::<miette::Result<Vec<_>>>()?);
    let scene = files[0].build()?;
    let strategies = match args.scene.strategy() {
        Some(strategy) if !strategy.scheme().culls() => {
            return Err(miette!(
                help = "leave --strategy out to compare all that do",
                "the control culls nothing: the formula has no term for it"
            ));
        }
        Some(strategy) => vec![strategy],
        None => possible(&scene),
    };
    let plan = CostPlan {
        strategies,
        passes: args.seeds,
        frames: args.scene.frames().unwrap_or(DEFAULT_FRAMES.min(scene.frames)),
        effort: EFFORT,
        tier: args.machine.tier(),
    };
    let bar = progress(args.seeds * files.len() as u64, &scene.name);
    let reports = study(&files, &plan, || bar.inc(1))?;
    bar.finish_and_clear();
    Ok(reports)
}

fn of(report: &CostReport, regime: Regime) -> impl Iterator<Item = &Cost> {
    report.costs.iter().filter(move |cost| cost.regime == regime)
}

fn text(report: &CostReport) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = write_text(&mut text, report);
    text
}

fn write_text(out: &mut String, report: &CostReport) -> std::fmt::Result {
    let CostReport { scene, bodies, frames, scene_frames, seeds, .. } = report;
    writeln!(
        out,
        "{scene}: {bodies} bodies, {} passes of {frames} frames; {}, 1 thread",
        seeds.len(),
        report.machine.simd
    )?;
    if frames < scene_frames {
        writeln!(
            out,
            "The scene has {scene_frames} frames: so many of them tell the time of one; --frames takes another number."
        )?;
    }
    if let Some(warning) = report.conditions.warning() {
        writeln!(out, "{warning}")?;
    }
    let level = report.costs.first().and_then(|cost| cost.level);
    let level =
        level.map_or_else(String::new, |level: CacheLevel| format!(", working set in {level}"));
    for &regime in Regime::ALL {
        writeln!(
            out,
            "\n{} frames{level}, µs per frame\n{}",
            title(regime),
            strategy_rows(report, regime)
        )?;
        write_failures(out, report, regime)?;
    }
    writeln!(out, "\nCounts and terms of warm frames, by volume\n{}", volume_rows(report))?;
    for &regime in Regime::ALL {
        let of = |price: &&PriceRow| price.regime == regime;
        let prices: Vec<_> = report.prices.iter().filter(of).collect();
        writeln!(
            out,
            "\nPrices for {regime} frames{level}, from {} calibration scenes\n{}",
            design::SCENES,
            rows(&prices::COLUMNS, &prices, |price| prices::cells(price, |e| plus_minus(
                e.mean,
                e.half_width
            )))
        )?;
    }
    writeln!(out, "\nWith construction: ms for all {frames} frames, warm\n{}", total_rows(report))?;
    writeln!(
        out,
        "A term is its count times its price. Quote a price with the machine, the volume, warm or cold, and the cache.\n\
         F is pair finding, which the paper's equation lacks: \"paper\" is the sum without it.\n\
         \"With hits\" and \"further slabs\" follow from the counts, if hits are spread evenly.\n\
         ± is a 95 % interval over passes; of the residual it holds the calibration's uncertainty as well."
    )
}

/// The predictions that are off, each with the assumption that fails.
fn write_failures(out: &mut String, report: &CostReport, regime: Regime) -> std::fmt::Result {
    for cost in of(report, regime) {
        if let Some(assumption) = cost.fails {
            writeln!(
                out,
                "{}: more than {:.0} % off. What fails: {assumption}.",
                cost.variant,
                100.0 * MOST_RIGHT_RESIDUAL
            )?;
        }
    }
    Ok(())
}

fn title(regime: Regime) -> &'static str {
    match regime {
        Regime::Warm => "Warm",
        Regime::Cold => "Cold",
    }
}

fn strategy_rows(report: &CostReport, regime: Regime) -> Table {
    let mut rows = table(&[
        "strategy",
        "Nu·Cu",
        "F",
        "Nv·Cv",
        "sum",
        "measured",
        "±",
        "quartiles",
        "residual",
        "±",
        "paper",
    ]);
    for cost in of(report, regime) {
        let us = |seconds: f64| hundredths(1e6 * seconds);
        let CheckedPrediction { measured, residual, .. } = cost.frame;
        let mut row = vec![cost.variant.clone()];
        row.extend([
            us(cost.sum(|t| t.update)),
            us(cost.sum(|t| t.finding)),
            us(cost.sum(|t| t.test)),
            us(cost.frame.predicted.mean),
            us(measured.mean),
            us(measured.half_width),
            format!("{} to {}", us(cost.quartiles.low), us(cost.quartiles.high)),
        ]);
        row.extend(percents(&residual));
        row.push(us(cost.sum(Terms::in_paper)));
        rows.add_row(row);
    }
    rows
}

fn total_rows(report: &CostReport) -> Table {
    let mut rows = table(&[
        "strategy",
        "Co predicted",
        "Co measured",
        "residual",
        "±",
        "T predicted",
        "T measured",
        "residual",
        "±",
    ]);
    for cost in of(report, Regime::Warm) {
        let mut row = vec![cost.variant.clone()];
        for compared in [&cost.construct, &cost.total] {
            row.push(hundredths(1e3 * compared.predicted.mean));
            row.push(hundredths(1e3 * compared.measured.mean));
            row.extend(percents(&compared.residual));
        }
        rows.add_row(row);
    }
    rows
}

fn percents(residual: &Estimate) -> [String; 2] {
    [format!("{:+.1} %", 100.0 * residual.mean), format!("{:.1}", 100.0 * residual.half_width)]
}

/// The counts of each volume of each strategy, and the resulting terms.
fn volume_rows(report: &CostReport) -> Table {
    let mut rows = table(&[
        "strategy",
        "volume",
        "Nu",
        "Nv",
        "hits",
        "bodies with hits",
        "further slabs",
        "queried",
        "thawed",
        "kept",
        "Nu·Cu, µs",
        "F, µs",
        "Nv·Cv, µs",
    ]);
    for cost in of(report, Regime::Warm) {
        for (terms, widths) in cost.terms.iter().zip(&cost.widths) {
            let us = |mean: f64, width: f64| plus_minus(1e6 * mean, 1e6 * width);
            rows.add_row([
                cost.variant.clone(),
                terms.volume.to_string(),
                decimal(terms.updates),
                decimal(terms.tests),
                decimal(terms.hits),
                decimal(terms.rows),
                decimal(terms.further),
                decimal(terms.queried),
                decimal(terms.thawed),
                decimal(terms.kept),
                us(terms.update, widths.update),
                us(terms.finding, widths.finding),
                us(terms.test, widths.test),
            ]);
        }
    }
    rows
}

fn plus_minus(mean: f64, half_width: f64) -> String {
    if half_width.is_finite() { format!("{mean:.2} ± {half_width:.2}") } else { hundredths(mean) }
}

fn hundredths(value: f64) -> String {
    format!("{value:.2}")
}
