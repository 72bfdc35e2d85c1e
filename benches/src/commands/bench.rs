//! `sdop bench --exec`: times another program and ours on the same frames.

use std::path::PathBuf;
use std::time::Duration;

use miette::IntoDiagnostic as _;
use sdop_bench::outsiders::timing::{ContestantTiming, compare, frames};
use sdop_bench::scene::SceneFile;
use sdop_judge::process::Program;
use sdop_judge::wire::Wire;
use sdop_judge::{Claim, Outcome as CaseOutcome};

use super::output::{Format, emit, rows};
use super::{Outcome, one_of};

/// Compare the time of a program with ours on a scene's frames
///
/// Every frame is judged before its time counts. A program's time is the `ns` that it reports with
/// each answer; the table marks it as self-reported. Our time is the wall time of the call. The two
/// programs take turns.
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
    emit(args.format, &table, |table| page(table, args))?;
    Ok(outcome(&table))
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

fn page(table: &[ContestantTiming], args: &Args) -> String {
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
    format!(
        "claim {}, {} frames, {} turns\n{}",
        args.claims,
        args.frames,
        args.rounds,
        rows(&header, table, line)
    )
}
