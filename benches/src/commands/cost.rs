//! `sdop cost`: prints the formula's predicted time and the measured time per strategy.

use std::path::PathBuf;

use miette::miette;
use sdop_bench::cost::PRICES;
use sdop_bench::cost::calibrate::Effort;
use sdop_bench::cost::design;
use sdop_bench::cost::rows::of_report;
use sdop_bench::cost::study::{CostPlan, CostReport, possible, study};
use sdop_bench::cost::table::{Cost, MOST_RIGHT_RESIDUAL};
use sdop_bench::measure::row::Row;
use sdop_bench::measure::turns::Regime;

use super::Outcome;
use super::files::{svg, write, write_json};
use super::output::{Column, Format, counted, emit, paragraphs, pivot, progress};
use super::reproduce::draw_costs;
use super::scene_args::{MachineArgs, SceneArgs};

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
/// measured. A `World`, which keeps the pairs of sleeping bodies, isn't modelled; `advise` times
/// it.
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
    /// Seeds to measure, from the scene's on, each in a pass of its own
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    seeds: u64,
    #[command(flatten)]
    machine: MachineArgs,
    /// Draw the terms and the measured times to this SVG file
    #[arg(long, value_name = "FILE.svg", value_parser = svg)]
    plot: Option<PathBuf>,
    /// Print all tables: also cold frames, counts by volume, prices and construction
    #[arg(long)]
    all: bool,
    /// Output format; CSV has one number per row
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
            write_json(&directory.join(format!("{}.json", report.scene)), report)?;
        }
    }
    match args.format {
        Format::Csv => {
            let rows: Vec<Row> = reports.iter().flat_map(of_report).collect();
            emit(Format::Csv, &rows, |_| String::new())?;
        }
        Format::Json if others.is_empty() => emit(Format::Json, first, |_| String::new())?,
        format => emit(format, &reports, |reports| {
            let texts = reports.iter().map(|report| text(report, args.all));
            texts.collect::<Vec<_>>().join("\n\n")
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
        frames: args.scene.frames.unwrap_or(DEFAULT_FRAMES.min(scene.frames)),
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

/// T by its terms, in µs per frame.
const FRAME: [Column<'_>; 6] = [
    ("Nu·Cu", "Nu*Cu", 1e6),
    ("F", "F", 1e6),
    ("Nv·Cv", "Nv*Cv", 1e6),
    ("sum", "all terms", 1e6),
    ("measured", "measured", 1e6),
    ("residual, %", "residual", 100.0),
];

/// The counts and terms of a volume.
const VOLUME: [Column<'_>; 8] = [
    ("Nu", "Nu", 1.0),
    ("Nv", "Nv", 1.0),
    ("hits", "hits", 1.0),
    ("bodies with hits", "bodies with hits", 1.0),
    ("further slabs", "further slabs", 1.0),
    ("Nu·Cu, µs", "Nu*Cu", 1e6),
    ("F, µs", "F", 1e6),
    ("Nv·Cv, µs", "Nv*Cv", 1e6),
];

/// Construction, and T with it.
const TOTAL: [Column<'_>; 6] = [
    ("Co predicted", "Co predicted", 1e3),
    ("Co measured", "Co measured", 1e3),
    ("residual, %", "Co residual", 100.0),
    ("T predicted", "T predicted", 1e3),
    ("T measured", "T measured", 1e3),
    ("residual, %", "T residual", 100.0),
];

fn text(report: &CostReport, is_whole: bool) -> String {
    let CostReport { scene, bodies, frames, scene_frames, seeds, machine, .. } = report;
    let level = report.costs.first().and_then(|cost| cost.level);
    let level = level.map_or_else(String::new, |level| format!(", working set in {level}"));
    let mut parts = vec![format!(
        "{scene}: {bodies} bodies{level}; {}, {frames} of {scene_frames} frames each; {}, 1 thread",
        counted(seeds.len(), "seed"),
        machine.simd
    )];
    parts.extend(report.conditions.warning());
    let rows = of_report(report);
    let (warm, cold) = (Regime::Warm, Regime::Cold);
    let mut frames_of = |regime| {
        let failures = of(report, regime).filter_map(failure);
        let table = pivot(&rows, regime, false, &FRAME);
        parts.push(format!("µs per {regime} frame\n{table}"));
        parts.extend(failures);
    };
    frames_of(warm);
    if is_whole {
        frames_of(cold);
        // Co in ms, all others in ns.
        let prices: Vec<(String, String, f64)> = PRICES
            .iter()
            .map(|kind| {
                let (unit, factor) =
                    if kind.key == "construct" { ("ms", 1e3) } else { ("ns", 1e9) };
                (format!("{}, {unit}", kind.name), format!("price {}", kind.name), factor)
            })
            .collect();
        let prices: Vec<Column<'_>> =
            prices.iter().map(|(title, metric, factor)| (&**title, &**metric, *factor)).collect();
        for (title, regime, by_volume, columns) in [
            ("Counts and terms per warm frame", warm, true, &VOLUME[..]),
            ("Prices for warm frames", warm, true, &prices),
            ("Prices for cold frames", cold, true, &prices),
            ("With construction, warm: ms for all frames", warm, false, &TOTAL),
        ] {
            parts.push(format!("{title}\n{}", pivot(&rows, regime, by_volume, columns)));
        }
        parts.push(format!(
            "A term is its count times its price; prices are from {} calibration scenes. Quote one with the machine, the \
             volume, warm or cold, and the cache. Bodies with hits and further slabs follow from the counts, if hits are \
             spread evenly.",
            design::SCENES
        ));
    }
    let rest = if is_whole { "" } else { " --all prints counts, prices and cold frames." };
    parts.push(format!(
        "F is pair finding, which the paper's equation lacks. ± is a 95 % interval over seeds, of the residual with the \
         calibration's uncertainty.{rest}"
    ));
    paragraphs(&parts.join("\n\n"))
}

/// What is wrong with a prediction that is off: the assumption that fails.
fn failure(cost: &Cost) -> Option<String> {
    let assumption = cost.fails?;
    Some(format!(
        "{}: more than {:.0} % off. What fails: {assumption}.",
        cost.variant,
        100.0 * MOST_RIGHT_RESIDUAL
    ))
}
