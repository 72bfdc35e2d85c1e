//! `sdop board`: judges other libraries, and writes a record and one page.

use std::path::PathBuf;
use std::time::Duration;

use miette::{IntoDiagnostic as _, miette};
use sdop_bench::board::{Board, CellVerdict, Row, Speed, judge, page};
use sdop_bench::outsiders::frames;
use sdop_bench::roster::{Roster, RosterRow};
use sdop_bench::scene::{Scene, SceneFile};
use sdop_judge::process::Program;
use sdop_judge::wire::Wire;

use super::Outcome;
use super::files;
use super::output::{print, progress, rows};

/// Judge other libraries by their adapters, and write a page of their misses
///
/// Every adapter is judged on the published cases of its claim. `benches/adapters/install` installs
/// the libraries that the adapters need. board.json has every number. board.html is one page that
/// opens from disk; each of its cells shows its groups and the smallest case of a miss.
#[derive(clap::Args)]
#[command(
    after_help = "Examples: sdop board --out target/board\n          sdop board rtree coal --check\n          sdop board --quick --check\n          sdop board --timed data/scenes/crowded-500.toml --out target/board"
)]
pub struct Args {
    /// Names of adapters (default: all)
    #[arg(value_name = "NAME")]
    names: Vec<String>,
    /// Only adapters that are quick to install and run
    #[arg(long)]
    quick: bool,
    /// Only cases with these names: * matches any text, ? one character
    #[arg(long, value_name = "GLOB", default_value = "*")]
    case: String,
    /// Directory for board.json and board.html
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Exit with 1 if a verdict or a version differs from the table of engines
    #[arg(long)]
    check: bool,
    /// The table of engines
    #[arg(
        long,
        value_name = "FILE",
        alias = "claims",
        default_value = "benches/field/engines.toml"
    )]
    engines: PathBuf,
    /// Time the libraries and ours on this scene instead of judging them, and write times.json
    #[arg(long, value_name = "SCENE", conflicts_with_all = ["case", "check", "times"])]
    timed: Option<PathBuf>,
    /// A times.json, for the page
    #[arg(long, value_name = "FILE")]
    times: Option<PathBuf>,
}

/// Frames of the timed scene.
const FRAMES: u32 = 12;

/// Runs the command.
///
/// # Errors
/// The table can't be read, an adapter doesn't exist, or files can't be written.
pub fn run(args: &Args) -> miette::Result<Outcome> {
    let roster = Roster::parse(&files::read(&args.engines)?)
        .map_err(|problem| miette!("{}: {problem}", args.engines.display()))?;
    match &args.timed {
        Some(scene) => time_all(args, &roster, &SceneFile::read(scene)?.build()?),
        None => judge_all(args, &roster),
    }
}

fn judge_all(args: &Args, roster: &Roster) -> miette::Result<Outcome> {
    let times = match &args.times {
        Some(file) => serde_json::from_str(&files::read(file)?).into_diagnostic()?,
        None => Vec::new(),
    };
    let mut board = Board {
        code: env!("CARGO_PKG_VERSION").to_owned(),
        adapters: Vec::new(),
        not_run: roster.not_run.clone(),
        times,
    };
    for adapter in chosen(args, roster)? {
        let bar = progress(0, &adapter.name);
        let show = |done: usize, of: usize| {
            bar.set_length(of as u64);
            bar.set_position(done as u64);
        };
        let command = roster.command(adapter);
        let row = judge(adapter, &command, &args.case, show).into_diagnostic()?;
        bar.finish_and_clear();
        eprintln!("{}", line(&row).join("  "));
        board.adapters.push(row);
    }
    print(&rows(&HEADER, &board.adapters, line).to_string())?;
    if let Some(out) = &args.out {
        files::write_json(&out.join("board.json"), &board)?;
        files::write(&out.join("board.html"), page(&board).into_diagnostic()?)?;
    }
    let changed: Vec<String> = board.adapters.iter().filter_map(changed).collect();
    Ok(match changed.as_slice() {
        [_, ..] if args.check => Outcome::Failed(changed.join("; ")),
        _ => Outcome::Passed,
    })
}

/// Times each library once, in a new process and by its first claim, and our culler once per claim.
fn time_all(args: &Args, roster: &Roster, scene: &Scene) -> miette::Result<Outcome> {
    let mut times: Vec<Speed> = Vec::new();
    let is_first = |adapter: &&RosterRow| adapter.name == adapter.base;
    for adapter in chosen(args, roster)?.into_iter().filter(is_first) {
        let claim = adapter.claim;
        let case = frames(scene, FRAMES, claim).into_diagnostic()?;
        if !times.iter().any(|time| time.claim == claim) {
            times.extend(Speed::ours(&case).into_diagnostic()?);
        }
        let program = Program {
            command: roster.command(adapter),
            wire: Wire::Ndjson,
            timeout: Duration::from_secs(120),
        };
        times.extend(Speed::of(&adapter.name, &program, &case).into_diagnostic()?);
    }
    let header = ["contestant", "claim", "recall", "ns per frame"];
    let line = |time: &Speed| {
        let Speed { name, claim, .. } = time;
        let [recall, ns] = [time.recall.to_string(), time.median_ns.to_string()];
        vec![name.clone(), claim.to_string(), recall, ns]
    };
    print(&rows(&header, &times, line).to_string())?;
    if let Some(out) = &args.out {
        files::write_json(&out.join("times.json"), &times)?;
    }
    Ok(Outcome::Passed)
}

fn chosen<'a>(args: &Args, roster: &'a Roster) -> miette::Result<Vec<&'a RosterRow>> {
    let known = |name: &&String| roster.engine.iter().any(|adapter| adapter.name == **name);
    if let Some(name) = args.names.iter().find(|name| !known(name)) {
        let names: Vec<&str> = roster.engine.iter().map(|adapter| adapter.name.as_str()).collect();
        return Err(miette!(help = format!("one of: {}", names.join(", ")), "no adapter `{name}`"));
    }
    let wanted = |adapter: &&RosterRow| {
        (args.names.is_empty() || args.names.contains(&adapter.name))
            && (!args.quick || adapter.quick)
            && !adapter.verdict.is_empty()
    };
    Ok(roster.engine.iter().filter(wanted).collect())
}

const HEADER: [&str; 8] =
    ["adapter", "version", "claim", "cases", "of", "required", "missed", "verdict"];

fn line(row: &Row) -> Vec<String> {
    let (adapter, total) = (&row.adapter, &row.total);
    let judged = total.passed + total.failed;
    let verdict = row
        .how
        .as_ref()
        .map_or_else(|| row.outcome.name().to_owned(), |how| format!("not run: {how}"));
    vec![
        adapter.name.clone(),
        row.found.clone(),
        adapter.claim.to_string(),
        judged.to_string(),
        (judged + total.skipped + total.errors).to_string(),
        total.pairs.required.to_string(),
        total.pairs.missed.to_string(),
        verdict,
    ]
}

/// The difference from the table of engines, if there is one.
fn changed(row: &Row) -> Option<String> {
    let (adapter, name) = (&row.adapter, &row.adapter.name);
    if let Some(how) = &row.how {
        return Some(format!("{name} could not be run: {how}"));
    }
    let [found, known] = [&row.found, &adapter.version];
    if found != known {
        return Some(format!("{name} is version {found}, and the table has {known}"));
    }
    let (found, known) = (row.outcome, &adapter.verdict);
    let reasons = || row.cells.iter().filter(|cell| cell.outcome == CellVerdict::Error);
    let why: Vec<&str> =
        reasons().flat_map(|cell| cell.reasons.keys()).take(2).map(String::as_str).collect();
    (found.name() != known).then(|| {
        format!("{name}: {}, and the table has {known} {}", found.name(), why.join(", "))
            .trim_end()
            .to_owned()
    })
}
