//! `sdop reproduce`: the paper's experiments, from the runs to the written summary.

mod figures;
mod rows;
mod summary;

use std::path::{Path, PathBuf};

use miette::{IntoDiagnostic as _, miette};
use sdop::settings::Strategy;
use sdop_bench::cost::calibrate::Effort;
use sdop_bench::measure::conditions::Conditions;
pub use sdop_bench::reproduce::units::NAME;
use sdop_bench::reproduce::units::{Experiments, Settings};
use sdop_bench::reproduce::{Plan, Results};
use sdop_bench::sweep::{Merged, Sweep as _};

use super::Outcome;
use super::files::{command, write};
use super::output::{Format, Reasoned, csv_text, emit};
use super::scene_args::MachineArgs;
use super::sweep::{self, SweepArgs};
pub use figures::draw_costs;
use rows::Tables;

/// Run the paper's experiments: Table 1, Figs 12 to 14, costs, claims
///
/// For 50, 150, 300, 350 and 500 objects in one box, and 500 in a small one, every strategy culls the same seeded trajectories.
/// Counts and hashes are equal on every CPU; times are medians over warm frames with intervals over seeds. Results are written
/// as CSV, JSON, SVG and a summary in Markdown. The exit code is 1 when the sequential and the listed S-DOP report
/// different pairs.
#[derive(clap::Args)]
#[command(
    after_help = "Examples: sdop reproduce --quick\n          sdop reproduce --out results --seeds 20\n          \
    sdop reproduce --seeds 640 --shard 3/10 --out shards"
)]
pub struct Args {
    /// A look at everything within seconds: few seeds, wide intervals
    #[arg(long)]
    quick: bool,
    /// Runs of each scene [default: 64, with --quick 5]
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    seeds: Option<u64>,
    /// Frames a run [default: 400, with --quick 100]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    frames: Option<u32>,
    #[command(flatten)]
    sweep: SweepArgs,
    /// Where tables go
    #[arg(long, value_name = "DIR", default_value = "target/reproduce")]
    out: PathBuf,
    /// Where the summary and its figures go [default: the same]
    #[arg(long, value_name = "DIR")]
    paper: Option<PathBuf>,
    /// Where the paper's scenes are
    #[arg(long, value_name = "DIR", default_value = "data/scenes")]
    scenes: PathBuf,
    #[command(flatten)]
    machine: MachineArgs,
    /// What is printed: the summary, or all results as JSON, or Table 1 as CSV
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// How much is run by default.
struct Size {
    seeds: u64,
    frames: u32,
    effort: Effort,
}

const QUICK: Size = Size {
    seeds: 5,
    frames: 100,
    effort: Effort {
        turns: 1,
        builds: 3,
    },
};
const FULL: Size = Size {
    seeds: 64,
    frames: 400,
    effort: Effort {
        turns: 2,
        builds: 5,
    },
};

/// Runs the command.
///
/// # Errors
/// Scenes that can't be read, a shard that doesn't exist, results that can't be written.
pub fn run(args: &Args) -> miette::Result<Outcome> {
    sweep::enter(&args.sweep)?;
    let experiments = Experiments::new(&plan(args)?, !args.quick)?;
    let before = Conditions::before();
    let mut results = Results::of_header(&experiments.header()?)?;
    let mut take = |_, result: &str| results.take(result);
    let Some(finished) = args.sweep.run(&experiments, &args.out, &mut take)? else {
        return Ok(Outcome::Passed);
    };
    let machine = experiments.settings().machine;
    let paper = args.paper.as_ref().unwrap_or(&args.out);
    let tables = Tables::new(&results, &machine, command(), before);
    let written = Written {
        numbers: &args.out,
        paper,
        seconds: finished.seconds,
    };
    let why = why(&results);
    written.write(&tables, why, args.format)?;
    finished.clear()?;
    Ok(Outcome::of(why))
}

/// What merged shards give.
///
/// # Errors
/// Results of another command, a CPU that lacks the tier, files that can't be written.
pub fn merged(merged: &Merged, out: &Path, format: Format) -> miette::Result<Outcome> {
    let settings: Settings = merged.header.settings().into_diagnostic()?;
    let mut results = Results::of_header(&merged.header)?;
    for result in merged.done.values() {
        results.take(result)?;
    }
    let unknown = Conditions::default();
    let line = merged.header.line.clone();
    let tables = Tables::new(&results, &settings.machine, line, unknown);
    let written = Written {
        numbers: out,
        paper: out,
        seconds: merged.seconds,
    };
    let why = why(&results);
    written.write(&tables, why, format)?;
    Ok(Outcome::of(why))
}

/// Where results go, and how long they took.
struct Written<'a> {
    numbers: &'a Path,
    paper: &'a Path,
    seconds: f64,
}

impl Written<'_> {
    fn write(&self, tables: &Tables, why: Option<&str>, format: Format) -> miette::Result<()> {
        write_tables(self.numbers, tables)?;
        figures::draw_all(&self.paper.join("figures"), tables)?;
        let summary = self.paper.join("summary.md");
        write(&summary, summary::write(tables))?;
        match format {
            Format::Csv => emit(Format::Csv, &tables.table_1, |_| String::new()),
            format => {
                let result = tables;
                emit(format, &Reasoned { result, why }, |_| {
                    let place = format!("{}, {}", summary.display(), self.numbers.display());
                    summary::brief(tables, self.seconds, &place)
                })
            }
        }
    }
}

/// What failed.
fn why(results: &Results) -> Option<&'static str> {
    (!lists_agree(results)).then_some("sequential and listed S-DOP report different pairs")
}

fn plan(args: &Args) -> miette::Result<Plan> {
    let size = if args.quick { QUICK } else { FULL };
    let seeds = args.seeds.unwrap_or(size.seeds);
    let frames = args.frames.unwrap_or(size.frames);
    if !args.scenes.is_dir() {
        return Err(miette!(
            help =
                "run it in the root of the repository, or say where the scenes are: --scenes DIR",
            "there is no directory {}",
            args.scenes.display()
        ));
    }
    let tier = args.machine.tier();
    Ok(Plan::new(&args.scenes, seeds, frames, size.effort, tier))
}

/// Whether sequential and listed S-DOP reported the same pairs in every run.
fn lists_agree(results: &Results) -> bool {
    let hashes = |strategy| {
        let of = results
            .runs
            .iter()
            .filter(move |run| run.strategy == strategy);
        of.map(|run| &run.pairs_sha256)
    };
    hashes(Strategy::SDopSequential).eq(hashes(Strategy::SDopBatch))
}

fn write_tables(directory: &Path, tables: &Tables) -> miette::Result<()> {
    let json = serde_json::to_string_pretty(tables).into_diagnostic()?;
    write(&directory.join("results.json"), &(json + "\n"))?;
    for (name, rows) in tables.files()? {
        write(
            &directory.join(name).with_extension("csv"),
            &csv_text(rows)?,
        )?;
    }
    Ok(())
}
