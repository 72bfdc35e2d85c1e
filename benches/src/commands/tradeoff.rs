//! `sdop tradeoff`: measures what accuracy costs in time on one scene, and when it pays.

mod plot;
mod tables;

use std::path::{Path, PathBuf};

use etcetera::BaseStrategy as _;
use miette::{IntoDiagnostic as _, WrapErr as _, miette};
use sdop_bench::measure::conditions::Conditions;
use sdop_bench::sweep::MergedUnits;
pub use sdop_bench::tradeoff::study::NAME;
use sdop_bench::tradeoff::study::{Comparison, Settings};
use sdop_bench::tradeoff::{Findings, Tradeoff, TradeoffPlan};
use serde_json::{Value, json};

use super::Outcome;
use super::files::{self, command, write, write_json};
use super::output::{Format, csv_text, emit, emit_with_reason};
use super::scene_args::{MachineArgs, SceneArgs, VariantArgs};
use super::sweep::{self, SweepArgs};

/// Measure precision and time for every volume and strategy
///
/// Culls sample frames of the scene with every volume and strategy, compares the pairs with the
/// exact intersections of the meshes, and measures the time of frames that follow one another.
/// Counts depend only on scene and flags; times are those of this machine. If the argument is the
/// JSON of an earlier run, prints and draws that.
#[derive(clap::Args)]
#[command(after_help = "Exit code 1 when any strategy misses a true pair.\n\
    Examples: sdop tradeoff data/scenes/paper-500.toml --out target/tradeoff\n          \
    mpirun -n 8 sdop tradeoff data/scenes/paper-500.toml --seeds 64 --out target/tradeoff")]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs<VariantArgs>,
    #[command(flatten)]
    machine: MachineArgs,
    /// A shorter run with fewer seeds, frames and pairs: wider intervals in a quarter of the time
    #[arg(long)]
    quick: bool,
    /// Runs, with consecutive seeds from the scene's on [default: 5, or 2 with --quick]
    #[arg(long, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    seeds: Option<u64>,
    /// Print all tables, not only the recommendation and its basis
    #[arg(long)]
    all: bool,
    /// Write figures, JSON and CSV to this directory; from a record, `sdop report` makes the page
    /// paper/tradeoff.md
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Write the figures to this directory instead
    #[arg(long, value_name = "DIR", requires = "out")]
    paper: Option<PathBuf>,
    /// Cache of exact answers between runs [default: sdop/truth in the user's cache directory]
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    /// Output format
    #[arg(long, value_enum, default_value_t)]
    format: Format,
    #[command(flatten)]
    sweep: SweepArgs,
}

impl Args {
    /// Whether its work is cut into units, which many can share.
    pub fn is_sweep(&self) -> bool {
        recorded(&self.scene.path).is_none()
    }
}

/// Runs the command.
///
/// # Errors
/// A bad scene, settings that it can't have, files that can't be written.
pub fn run(args: &Args) -> miette::Result<Outcome> {
    if let Some(path) = recorded(&args.scene.path) {
        if let Some(flag) = args.sweep.arguments().first() {
            miette::bail!(
                help = format!("leave {flag} out"),
                "{flag}: an earlier run has no work to share"
            );
        }
        return args.print(&read(path)?);
    }
    sweep::enter(&args.sweep)?;
    let comparison = Comparison::new(&args.scene.read()?, &plan(args))?;
    let before = Conditions::before();
    let mut findings = Findings::default();
    let mut take = |_, result: &str| findings.take(result);
    let directory = args.out.as_deref().unwrap_or(Path::new("."));
    if args.sweep.run(&comparison, directory, &mut take)?.is_none() {
        return Ok(Outcome::Passed);
    }
    args.print(&finished(command(), findings, comparison.settings(), before)?)
}

/// What merged shards give.
///
/// # Errors
/// Results of another command, files that can't be written.
pub fn merged(merged: &MergedUnits, out: &Path, format: Format) -> miette::Result<Outcome> {
    let settings: Settings = merged.header.settings().into_diagnostic()?;
    let mut findings = Findings::default();
    for result in merged.done.values() {
        findings.take(result)?;
    }
    let (line, unknown) = (merged.header.line.clone(), Conditions::default());
    let result = finished(line, findings, settings, unknown)?;
    write_all(out, out, &result)?;
    print(&result, format, false)
}

fn finished(
    command: String,
    findings: Findings,
    settings: Settings,
    before: Conditions,
) -> miette::Result<Tradeoff> {
    let result = findings.finish(command, settings, before);
    result.ok_or_else(|| miette!("these are not the units of one comparison"))
}

impl Args {
    /// Writes and prints the requested results.
    fn print(&self, result: &Tradeoff) -> miette::Result<Outcome> {
        if let Some(directory) = &self.out {
            let paper = self.paper.as_ref().unwrap_or(directory);
            write_all(directory, paper, result)?;
        }
        print(result, self.format, self.all)
    }
}

fn print(result: &Tradeoff, format: Format, is_whole: bool) -> miette::Result<Outcome> {
    let failures: Vec<&str> = result.failures().collect();
    let why = (!failures.is_empty())
        .then(|| format!("true pairs were missed by: {}", failures.join("; ")));
    match format {
        Format::Csv => emit(Format::Csv, &result.rows(), |_| String::new())?,
        format => emit_with_reason(format, result, why.as_deref(), |result| {
            tables::text(result, is_whole)
        })?,
    }
    Ok(why.map_or(Outcome::Passed, Outcome::Failed))
}

fn plan(args: &Args) -> TradeoffPlan {
    let quick = |quick, thorough| if args.quick { quick } else { thorough };
    TradeoffPlan {
        seeds: args.seeds.unwrap_or(quick(2, 5)),
        samples: quick(6, 20) as u32,
        window: quick(30, 120) as u32,
        stride: 10,
        tier: args.machine.tier(),
        cache: args.cache.clone().or_else(cache),
    }
}

/// Where the user's programs keep what can be made again: on Linux `$XDG_CACHE_HOME`, or
/// `~/.cache`. None where there is no home either: then nothing is kept.
fn cache() -> Option<PathBuf> {
    let directories = etcetera::choose_base_strategy().ok()?;
    Some(directories.cache_dir().join("sdop/truth"))
}

/// The argument as the JSON of an earlier run, by its name.
fn recorded(path: &Path) -> Option<&Path> {
    path.extension().is_some_and(|ending| ending == "json").then_some(path)
}

fn read(path: &Path) -> miette::Result<Tradeoff> {
    serde_json::from_str(&files::read(path)?)
        .into_diagnostic()
        .wrap_err_with(|| format!("{} is no result of sdop tradeoff", path.display()))
}

/// Writes the numbers to one directory, the figures to another.
fn write_all(numbers: &Path, paper: &Path, result: &Tradeoff) -> miette::Result<()> {
    let csv = csv_text(serde_json::to_value(result.rows()).into_diagnostic()?)?;
    let seeds = csv_text(seeds(result).into())?;
    write_json(&numbers.join("tradeoff.json"), result)?;
    write(&numbers.join("tradeoff.csv"), &csv)?;
    write(&numbers.join("tradeoff-seeds.csv"), &seeds)?;
    for (name, svg) in figures(result)? {
        write(&paper.join("figures").join(name), &svg)?;
    }
    Ok(())
}

/// What every variant reported, seed by seed: equal on every machine.
fn seeds(result: &Tradeoff) -> Vec<Value> {
    let mut lines = Vec::new();
    for row in &result.rows {
        let found = result.seeds.iter().zip(&row.precisions).zip(&row.pairs_sha256);
        lines.extend(found.map(|((seed, precision), pairs_sha256)| {
            json!({
                "variant": row.name,
                "seed": seed,
                "precision": precision,
                "pairs_sha256": pairs_sha256,
            })
        }));
    }
    lines
}

/// The figures of a record's `tradeoff.json`, each with its file's name.
///
/// # Errors
/// Another text.
#[cfg_attr(not(feature = "maintain"), allow(dead_code, reason = "pages alone need it"))]
pub fn figures_of(recorded: &str) -> miette::Result<Vec<(String, String)>> {
    figures(&serde_json::from_str(recorded).into_diagnostic()?)
}

fn figures(result: &Tradeoff) -> miette::Result<Vec<(String, String)>> {
    Ok(vec![
        ("tradeoff.svg".into(), plot::precision(result)?),
        ("tradeoff-pays.svg".into(), plot::break_even(result)?),
        ("tradeoff-budget.svg".into(), plot::budget(result)?),
    ])
}
