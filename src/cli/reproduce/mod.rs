//! `sdop reproduce`: the paper's experiments, from the runs to the written summary.

mod figures;
mod rows;
mod summary;

use std::path::{Path, PathBuf};
use std::time::Instant;

use miette::{IntoDiagnostic as _, miette};
use sdop::lab::cost::calibrate::Effort;
use sdop::lab::measure::conditions::Conditions;
use sdop::lab::measure::machine::Machine;
use sdop::lab::reproduce::{Plan, Results, Shard, sensitivity};
use sdop::settings::Strategy;

use super::Outcome;
use super::files::{command, write};
use super::output::{Format, csv_text, emit, progress};
use super::scene_args::MachineArgs;
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
    after_help = "Examples: sdop reproduce --quick\n          sdop reproduce --out results --seeds 20"
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
    /// Run part i of n: every n-th seed from the i-th on
    #[arg(long, value_name = "i/n", value_parser = shard)]
    shard: Option<Shard>,
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
    let plan = plan(args)?;
    let start = Instant::now();
    let before = Conditions::before();
    let bar = progress(plan.steps() as u64, "reproduce");
    let results = plan.run(|what| {
        bar.set_message(what.to_owned());
        bar.inc(1);
    })?;
    bar.finish_and_clear();
    let machine = Machine::here(plan.tier);
    let mut tables = Tables::new(&results, &machine, args.shard, command(), before);
    if !args.quick {
        tables.interpretations = sensitivity::sweep(&plan)?;
    }
    let paper = args.paper.as_ref().unwrap_or(&args.out);
    write_tables(&args.out, &tables)?;
    figures::draw_all(&paper.join("figures"), &tables)?;
    let seconds = start.elapsed().as_secs_f64();
    let summary = summary::write(&tables);
    write(&paper.join("summary.md"), &summary)?;
    match args.format {
        Format::Csv => emit(Format::Csv, &tables.table_1, |_| String::new())?,
        format => emit(format, &tables, |tables| {
            let place = format!(
                "{}, {}",
                paper.join("summary.md").display(),
                args.out.display()
            );
            summary::brief(tables, seconds, &place)
        })?,
    }
    Ok(if lists_agree(&results) {
        Outcome::Passed
    } else {
        Outcome::Failed
    })
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
    let plan = Plan::new(
        &args.scenes,
        seeds,
        frames,
        size.effort,
        args.machine.tier(),
    );
    Ok(match args.shard {
        Some(shard) => plan.shard(shard)?,
        None => plan,
    })
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

fn shard(text: &str) -> Result<Shard, String> {
    let parts = text
        .split_once('/')
        .and_then(|(index, of)| Some((index.parse().ok()?, of.parse().ok()?)));
    let (index, of) = parts.ok_or("expected i/n, as in 1/4")?;
    Ok(Shard { index, of })
}
