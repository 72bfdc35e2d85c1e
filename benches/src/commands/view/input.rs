//! Loads the run to be shown: simulates a scene, reads a record, or builds a group of hard cases.

use std::fs::File;
use std::io::{BufReader, Read as _};
use std::path::Path;

use miette::{IntoDiagnostic as _, WrapErr as _, miette};
use sdop::Tier;
use sdop_bench::remedy::OrReport as _;
use sdop_bench::view::ShownRun;
use sdop_judge::answer::{Answer, StopReason, sorted};
use sdop_judge::draw::hard::HardCaseGroup;
use sdop_judge::record::RecordError;
use sdop_judge::wire::{Wire, ndjson::StoredCase};
use sdop_judge::{Case, Claim};

use crate::commands::check::{said, text};
use crate::commands::judge::read_case;
use crate::commands::output::progress;
use crate::commands::scene_args::SceneArgs;

/// What was found.
pub enum ViewInput {
    /// Something to show; with a record that is broken somewhere, what is wrong.
    Run(Box<ShownRun>, Option<RecordError>),
    /// A record with no frame that can be read.
    Broken(RecordError),
}

/// Reads what the path names. A record begins with a brace, a group of hard cases has a `[recipe]`,
/// anything else is a scene.
///
/// # Errors
/// A file that can't be read; a scene or case that can't be built; flags that the kind of file
/// can't have.
pub fn read(
    args: &SceneArgs,
    run: Option<usize>,
    answers: Option<&Path>,
    tier: Tier,
) -> miette::Result<ViewInput> {
    let (path, most) = (&*args.path, args.max_bytes());
    if is_record(path)? {
        if answers.is_some() || is_claimed(path, most).unwrap_or(false) {
            refuse(args, run, "its poses are given")?;
            let show = judged((path, most), answers)?;
            return Ok(ViewInput::Run(Box::new(show), None));
        }
        return record(args, run);
    }
    if answers.is_some() {
        return Err(miette!(
            help = "cases are written by `sdop cases` and, for a miss, by `sdop judge`",
            "--answers needs a case or record (.ndjson); {} is neither",
            path.display()
        ));
    }
    if is_case(path, most) {
        return Ok(ViewInput::Run(Box::new(case(args, run.unwrap_or(0), tier)?), None));
    }
    if run.is_some() {
        return Err(miette!(
            help = "leave --run out",
            "--run is for groups of hard cases; {} is a scene",
            path.display()
        ));
    }
    let scene = args.read_culled()?.build()?;
    let bar = progress(scene.frames.into(), &scene.name);
    let show = ShownRun::scene(&scene, path, tier, || bar.inc(1))?;
    bar.finish_and_clear();
    Ok(ViewInput::Run(Box::new(show), None))
}

fn is_record(path: &Path) -> miette::Result<bool> {
    if path.extension().is_some_and(|ending| ending == "ndjson" || ending == "jsonl") {
        return Ok(true);
    }
    let mut start = [0; 64];
    let read = File::open(path).and_then(|mut file| file.read(&mut start));
    let read =
        read.into_diagnostic().wrap_err_with(|| format!("{}: cannot be read", path.display()))?;
    Ok(start[..read].trim_ascii_start().starts_with(b"{"))
}

/// Whether a TOML file has a recipe. What is no TOML, or can't be read, is left to the scene's
/// reader, which says so.
fn is_case(path: &Path, most: u64) -> bool {
    let table =
        sdop::files::read_text(path, most).ok().and_then(|text| text.parse::<toml::Table>().ok());
    table.is_some_and(|table| table.contains_key("recipe"))
}

/// Whether it is a case of the judge: its first line has claims, unlike that of a record.
fn is_claimed(path: &Path, most: u64) -> Option<bool> {
    #[derive(serde::Deserialize)]
    struct Mark {
        claims: Option<Vec<Claim>>,
    }
    let mut line = Vec::new();
    let mut file = BufReader::new(File::open(path).ok()?);
    sdop::files::read_line(&mut file, most, &mut line).ok()?;
    let mark: Mark = serde_json::from_slice(&line).ok()?;
    Some(mark.claims.is_some_and(|claims| !claims.is_empty()))
}

/// A case with the pairs that its file has or that `answers` has; a line, and the answers, have at
/// most `most` bytes.
fn judged((path, most): (&Path, u64), answers: Option<&Path>) -> miette::Result<ShownRun> {
    let StoredCase { case, pairs, .. } = read_case(path, most)?;
    let given = match answers {
        None => {
            let answer =
                |pairs: Option<Vec<_>>| pairs.map(|pairs| Answer { pairs, ..Answer::default() });
            pairs.into_iter().map(answer).collect::<Option<Vec<_>>>()
        }
        Some(file) => Some(answered(&case, file, most)?),
    };
    let name = answers.unwrap_or(path).display();
    let sort = |answers: Vec<Answer>| {
        let frames = case.frames.iter().zip(&answers).enumerate();
        frames
            .map(|(number, (frame, answer))| sorted(number, frame, answer))
            .collect::<Result<Vec<_>, _>>()
            .map_err(|trouble| {
                miette!(
                    help = "a pair is two bodies of the case, the smaller number first",
                    "{name}: {trouble}"
                )
            })
    };
    let reported = given.map(sort).transpose()?;
    let unasked = reported.is_none();
    let mut show = ShownRun::case(&case, reported, path)
        .map_err(|why| miette!(help = "view another case", "{}: {why}", path.display()))?;
    if unasked {
        let words = "Nobody has answered this case: --answers FILE shows what a program reports.";
        show.messages.push(words.to_owned());
    }
    Ok(show)
}

/// The answers in a file, in either encoding.
fn answered(case: &Case, file: &Path, most: u64) -> miette::Result<Vec<Answer>> {
    let text = text(file, most)?;
    let wire = match text.trim_ascii_start().first() {
        Some(b'{') => Wire::Ndjson,
        _ => Wire::Text,
    };
    let hint = "an answer is {\"frame\":n,\"pairs\":[[i,j],…]}, a line for each frame of the case";
    let (name, frames) = (file.display(), case.frames.len());
    match said(wire, &text, frames) {
        Ok(answers) if answers.len() == frames => Ok(answers),
        Ok(answers) => {
            Err(miette!(help = hint, "{name}: {} answers to {frames} frames", answers.len()))
        }
        Err(StopReason::Skipped { why, .. }) => Err(miette!("{name}: the case was skipped: {why}")),
        Err(StopReason::Trouble(trouble)) => Err(miette!(help = hint, "{name}: {trouble}")),
    }
}

/// Rejects flags that have no effect on what is shown.
fn refuse(args: &SceneArgs, run: Option<usize>, why: &str) -> miette::Result<()> {
    match args.scene_only().or(run.map(|_| "--run")) {
        None => Ok(()),
        Some(flag) => Err(miette!(
            help = "--beside STRATEGY culls its frames again",
            "{}: {why}; {flag} can't change it",
            args.path.display()
        )),
    }
}

fn record(args: &SceneArgs, run: Option<usize>) -> miette::Result<ViewInput> {
    refuse(args, run, "a record is shown as it was culled")?;
    match ShownRun::record(&args.path, args.frames) {
        Ok((show, broken)) => Ok(ViewInput::Run(Box::new(show), broken)),
        // Nothing there is no record that is broken.
        Err(error @ RecordError::Unreadable { .. }) => Err(error).or_report(),
        Err(error) => Ok(ViewInput::Broken(error)),
    }
}

fn case(args: &SceneArgs, run: usize, tier: Tier) -> miette::Result<ShownRun> {
    let path = &*args.path;
    let name = path.display();
    let text = std::fs::read_to_string(path)
        .into_diagnostic()
        .wrap_err_with(|| format!("{name}: cannot be read"))?;
    let group = HardCaseGroup::parse(&text)
        .into_diagnostic()
        .wrap_err_with(|| format!("{name}: no group of hard cases"))?;
    if args.seed.is_some() {
        return Err(miette!(
            help = "leave --seed out",
            "{name}: a group of hard cases has its own seed"
        ));
    }
    let settings = args.settings();
    let cases = group
        .cases(settings.k, settings.axes)
        .into_diagnostic()
        .wrap_err_with(|| format!("{name}: can't be made"))?;
    let frames = cases.runs.get(run).ok_or_else(|| {
        miette!(help = "runs are counted from 0", "{name}: run {run} of {}", cases.runs.len())
    })?;
    let most = args.frames.map_or(frames.len(), |most| frames.len().min(most as usize));
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let mut show =
        ShownRun::poses(&stem, path, cases.shapes.built.clone(), &frames[..most], &settings, tier)
            .or_report()?;
    show.header.seed = group.seed;
    show.messages.push(group.why.clone());
    if cases.runs.len() > 1 {
        show.messages.push(format!("Run {run} of {}; --run N shows another.", cases.runs.len()));
    }
    Ok(show)
}
