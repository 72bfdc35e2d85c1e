//! `sdop verify`: the optimised culler against the exact reference, on hard cases, seeded rounds and scenes.

mod report;

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use miette::{IntoDiagnostic as _, WrapErr as _};
use rayon::prelude::*;
use sdop::Tier;
use sdop::lab::scene::SceneFile;
use sdop::lab::verify::hard::{FILES, Group, page};
use sdop::lab::verify::rounds::{Failure, Ledger, RoundError, Source, group, round};
use sdop::lab::verify::scenes::scene;
use sdop::lab::verify::shrink::Smallest;
use sdop::lab::verify::ways::{Rotation, variants};

use super::Outcome;
use super::files::{self, ReadArgs};
use super::judge::{self, ReportFormat};
use super::output::{emit, print, progress};
use report::Report;

/// Judge the optimised culler by the exact reference
///
/// Hard cases first, then seeded rounds (a probe among bodies that nearly touch it, and a random crowd, for every k and
/// axes), then the scenes given, meshes included. Strategies, overlap tests, finders, k, axes, update modes, SIMD tiers and
/// numbers of threads meet in every combination; the matrix at the end says how often. Each list is held against the
/// exact answers and against that of all-pairs. A missed pair, a list that differs from all-pairs' and an empty cell of the
/// matrix end in exit code 1, the first two with the smallest scene that shows it.
#[derive(clap::Args)]
#[command(
    after_help = "Examples: sdop verify\n          sdop verify --seeds 128 --time 600\n          sdop verify data/scenes/paper-500.toml --frames 100"
)]
pub struct Args {
    /// Scenes to run and judge, meshes included
    scenes: Vec<PathBuf>,
    /// Seeded rounds: each judges 8,192 near and 89,400 random pairs
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u64).range(..=1_000_000))]
    seeds: u64,
    /// The first seed
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    first_seed: u64,
    /// Start no round after so many seconds
    #[arg(long, value_name = "S")]
    time: Option<u64>,
    /// Frames of each scene
    #[arg(long, value_name = "N", default_value_t = 20)]
    frames: usize,
    /// One SIMD tier alone, instead of all that the CPU has
    #[arg(long, value_name = "TIER")]
    simd: Option<Tier>,
    /// Where the scene that shows a missed pair is written
    #[arg(long, value_name = "DIR", default_value = ".")]
    out: PathBuf,
    /// Write the hard cases' exact answers and their page into this directory, and judge nothing
    #[arg(long, value_name = "DIR")]
    record_hard_cases: Option<PathBuf>,
    #[command(flatten)]
    files: ReadArgs,
    /// How the result is printed
    #[arg(long, value_enum, default_value_t)]
    format: ReportFormat,
    #[command(flatten)]
    outside: judge::Outside,
}

/// Runs the command.
///
/// # Errors
/// A scene that can't be run, a directory that can't be written.
pub fn run(args: &Args) -> miette::Result<Outcome> {
    if let Some(directory) = &args.record_hard_cases {
        return record(directory);
    }
    if let Some(command) = &args.outside.exec {
        return judge::run(
            &args.outside,
            command,
            &args.files,
            args.time,
            &args.out,
            args.format,
        );
    }
    let format = args.format.plain()?;
    let start = Instant::now();
    // A scene that can't be built is said before the long work.
    let most = args.files.max_bytes();
    let build = |path: &PathBuf| SceneFile::read_within(path, most).and_then(|file| file.build());
    let scenes = args
        .scenes
        .iter()
        .map(build)
        .collect::<Result<Vec<_>, _>>()?;
    let tiers = match args.simd {
        Some(tier) => vec![tier],
        None => [Tier::available(), vec![Tier::SCALAR_FLUSH]].concat(),
    };
    let rotation = Rotation::new(&tiers);
    let mut report = Report::new(&tiers);
    let mut failures = Vec::new();
    let mut add = |name: String, ledger: Ledger| {
        report.add(name, &ledger);
        failures.extend(ledger.failures);
    };
    add("hard cases".to_owned(), hard_cases(&rotation)?);
    // A time beyond the clock's end is none.
    let deadline = args.time.map(Duration::from_secs);
    let deadline = deadline.and_then(|time| start.checked_add(time));
    let [near, random] = rounds(args, &rotation, deadline)?;
    add("near pairs".to_owned(), near);
    add("random pairs".to_owned(), random);
    for built in &scenes {
        let bar = progress(args.frames as u64, &built.name);
        let ledger = scene(built, args.frames, &rotation, |n| {
            bar.set_position(n as u64)
        })?;
        bar.finish_and_clear();
        let (name, bodies, frames) = (&built.name, built.bodies.len(), args.frames);
        add(format!("{name}, {bodies} bodies, {frames} frames"), ledger);
    }
    report.finish(start.elapsed(), &rotation);
    emit(format, &report, Report::tables)?;
    if report.passed() {
        return Ok(Outcome::Passed);
    }
    if let Some(failure) = failures.first() {
        show(failure, &args.out)?;
    }
    Ok(Outcome::Failed)
}

fn hard_cases(rotation: &Rotation) -> miette::Result<Ledger> {
    let files = FILES.iter().enumerate();
    let jobs: Vec<_> = files
        .flat_map(|(n, file)| variants().map(move |variant| (n, file.1, variant)))
        .collect();
    let bar = progress(jobs.len() as u64, "hard cases");
    let judged: Result<Vec<Ledger>, RoundError> = jobs
        .par_iter()
        .map(|(n, text, variant)| {
            let ledger = group(*n, &Group::parse(text)?, *variant, rotation);
            bar.inc(1);
            ledger
        })
        .collect();
    bar.finish_and_clear();
    Ok(sum(judged.into_diagnostic()?))
}

/// Near and random rounds. With a deadline, as many as it allows.
fn rounds(
    args: &Args,
    rotation: &Rotation,
    deadline: Option<Instant>,
) -> miette::Result<[Ledger; 2]> {
    let variants: Vec<_> = variants().collect();
    let jobs = args.seeds * variants.len() as u64;
    let bar = progress(jobs, "seeded rounds");
    let (next, failed) = (AtomicU64::new(0), AtomicBool::new(false));
    let job = || -> Result<[Ledger; 2], RoundError> {
        let mut ledgers = [Ledger::default(), Ledger::default()];
        loop {
            let late = deadline.is_some_and(|end| Instant::now() >= end);
            let n = next.fetch_add(1, Ordering::Relaxed);
            if late || n >= jobs || failed.load(Ordering::Relaxed) {
                return Ok(ledgers);
            }
            let seed = args.first_seed.wrapping_add(n / variants.len() as u64);
            let variant = variants[n as usize % variants.len()];
            for (source, ledger) in [Source::Near, Source::Random].into_iter().zip(&mut ledgers) {
                let judged = round(source, seed, variant, rotation)
                    .inspect_err(|_| failed.store(true, Ordering::Relaxed))?;
                ledger.add(judged);
            }
            bar.inc(1);
        }
    };
    let workers = rayon::current_num_threads();
    let parts: Result<Vec<_>, RoundError> = (0..workers).into_par_iter().map(|_| job()).collect();
    bar.finish_and_clear();
    let mut sums = [Ledger::default(), Ledger::default()];
    for part in parts.into_diagnostic()? {
        for (sum, ledger) in sums.iter_mut().zip(part) {
            sum.add(ledger);
        }
    }
    Ok(sums)
}

fn sum(ledgers: Vec<Ledger>) -> Ledger {
    ledgers.into_iter().fold(Ledger::default(), |mut all, one| {
        all.add(one);
        all
    })
}

/// Shrinks a failure and says where the scene is.
fn show(failure: &Failure, out: &Path) -> miette::Result<()> {
    let [i, j] = failure.pair;
    let what = format!(
        "{} {} bodies {i} and {j} ({}, k = {}, {} axes, {}, {}, {}, {} threads)",
        failure.settings.strategy,
        if failure.missed {
            "misses"
        } else {
            "and all-pairs differ on"
        },
        failure.settings.pairs,
        failure.settings.k,
        failure.settings.axes,
        failure.settings.overlap,
        failure.mode.updates,
        failure.mode.tier,
        failure.mode.threads
    );
    let Some(smallest) = Smallest::of(failure) else {
        return print(&format!(
            "{what}\nthe frame alone does not show it: it depends on the frames before"
        ));
    };
    let (path, shown) = smallest
        .write(out)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot write to {}", out.display()))?;
    let how = if shown {
        "shown by"
    } else {
        "not shown once its shapes are built anew, but its numbers are in"
    };
    print(&format!(
        "{what}\n{} bodies are enough, {how} {}",
        smallest.bodies.len(),
        path.display()
    ))
}

/// Recomputes the answers of the groups in a directory, and their page.
fn record(directory: &Path) -> miette::Result<Outcome> {
    let write = |name: &str, text: &str| files::write(&directory.join(name), text);
    let bar = progress(FILES.len() as u64, "exact answers");
    let mut texts = Vec::new();
    for (name, _) in FILES {
        let path = directory.join(format!("{name}.toml"));
        let text = files::read(&path)?;
        let mut group = Group::parse(&text).into_diagnostic()?;
        group.record().into_diagnostic()?;
        let head = text.split("\n[answers").next().unwrap_or(&text).trim_end();
        let text = format!("{head}\n{}", group.answers_toml().into_diagnostic()?);
        write(&format!("{name}.toml"), &text)?;
        texts.push((*name, text));
        bar.inc(1);
    }
    bar.finish_and_clear();
    let page = page(texts.iter().map(|(name, text)| (*name, text.as_str())));
    write("README.md", &page.into_diagnostic()?)?;
    Ok(Outcome::Passed)
}
