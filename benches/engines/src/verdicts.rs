//! Judging every engine by the cases of its claim. Each case runs in a separate process, so that a
//! crashing engine does not affect the others.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::Duration;

use miette::{IntoDiagnostic as _, miette};
use sdop_bench::scene::{Scene, SceneFile};
use sdop_judge::process::Program;
use sdop_judge::wire::{Wire, ndjson};
use sdop_judge::{Case, Claim, Options, Outcome, Verdict, examine};
use serde::Serialize;

use crate::boxes::{Frame, Slabs};
use crate::entry::{Engine, Entry, Setup};
use crate::facts::{self, Facts};
use crate::narrow;
use crate::roster::roster;

/// Answer one case with an engine: read it from standard input, print the pairs of each frame
#[derive(clap::Args)]
pub struct AnswerArgs {
    /// The engine's name
    engine: String,
}

/// Judge every engine by the cases of its claim
#[derive(clap::Args)]
pub struct Args {
    /// The seed of the fresh cases
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Time limit per case, in seconds
    #[arg(long, default_value_t = 20)]
    timeout: u64,
    /// Time limit for reducing the scene of a miss, in seconds
    #[arg(long, default_value_t = 20)]
    shrink: u64,
    /// Other load on the machine, for the record
    #[arg(long, default_value = "nothing said of other work")]
    note: String,
    /// Write verdicts.csv, verdicts.json and verdicts.md here
    #[arg(long)]
    out: Option<PathBuf>,
}

/// The longest case.
const MOST_BYTES: u64 = 1 << 30;

/// A scene whose shapes and bodies a case replaces.
const SCENE: &str =
    "name = 'case'\nframes = 1\n[[bodies]]\nshape = 'box'\nposes = [[0, 0, 0, 1, 0, 0, 0]]\n";

/// Engines, and tests of single pairs.
fn everyone() -> Vec<Entry> {
    [roster(), narrow::ENTRIES.to_vec()].concat()
}

/// Runs `answer`. An engine whose set of bodies changes is made anew; one without bodies isn't
/// asked.
///
/// # Errors
/// An engine that isn't here, a case that can't be read.
pub fn answer(args: &AnswerArgs) -> miette::Result<()> {
    let entry = everyone().into_iter().find(|entry| entry.name == args.engine);
    let entry = entry.ok_or_else(|| miette!("no engine is called `{}`", args.engine))?;
    let read = ndjson::read(std::io::stdin().lock(), MOST_BYTES);
    let case = read.map_err(|problem| miette!("{problem}"))?.case;
    let mut scene = SceneFile::parse(SCENE, "case", Path::new(""))?.build()?;
    scene.shapes.clone_from(&case.shapes);
    scene.side = Some(reach(&case));
    let mut engine: Option<Engine> = None;
    let mut out = std::io::stdout().lock();
    for (number, given) in case.frames.iter().enumerate() {
        let frame = frame(given, &scene);
        if given.was.is_some() {
            engine = None;
        }
        let mut pairs = Vec::new();
        if !frame.boxes.is_empty() {
            let engine = match &mut engine {
                Some(engine) => engine,
                none => {
                    let setup = Setup { scene: &scene, first: &frame, threads: 1 };
                    match (entry.new)(&setup) {
                        Ok(made) => none.insert(made),
                        Err(problem) => {
                            let why = serde_json::json!({ "frame": number, "skipped": problem.to_string() });
                            return writeln!(out, "{why}").into_diagnostic();
                        }
                    }
                }
            };
            engine.frame(&frame);
            engine.settle();
            pairs = engine.pairs();
        }
        // Engines do not know which bodies are static: all boxes meet all.
        pairs.retain(|pair| pair.iter().any(|&body| moves(&frame, body)));
        pairs.iter_mut().for_each(|pair| pair.sort_unstable());
        let line = serde_json::json!({ "frame": number, "pairs": pairs });
        writeln!(out, "{line}").into_diagnostic()?;
    }
    Ok(())
}

/// Whether a body may move; so may one that doesn't exist, for the judge to see.
fn moves(frame: &Frame, body: u32) -> bool {
    frame.bodies.dynamic.get(body as usize) != Some(&false)
}

/// The largest coordinate of a case's boxes, for engines that want to know their world.
fn reach(case: &Case) -> f32 {
    let boxes = case.frames.iter().flat_map(|frame| &frame.boxes);
    boxes.flatten().fold(1.0, |most: f32, end| most.max(end.abs()))
}

/// A frame of a case as engines take it.
fn frame(given: &sdop_judge::Frame, scene: &Scene) -> Frame {
    let slabs = |ends: &[f32; 6]| -> Slabs { [0, 1, 2].map(|axis| [ends[axis], ends[axis + 3]]) };
    let mut frame = Frame::default();
    frame.fill(&given.bodies, &scene.shapes);
    frame.set_boxes(given.boxes.iter().map(slabs).collect());
    frame
}

/// An engine's line.
#[derive(Serialize)]
struct EngineVerdict {
    engine: &'static str,
    version: &'static str,
    claim: Claim,
    cases: usize,
    passed: usize,
    failed: usize,
    errors: usize,
    skipped: usize,
    required: u64,
    missed: u64,
    /// Depth of the smallest miss that was found, in ulps of the pair's largest coordinate.
    smallest_miss_ulps: Option<u64>,
    /// In which case.
    smallest_miss_case: Option<String>,
    extra: u64,
    extra_by_rounding: u64,
    /// Cases that failed or erred, by group.
    against: String,
    /// The first trouble, in a sentence.
    first: String,
}

/// What is written.
#[derive(Serialize)]
struct Verdicts {
    #[serde(flatten)]
    facts: Facts,
    seed: u64,
    rows: Vec<EngineVerdict>,
}

/// Runs `verdicts`.
///
/// # Errors
/// A case that can't be made, a directory that can't be written.
pub fn run(args: &Args) -> miette::Result<()> {
    let program = std::env::current_exe().into_diagnostic()?;
    let mut verdicts =
        Verdicts { facts: Facts::new(args.note.clone()), seed: args.seed, rows: Vec::new() };
    for entry in everyone() {
        let subject = Program {
            command: format!("exec '{}' answer '{}'", program.display(), entry.name),
            wire: Wire::Ndjson,
            timeout: Duration::from_secs(args.timeout),
        };
        let options = Options {
            claim: entry.work.claim(),
            seed: Some(args.seed),
            shrink_time: Duration::from_secs(args.shrink),
            ..Options::default()
        };
        let verdict = examine(&subject, &options, |_, _| {}).into_diagnostic()?;
        eprintln!("{}: {verdict}", entry.name);
        verdicts.rows.push(EngineVerdict::of(&entry, &verdict));
        verdicts.facts.look_again();
    }
    let page = page(&verdicts);
    if let Some(directory) = &args.out {
        let csv = facts::csv(&verdicts.rows)?;
        facts::write(directory, "verdicts", csv, &verdicts, page.clone())?;
    }
    print!("{page}");
    Ok(())
}

impl EngineVerdict {
    fn of(entry: &Entry, verdict: &Verdict) -> Self {
        let count = |is: fn(&Outcome) -> bool| {
            let cases = verdict.cases.iter();
            cases.filter(|case| is(&case.outcome)).count()
        };
        let cases = verdict.cases.iter();
        let bad: Vec<_> = cases.filter(|case| case.counts_against()).collect();
        let mut against: BTreeMap<&str, usize> = BTreeMap::new();
        for case in &bad {
            *against.entry(case.group()).or_default() += 1;
        }
        let against = against.iter().map(|(group, n)| format!("{group} {n}"));
        let first = bad.first().map(|case| match &case.outcome {
            Outcome::Error { trouble } => format!("{}: {trouble}", case.name),
            Outcome::Fail { why } | Outcome::Skipped { why } => format!("{}: {why}", case.name),
            Outcome::Pass => String::new(),
        });
        let pairs = verdict.pairs();
        let smallest = verdict.smallest.as_ref();
        Self {
            engine: entry.name,
            version: entry.version,
            claim: verdict.claim,
            cases: verdict.cases.len(),
            passed: count(|outcome| *outcome == Outcome::Pass),
            failed: count(|outcome| matches!(outcome, Outcome::Fail { .. })),
            errors: count(|outcome| matches!(outcome, Outcome::Error { .. })),
            skipped: count(|outcome| matches!(outcome, Outcome::Skipped { .. })),
            required: pairs.required,
            missed: pairs.missed,
            smallest_miss_ulps: smallest.and_then(|smallest| smallest.witness.as_ref()?.depth_ulps),
            smallest_miss_case: smallest.map(|smallest| smallest.case.name.clone()),
            extra: pairs.extra,
            extra_by_rounding: pairs.by_rounding,
            against: against.collect::<Vec<_>>().join(", "),
            first: first.unwrap_or_default(),
        }
    }
}

/// The rows as a page.
fn page(verdicts: &Verdicts) -> String {
    let Verdicts { facts, seed, rows } = verdicts;
    let mut page = format!(
        "# Verdicts\n\n{facts}- published cases and those of seed {seed}; one thread, made anew for each case\n\n\
         | engine | claim | cases | passed | failed | errors | skipped | pairs required | missed | smallest miss, ulps | extra | by rounding | against |\n\
         |---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|---|\n"
    );
    for row in rows {
        let ulps = row.smallest_miss_ulps.map(|ulps| ulps.to_string());
        // Writing to a String cannot fail.
        let _ = writeln!(
            page,
            "| {} {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |",
            row.engine,
            row.version,
            row.claim,
            row.cases,
            row.passed,
            row.failed,
            row.errors,
            row.skipped,
            row.required,
            row.missed,
            ulps.unwrap_or_default(),
            row.extra,
            row.extra_by_rounding,
            row.against,
        );
    }
    page
}
