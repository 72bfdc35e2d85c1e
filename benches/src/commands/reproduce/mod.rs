//! `sdop reproduce`: runs the paper's experiments and writes their tables and figures.

mod figures;
mod rows;
mod terminal;

use std::path::{Path, PathBuf};

use miette::{IntoDiagnostic as _, miette};
use sdop::settings::Strategy;
use sdop_bench::cost::calibrate::Effort;
use sdop_bench::measure::conditions::Conditions;
pub use sdop_bench::reproduce::NAME;
use sdop_bench::reproduce::{ExperimentPlan, ExperimentSettings, Experiments, Results};
use sdop_bench::sweep::{MergedUnits, Sweep as _};

use super::Outcome;
use super::files::{command, write, write_json};
use super::output::{Format, csv_text, emit, emit_with_reason};
use super::scene_args::MachineArgs;
use super::sweep::{self, SweepArgs};
pub use figures::draw_costs;
use rows::Tables;

/// Run the paper's experiments: Table 1, Figs 12 to 14, costs, claims
///
/// For 50, 150, 300, 350 and 500 objects in one box, and 500 in a small one, every strategy culls
/// the same seeded trajectories. Counts and hashes are the same on every CPU; times are medians
/// over warm frames with intervals over seeds. Results are written as CSV, JSON and SVG; from a
/// record (`sdop record reproduce`), `sdop report` makes the page paper/summary.md. The exit code
/// is 1 if sequential and batch S-DOP report different pairs.
#[derive(clap::Args)]
#[command(
    after_help = "Examples: sdop reproduce --quick\n          sdop reproduce --out results --seeds 20\n          \
    sdop reproduce --seeds 640 --shard 3/10 --out shards"
)]
pub struct Args {
    /// A short run that takes seconds: few seeds, wide intervals
    #[arg(long)]
    quick: bool,
    /// Runs of each scene [default: 64, with --quick 5]
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    seeds: Option<u64>,
    /// Frames per run, of which the first is cold [default: 400, with --quick 100]
    #[arg(long, value_parser = clap::value_parser!(u32).range(2..=1_000_000))]
    frames: Option<u32>,
    #[command(flatten)]
    sweep: SweepArgs,
    /// Output directory for tables
    #[arg(long, value_name = "DIR", default_value = "target/reproduce")]
    out: PathBuf,
    /// Output directory for figures [default: the same]
    #[arg(long, value_name = "DIR")]
    paper: Option<PathBuf>,
    /// Directory of the paper's scenes
    #[arg(long, value_name = "DIR", default_value = "data/scenes")]
    scenes: PathBuf,
    #[command(flatten)]
    machine: MachineArgs,
    /// Output format: the main numbers, what pages are made from, or every number as CSV
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// How much is run by default.
struct RunSize {
    seeds: u64,
    frames: u32,
    effort: Effort,
}

const QUICK: RunSize = RunSize { seeds: 5, frames: 100, effort: Effort { turns: 1, builds: 3 } };
const FULL: RunSize = RunSize { seeds: 64, frames: 400, effort: Effort { turns: 2, builds: 5 } };

/// Runs the command.
///
/// # Errors
/// Scenes that can't be read, a shard that doesn't exist, results that can't be written.
pub fn run(args: &Args) -> miette::Result<Outcome> {
    sweep::enter(&args.sweep)?;
    let experiments = Experiments::new(&plan(args)?)?;
    let before = Conditions::before();
    let mut results = Results::of_header(&experiments.header()?)?;
    let mut take = |_, result: &str| results.take(result);
    let Some(seconds) = args.sweep.run(&experiments, &args.out, &mut take)? else {
        return Ok(Outcome::Passed);
    };
    let machine = experiments.settings().machine;
    let paper = args.paper.as_ref().unwrap_or(&args.out);
    let tables = Tables::new(&results, &machine, command(), before);
    OutputPlace { numbers: &args.out, paper, seconds }.write(&results, &tables, args.format)
}

/// What merged shards give.
///
/// # Errors
/// Results of another command, a CPU that lacks the tier, files that can't be written.
pub fn merged(merged: &MergedUnits, out: &Path, format: Format) -> miette::Result<Outcome> {
    let settings: ExperimentSettings = merged.header.settings().into_diagnostic()?;
    let mut results = Results::of_header(&merged.header)?;
    for result in merged.done.values() {
        results.take(result)?;
    }
    let (line, unknown) = (merged.header.line.clone(), Conditions::default());
    let tables = Tables::new(&results, &settings.machine, line, unknown);
    let seconds = merged.seconds;
    OutputPlace { numbers: out, paper: out, seconds }.write(&results, &tables, format)
}

/// Where results go, and how long they took.
struct OutputPlace<'a> {
    numbers: &'a Path,
    paper: &'a Path,
    seconds: f64,
}

impl OutputPlace<'_> {
    fn write(&self, results: &Results, tables: &Tables, format: Format) -> miette::Result<Outcome> {
        let why = disagreement(results);
        write_json(&self.numbers.join("results.json"), tables)?;
        for (name, rows) in tables.files()? {
            write(&self.numbers.join(name).with_extension("csv"), &csv_text(rows)?)?;
        }
        for (name, svg) in figures::draw_all(&tables.drawn)? {
            write(&self.paper.join("figures").join(name), &svg)?;
        }
        match format {
            Format::Csv => emit(Format::Csv, &tables.rows, |_| String::new())?,
            format => emit_with_reason(format, tables, why.as_deref(), |tables| {
                terminal::brief(tables, self.seconds, &self.numbers.display().to_string())
            })?,
        }
        Ok(why.map_or(Outcome::Passed, Outcome::Failed))
    }
}

fn plan(args: &Args) -> miette::Result<ExperimentPlan> {
    let size = if args.quick { QUICK } else { FULL };
    let seeds = args.seeds.unwrap_or(size.seeds);
    let frames = args.frames.unwrap_or(size.frames);
    if !args.scenes.is_dir() {
        return Err(miette!(
            help = "run it in the root of the repository, or give --scenes DIR",
            "there is no directory {}",
            args.scenes.display()
        ));
    }
    let tier = args.machine.tier();
    Ok(ExperimentPlan::new(&args.scenes, seeds, frames, size.effort, tier))
}

/// Says so if sequential and listed S-DOP did not report the same pairs in every run.
fn disagreement(results: &Results) -> Option<String> {
    let hashes = |strategy| {
        let of = results.runs().filter(move |run| run.strategy == strategy);
        of.map(|run| &run.pairs_sha256)
    };
    let agree = hashes(Strategy::SDopSequential).eq(hashes(Strategy::SDopBatch));
    (!agree).then(|| "sequential and listed S-DOP report different pairs".to_owned())
}

/// The figures of a record's `results.json`, each with its file's name.
///
/// # Errors
/// Another text.
#[cfg_attr(not(feature = "maintain"), allow(dead_code, reason = "pages alone need it"))]
pub fn figures_of(results: &str) -> miette::Result<Vec<(String, String)>> {
    figures::draw_all(&rows::Drawings::read(results)?)
}
