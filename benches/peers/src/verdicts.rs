//! Every engine of boxes under judgement: the cases of the claim `aabb`, each in a process of its own, since an engine that
//! crashes must not end the others' trial.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;
use std::time::Duration;

use miette::{IntoDiagnostic as _, WrapErr as _, miette};
use sdop::judge::process::Program;
use sdop::judge::wire::{Wire, ndjson};
use sdop::judge::{Claim, Options, Outcome, Verdict, examine};
use sdop::lab::scene::SceneFile;
use serde::Serialize;

use crate::boxes::{Frame, Slabs};
use crate::peer::{Entry, Setup, Work, roster};

/// Answer one case as an engine does: read it from standard input, print the pairs of each frame
#[derive(clap::Args)]
pub struct AnswerArgs {
    /// The engine's name
    engine: String,
}

/// Judge every engine of boxes by the cases of the claim aabb
#[derive(clap::Args)]
pub struct Args {
    /// Write verdicts.json and verdicts.md here
    #[arg(long)]
    out: Option<PathBuf>,
    /// The seed of the fresh cases
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Seconds that an engine has for a case
    #[arg(long, default_value_t = 20)]
    timeout: u64,
}

/// A scene without anything in it that an engine of boxes looks at.
const SCENE: &str =
    "name = \"case\"\nframes = 1\n[[bodies]]\nshape = \"box\"\nposes = [[0, 0, 0, 1, 0, 0, 0]]\n";

/// Runs `answer`.
///
/// # Errors
/// An engine that isn't here, a case that can't be read.
pub fn answer(args: &AnswerArgs) -> miette::Result<()> {
    let entry = roster().into_iter().find(|entry| entry.name == args.engine);
    let entry = entry.ok_or_else(|| miette!("no engine is called `{}`", args.engine))?;
    let case = ndjson::read(std::io::stdin().lock())
        .map_err(|problem| miette!("{problem}"))?
        .case;
    let mut out = std::io::stdout().lock();
    let mut say = |value: serde_json::Value| writeln!(out, "{value}").into_diagnostic();
    let has_changes = case.frames.iter().any(|frame| frame.was.is_some());
    if has_changes || case.frames[0].bodies.is_empty() {
        let why = if has_changes {
            "the set of bodies changes"
        } else {
            "no bodies"
        };
        return say(serde_json::json!({ "frame": 0, "skipped": why }));
    }
    let frames: Vec<Frame> = case.frames.iter().map(frame).collect();
    let scene = SceneFile::parse(SCENE, "case", &PathBuf::new())?.build()?;
    let mut peer = (entry.new)(&Setup {
        scene: &scene,
        first: &frames[0],
        threads: 1,
    })?;
    for (number, frame) in frames.iter().enumerate() {
        peer.frame(frame);
        peer.settle();
        let mut pairs = peer.pairs();
        pairs.iter_mut().for_each(|pair| pair.sort_unstable());
        say(serde_json::json!({ "frame": number, "pairs": pairs }))?;
    }
    Ok(())
}

/// A frame of a case as engines take it.
fn frame(frame: &sdop::judge::Frame) -> Frame {
    let slabs = |ends: &[f32; 6]| -> Slabs { [0, 1, 2].map(|axis| [ends[axis], ends[axis + 3]]) };
    let boxes: Vec<Slabs> = frame.boxes.iter().map(slabs).collect();
    let radius = |slabs: &Slabs| {
        slabs
            .iter()
            .map(|[lo, hi]| (hi - lo) / 2.0)
            .fold(0.0, f32::max)
    };
    Frame {
        radii: boxes.iter().map(radius).collect(),
        boxes,
        bodies: frame.bodies.clone(),
    }
}

/// An engine's line.
#[derive(Serialize)]
struct Row {
    engine: &'static str,
    version: &'static str,
    claim: Claim,
    seed: Option<u64>,
    cases: usize,
    passed: usize,
    failed: usize,
    errors: usize,
    skipped: usize,
    required: u64,
    missed: u64,
    extra: u64,
    by_rounding: u64,
    both_static: u64,
    /// Cases that failed or erred, by group.
    against: BTreeMap<String, usize>,
    /// The first trouble, in a sentence.
    first: Option<String>,
    /// Depth of the smallest miss that was found, in ulps.
    smallest_miss_ulps: Option<u64>,
}

/// Runs `verdicts`.
///
/// # Errors
/// A case that can't be made, a directory that can't be written.
pub fn run(args: &Args) -> miette::Result<()> {
    let program = std::env::current_exe().into_diagnostic()?;
    let mut rows = Vec::new();
    for entry in roster()
        .into_iter()
        .filter(|entry| entry.work == Work::Boxes)
    {
        let subject = Program {
            command: format!("exec '{}' answer '{}'", program.display(), entry.name),
            wire: Wire::Ndjson,
            timeout: Duration::from_secs(args.timeout),
        };
        let options = Options {
            claim: Claim::Aabb,
            seed: Some(args.seed),
            shrink_time: Duration::from_secs(20),
            ..Options::default()
        };
        let verdict = examine(&subject, &options, |_, _| {}).into_diagnostic()?;
        eprintln!("{}: {verdict}", entry.name);
        rows.push(row(&entry, &verdict));
    }
    let page = page(&rows);
    if let Some(directory) = &args.out {
        let json = serde_json::to_string_pretty(&rows).into_diagnostic()?;
        for (name, text) in [("verdicts.json", &json), ("verdicts.md", &page)] {
            let path = directory.join(name);
            std::fs::write(&path, text)
                .into_diagnostic()
                .wrap_err_with(|| format!("cannot write {}", path.display()))?;
        }
    }
    print!("{page}");
    Ok(())
}

fn row(entry: &Entry, verdict: &Verdict) -> Row {
    let count = |is: fn(&Outcome) -> bool| {
        verdict
            .cases
            .iter()
            .filter(|case| is(&case.outcome))
            .count()
    };
    let pairs = verdict.pairs();
    let mut against = BTreeMap::new();
    let bad = || {
        verdict
            .cases
            .iter()
            .filter(|case| verdict.counts_against(case))
    };
    for case in bad() {
        *against.entry(case.group().to_owned()).or_default() += 1;
    }
    let first = bad().next().map(|case| match &case.outcome {
        Outcome::Fail { why } => format!("{}: {why}", case.name),
        Outcome::Error { trouble } => format!("{}: {trouble}", case.name),
        _ => String::new(),
    });
    let witness = verdict
        .smallest
        .as_ref()
        .and_then(|smallest| smallest.witness.as_ref());
    Row {
        engine: entry.name,
        version: entry.version,
        claim: verdict.claim,
        seed: verdict.seed,
        cases: verdict.cases.len(),
        passed: count(|o| *o == Outcome::Pass),
        failed: count(|o| matches!(o, Outcome::Fail { .. })),
        errors: count(|o| matches!(o, Outcome::Error { .. })),
        skipped: count(|o| matches!(o, Outcome::Skipped { .. })),
        required: pairs.required,
        missed: pairs.missed,
        extra: pairs.extra,
        by_rounding: pairs.by_rounding,
        both_static: pairs.both_static,
        against,
        first,
        smallest_miss_ulps: witness.and_then(|witness| witness.depth_ulps),
    }
}

/// The rows as a page. Formatting into a String cannot fail.
fn page(rows: &[Row]) -> String {
    let mut page = String::from(
        "# Verdicts on engines of boxes\n\n\
         Claim `aabb`: two given boxes that share a point, touching included, are reported. Cases with a changing set of bodies or\n\
         without bodies are skipped. An engine that widens boxes reports extra pairs, and may.\n\n\
         | engine | version | passed | failed | errors | skipped | required | missed | smallest miss, ulp | extra, by rounding | groups |\n\
         |---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    for row in rows {
        let groups: Vec<String> = row
            .against
            .iter()
            .map(|(group, n)| format!("{group} {n}"))
            .collect();
        let miss = row
            .smallest_miss_ulps
            .map_or_else(String::new, |ulps| ulps.to_string());
        let _ = writeln!(
            page,
            "| {} | {} | {} | {} | {} | {} | {} | {} | {miss} | {}, {} | {} |",
            row.engine,
            row.version,
            row.passed,
            row.failed,
            row.errors,
            row.skipped,
            row.required,
            row.missed,
            row.extra,
            row.by_rounding,
            groups.join(", ")
        );
    }
    page
}
