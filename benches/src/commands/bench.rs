//! `sdop bench --exec`: times another program and ours on the same frames.

use std::path::PathBuf;
use std::time::Duration;

use miette::IntoDiagnostic as _;
use sdop_bench::outsiders::{ContestantTiming, OwnPrices, compare, frames, strategy};
use sdop_bench::report::digits::number;
use sdop_bench::scene::SceneFile;
use sdop_judge::process::Program;
use sdop_judge::wire::Wire;
use sdop_judge::{Claim, Outcome as CaseOutcome};
use serde::Serialize;

use super::output::{Format, emit, paragraphs, rows};
use super::{Outcome, one_of};

/// Compare the time of a program with ours on a scene's frames
///
/// Every frame is judged before its time counts. A program's time is the `ns` that it reports with
/// each answer; the table marks it as self-reported. Our time is the wall time of the call. The two
/// programs take turns. If the program also reports `nu`, the volumes that it updated, and `nv`,
/// the pairs that it tested, a second table has T = Nu·Cu + F + Nv·Cv of both, at our prices.
#[derive(clap::Args)]
#[command(
    after_help = "Example: sdop bench data/scenes/paper-500.toml --exec ./mine --wire text --claims sphere --frames 50"
)]
pub struct Args {
    /// The scene
    scene: PathBuf,
    /// The program: a shell command that reads cases and answers with pairs
    #[arg(long, value_name = "CMD")]
    exec: String,
    /// What the program claims never to miss
    #[arg(long, value_name = "CLAIM", default_value_t = Claim::Mesh, value_parser = one_of::<Claim>(Claim::NAMES))]
    claims: Claim,
    /// Encoding of the program's input and output
    #[arg(long, value_name = "WIRE", default_value_t = Wire::Ndjson, value_parser = one_of::<Wire>(Wire::NAMES))]
    wire: Wire,
    /// Frames
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(2..=100_000))]
    frames: u32,
    /// Turns per program
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=1000))]
    rounds: u32,
    /// Time limit per turn, in seconds, plus one second per megabyte of input
    #[arg(long, value_name = "S", default_value_t = 60)]
    timeout: u64,
    /// Output format
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Runs the command.
///
/// # Errors
/// A scene that can't be run.
pub fn run(args: &Args) -> miette::Result<Outcome> {
    let scene = SceneFile::read(&args.scene)?.build()?;
    let case = frames(&scene, args.frames, args.claims).into_diagnostic()?;
    let program = Program {
        command: args.exec.clone(),
        wire: args.wire,
        timeout: Duration::from_secs(args.timeout),
    };
    let table = compare(&args.exec, &program, &case, args.rounds).into_diagnostic()?;
    let has_counts = table.last().is_some_and(|theirs| theirs.counts.is_some());
    let prices = match strategy(args.claims).filter(|_| has_counts) {
        Some(strategy) => OwnPrices::of(&scene, strategy, args.frames)?,
        None => None,
    };
    let report = BenchReport { prices, contestants: table };
    match args.format {
        Format::Csv => emit(Format::Csv, &report.contestants, |_| String::new())?,
        format => emit(format, &report, |report| page(report, args))?,
    }
    let table = report.contestants;
    Ok(outcome(&table))
}

/// What is printed.
#[derive(Serialize)]
struct BenchReport {
    prices: Option<OwnPrices>,
    contestants: Vec<ContestantTiming>,
}

/// A contestant that fails takes precedence over one that skips the scene.
fn outcome(table: &[ContestantTiming]) -> Outcome {
    let mut skipped = None;
    for ContestantTiming { name, outcome, .. } in table {
        match outcome {
            CaseOutcome::Pass => {}
            CaseOutcome::Fail { why } => return Outcome::Failed(format!("{name} {why}")),
            CaseOutcome::Error { trouble } => return Outcome::Failed(format!("{name} {trouble}")),
            CaseOutcome::Skipped { why } => {
                skipped.get_or_insert_with(|| format!("{name} skipped the scene: {why}"));
            }
        }
    }
    skipped.map_or(Outcome::Passed, Outcome::Incomplete)
}

fn page(report: &BenchReport, args: &Args) -> String {
    let header = ["contestant", "judged", "pairs", "median ns per frame", "clock"];
    let line = |row: &ContestantTiming| {
        let judged = match &row.outcome {
            CaseOutcome::Pass => "pass".to_owned(),
            CaseOutcome::Fail { why } => format!("FAIL: {why}"),
            CaseOutcome::Skipped { why } => format!("skipped: {why}"),
            CaseOutcome::Error { trouble } => format!("ERROR: {trouble}"),
        };
        let time = row.median_ns.map_or_else(|| "none".to_owned(), |ns| ns.to_string());
        vec![row.name.clone(), judged, row.reported.to_string(), time, row.clock.to_owned()]
    };
    let (claim, frames, rounds) = (args.claims, args.frames, args.rounds);
    let table = rows(&header, &report.contestants, line);
    let mut text = format!("claim {claim}, {frames} frames, {rounds} turns\n{table}");
    if report.contestants.iter().any(|it| it.outcome == CaseOutcome::Pass && it.median_ns.is_none())
    {
        text += "\n\nThe program reports no time: have it end each answer with `ns N`, or in NDJSON give it \
                 `\"ns\": N`, its nanoseconds for the frame.";
    }
    if let Some(prices) = report.prices {
        text += &format!("\n\n{}", terms(&report.contestants, prices, frames));
    }
    text
}

/// T of both by the formula, from their own counts and our prices.
fn terms(contestants: &[ContestantTiming], prices: OwnPrices, frames: u32) -> String {
    let us = |seconds: f64| number(1e6 * seconds);
    let header = ["per frame, µs", "Nu", "Nv", "Nu·Cu", "F", "Nv·Cv", "T", "measured"];
    let line = |(place, row): &(usize, &ContestantTiming)| {
        let counts = row.counts.unwrap_or([f64::NAN; 2]);
        let reported = row.reported as f64 / f64::from(frames);
        // How a program finds its pairs isn't known.
        let (update, finding, test) = match (*place, prices.of_counts(counts, reported)) {
            (0, _) => (prices.terms[0], Some(prices.terms[1]), prices.terms[2]),
            (_, [update, test]) => (update, None, test),
        };
        let sum = update + finding.unwrap_or_default() + test;
        let measured = row.median_ns.map_or("–".to_owned(), |ns| us(1e-9 * ns as f64));
        let finding = finding.map_or("–".to_owned(), us);
        let [nu, nv] = counts.map(number);
        vec![row.name.clone(), nu, nv, us(update), finding, us(test), us(sum), measured]
    };
    let all: Vec<(usize, &ContestantTiming)> = contestants.iter().enumerate().collect();
    let ns = |seconds: f64| number(1e9 * seconds);
    paragraphs(&format!(
        "T = Nu·Cu + F + Nv·Cv at our prices: Cu = {} ns, Cv = {} ns for a hit and {} ns for a miss\n{}\nWhat a program \
         measures beyond T, it pays for dearer updates and tests than ours, and for finding pairs.",
        ns(prices.update),
        ns(prices.hit),
        ns(prices.miss),
        rows(&header, &all, line)
    ))
}
