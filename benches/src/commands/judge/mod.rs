//! `sdop judge CMD`: tests any program against the exact reference.

mod print;

use std::collections::BTreeSet;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use miette::{IntoDiagnostic as _, WrapErr as _, miette};
use sdop::files::MAX_BYTES;
use sdop_judge::as_test::{Language, unit_test};
use sdop_judge::broadmark;
use sdop_judge::process::{Program, Service};
use sdop_judge::report::{STEM, counter_example};
use sdop_judge::run::examine_given;
use sdop_judge::wire::{Wire, ndjson};
use sdop_judge::{Claim, Options, Subject, Verdict, examine};

use super::output::{print as say, progress};
use super::{Outcome, files, one_of};
pub use print::{ReportFormat, emit as emit_verdict};

/// Test your own culler, in any language, against the exact reference
///
/// The program reads cases on standard input and answers with pairs on standard output. Every
/// answer is compared with the exact one: a missed pair is a failure, an extra pair is counted. The
/// first miss is reduced to the smallest case that shows it. `examples/judge/README.md` says how to
/// write the program.
#[derive(clap::Args)]
#[command(
    after_help = "Examples: sdop judge ./my-culler --claims aabb\n          sdop judge 'python3 boxes.py' --claims aabb --no-fresh\n          sdop judge ./my-culler --replay missed-pair.ndjson"
)]
pub struct Args {
    /// The program, as a shell command
    #[arg(value_name = "CMD", required_unless_present = "exec")]
    command: Option<String>,
    /// The former name of CMD
    #[arg(long, value_name = "CMD", hide = true, conflicts_with = "command")]
    exec: Option<String>,
    /// What the program claims never to miss
    #[arg(long, value_name = "CLAIM", default_value_t = Claim::Mesh, value_parser = one_of::<Claim>(Claim::NAMES))]
    claims: Claim,
    /// Encoding of the program's input and output
    #[arg(long, value_name = "WIRE", default_value_t = Wire::Ndjson, value_parser = one_of::<Wire>(Wire::NAMES))]
    wire: Wire,
    /// Keep the program running: after the last frame of a case it reads the next case
    #[arg(long)]
    keep: bool,
    /// Time limit per case, in seconds, plus one second per megabyte of the case
    #[arg(long, value_name = "S", default_value_t = 1.0, value_parser = seconds)]
    timeout: f64,
    /// Only cases with matching names: * matches any text, ? one character
    #[arg(long, value_name = "GLOB", default_value = "*")]
    case: String,
    /// The seed of the fresh cases [default: from the clock]
    #[arg(long, value_name = "SEED")]
    fresh: Option<u64>,
    /// Published cases only
    #[arg(long, conflicts_with = "fresh")]
    no_fresh: bool,
    /// A case from a file instead of the catalogue
    #[arg(long, value_name = "FILE", conflicts_with_all = ["case", "fresh", "no_fresh"])]
    replay: Option<PathBuf>,
    /// A file with the names of cases that are known to fail, one per line; it is an error if one
    /// of them passes
    #[arg(long, value_name = "FILE")]
    known: Option<PathBuf>,
    /// Stop after the first case that fails
    #[arg(long)]
    fail_fast: bool,
    /// Largest allowed ratio of extra to required pairs; without it, extra pairs are only counted
    #[arg(long, value_name = "RATIO")]
    extra_limit: Option<f64>,
    /// Print the smallest scene of a miss as a unit test, and write it next to the scene
    #[arg(long, value_name = "LANGUAGE", value_parser = one_of::<Language>(Language::NAMES))]
    as_test: Option<Language>,
    /// Start no new case after this many seconds
    #[arg(long, value_name = "S")]
    time: Option<u64>,
    /// Output directory for the case that shows a missed pair
    #[arg(long, value_name = "DIR", default_value = ".")]
    out: PathBuf,
    #[command(flatten)]
    files: files::ReadArgs,
    /// Output format
    #[arg(long, value_enum, default_value_t)]
    format: ReportFormat,
}

/// Seconds above zero, and not more than a day.
fn seconds(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(seconds) if seconds > 0.0 && seconds <= 86_400.0 => Ok(seconds),
        _ => Err("a number of seconds above 0, at most 86400".to_owned()),
    }
}

/// Judges the program.
///
/// # Errors
/// A file that can't be read, no case of that name.
pub fn run(args: &Args) -> miette::Result<Outcome> {
    let command = args.command.as_ref().or(args.exec.as_ref());
    let command = command.map_or("", String::as_str);
    let program = Program {
        command: command.to_owned(),
        wire: args.wire,
        timeout: Duration::from_secs_f64(args.timeout),
    };
    let subject: Box<dyn Subject> = match args.keep {
        true => Box::new(Service::new(program)),
        false => Box::new(program),
    };
    let options = Options {
        claim: args.claims,
        pattern: args.case.clone(),
        seed: args.seed(),
        time: args.time.map(Duration::from_secs),
        fail_fast: args.fail_fast,
        extra_limit: args.extra_limit,
        known: args.known.as_deref().map_or_else(|| Ok(BTreeSet::new()), known)?,
        ..Options::default()
    };
    let verdict = match &args.replay {
        Some(path) => {
            let case = read_case(path, args.files.max_bytes())?.case;
            examine_given(&*subject, &options, case).into_diagnostic()?
        }
        None => {
            let bar = progress(0, "cases");
            let told = |done: usize, of: usize| {
                bar.set_length(of as u64);
                bar.set_position(done as u64);
            };
            let verdict = examine(&*subject, &options, told).into_diagnostic()?;
            bar.finish_and_clear();
            verdict
        }
    };
    print::emit(args.format, &verdict)?;
    if let (Some(first), true) = (verdict.cases.first(), verdict.is_without_start()) {
        return Err(miette!(help = "CMD is a line for the shell", "no case is judged: {first}"));
    }
    save(args, command, &verdict)?;
    Ok(Outcome::from(&verdict))
}

impl Args {
    /// The seed of the fresh cases; by default from the clock, so that a program can't be prepared
    /// for them.
    fn seed(&self) -> Option<u64> {
        if self.no_fresh || self.replay.is_some() {
            return None;
        }
        let clock = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
        Some(self.fresh.unwrap_or(clock))
    }
}

/// Reads a case, a record or one of Broadmark's recordings (`.aabbs`) from a file. A recording, or
/// a line of another, has at most `most` bytes.
///
/// # Errors
/// A file that can't be read or is not a case.
pub fn read_case(path: &Path, most: u64) -> miette::Result<ndjson::StoredCase> {
    if path.extension().is_some_and(|extension| extension == "aabbs") {
        let bytes = sdop::files::read(path, most)
            .into_diagnostic()
            .wrap_err_with(|| format!("cannot read {}", path.display()))?;
        let case = broadmark::read(&bytes).into_diagnostic()?;
        let pairs = vec![None; case.frames.len()];
        return Ok(ndjson::StoredCase { case, pairs, lacks: None, without: Vec::new() });
    }
    let file = File::open(path)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot read {}", path.display()))?;
    let read = ndjson::read(BufReader::new(file), most);
    read.map_err(|problem| {
        miette!(
            help = "`sdop cases --out DIR` writes cases, `sdop run SCENE --record FILE` records",
            "{}: {problem}",
            path.display()
        )
    })
}

/// The names in a list, without comments.
fn known(path: &Path) -> miette::Result<BTreeSet<String>> {
    let text = sdop::files::read_text(path, MAX_BYTES)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot read {}", path.display()))?;
    let name = |line: &str| line.split('#').next().unwrap_or("").trim().to_owned();
    Ok(text.lines().map(name).filter(|name| !name.is_empty()).collect())
}

/// Writes the counter-example and says how to see the failure again.
fn save(args: &Args, command: &str, verdict: &Verdict) -> miette::Result<()> {
    let out = &args.out;
    let base = format!(
        "sdop judge '{}' --claims {} --wire {}{}",
        command.replace('\'', "'\\''"),
        args.claims,
        args.wire,
        if args.keep { " --keep" } else { "" }
    );
    let mut lines = Vec::new();
    let is_replayed = |path: &Path| {
        let replayed = args.replay.as_ref().and_then(|replayed| replayed.canonicalize().ok());
        replayed.is_some_and(|replayed| path.canonicalize().is_ok_and(|path| path == replayed))
    };
    if let Some(smallest) = &verdict.smallest {
        let written = counter_example(smallest).into_diagnostic()?;
        if written.iter().any(|(name, _)| is_replayed(&out.join(name))) {
            return Ok(()); // the case that is replayed shows it
        }
        for (name, bytes) in &written {
            files::write(&out.join(name), bytes)?;
        }
        let stem = out.join(STEM);
        let scene = if written.iter().any(|(name, _)| name.ends_with(".toml")) {
            format!(" and the scene {0}.toml (sdop run {0}.toml)", stem.display())
        } else {
            String::new()
        };
        lines.push(format!(
            "written: the case {0}.ndjson (sdop view {0}.ndjson){scene}",
            stem.display()
        ));
        if let Some(language) = args.as_test {
            let path = stem.with_extension(language.extension());
            let test = unit_test(smallest, language);
            files::write(&path, &test)?;
            lines.push(format!("as a unit test: {}\n{test}", path.display()));
        }
        lines.push(format!("again:   {base} --replay {}.ndjson", stem.display()));
    }
    let first = verdict.cases.iter().find(|case| case.counts_against());
    let found = verdict.smallest.as_ref().map(|smallest| &smallest.from);
    if let (Some(name), None) = (found.or(first.map(|case| &case.name)), &args.replay) {
        let seed = name
            .rsplit_once('@')
            .map_or_else(|| " --no-fresh".to_owned(), |(_, seed)| format!(" --fresh {seed}"));
        lines.push(format!("as found: {base} --case '{name}'{seed}"));
    }
    match args.format {
        ReportFormat::Table if !lines.is_empty() => say(&lines.join("\n")),
        _ => {
            lines.iter().for_each(|line| eprintln!("{line}"));
            Ok(())
        }
    }
}
