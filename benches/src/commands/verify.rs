//! `sdop verify`: judges the optimised culler by the exact reference, on hard cases, seeded rounds
//! and scenes.

mod report;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::builder::PossibleValuesParser;
use miette::{IntoDiagnostic as _, WrapErr as _};
use sdop::Tier;
use sdop_bench::scene::{Scene, SceneFile};
use sdop_bench::sweep::MergedUnits;
use sdop_bench::verify::shrink::SmallestScene;
pub use sdop_bench::verify::units::NAME;
use sdop_bench::verify::units::{Settings, UnitOrigin, Verification};
use sdop_judge::configuration::Rotation;
use sdop_judge::draw::hard::{FILES, HardCaseGroup, page};
use sdop_judge::verify::subject::OwnCullers;
use sdop_judge::verify::{Failure, Ledger};
use sdop_judge::{Claim, Options, examine};

use super::files::{self, ReadArgs};
use super::judge::emit_verdict;
use super::output::{Format, emit_with_reason, print, progress};
use super::sweep::{self, SweepArgs};
use super::{Outcome, one_of};
use report::Report;

/// Judge the optimised culler by the exact reference
///
/// Runs hard cases, then seeded rounds (a probe among bodies that nearly touch it, and a random
/// crowd, for every k and axes), then the given scenes with their meshes. Strategies, overlap
/// tests, finders, k, axes, update modes, SIMD tiers and numbers of threads are tested in every
/// combination; the matrix at the end counts them. Each list is compared with the exact answers and
/// with the list of all-pairs; lists of boxes are compared with their definition. Long-lived worlds
/// go through histories of changes, also in space that repeats, and their pairs and events are
/// compared with the exact answers and with those of newly built worlds. The exit code is 1 for a
/// missed pair, a list that differs from that of all-pairs, or an empty cell of the matrix; for the
/// first two, the smallest scene that shows it is written. A run that --time cuts short is
/// INCOMPLETE: exit code 3.
#[derive(clap::Args)]
#[command(
    after_help = "Examples: sdop verify\n          sdop verify --seeds 128 --time 600\n          sdop verify data/scenes/paper-500.toml --frames 100\n          \
    mpirun -n 64 sdop verify --seeds 10000 --out target/verify\n          \
    sdop verify --seeds 10000 --shard 3/64 --out shards"
)]
pub struct Args {
    /// Scenes to run and judge, with their meshes
    scenes: Vec<PathBuf>,
    /// One group of hard cases instead of all; may be repeated
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(FILES.iter().map(|file| file.0)))]
    group: Vec<String>,
    /// Judge every configuration that makes this claim by the claim's cases, as `sdop judge` judges
    /// a program
    #[arg(long, value_name = "CLAIM", conflicts_with_all = ["scenes", "group", "shard"], value_parser = one_of::<Claim>(Claim::NAMES))]
    claims: Option<Claim>,
    /// Seeded rounds: each judges 8,192 near and 89,400 random pairs
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u64).range(..=1_000_000))]
    seeds: u64,
    /// The first seed
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    first_seed: u64,
    /// Start no new round after this many seconds; if rounds are missing, the result is INCOMPLETE,
    /// exit code 3
    #[arg(long, value_name = "S", conflicts_with = "shard")]
    time: Option<u64>,
    /// Frames of each scene
    #[arg(long, value_name = "N", default_value_t = 20)]
    frames: usize,
    /// Only this SIMD tier, instead of all that the CPU has
    #[arg(long, value_name = "TIER")]
    simd: Option<Tier>,
    /// Output directory for shards and for the scene that shows a missed pair
    #[arg(long, value_name = "DIR", default_value = ".")]
    out: PathBuf,
    /// Only write the hard cases' exact answers and their page to this directory
    #[arg(long, value_name = "DIR")]
    record_hard_cases: Option<PathBuf>,
    #[command(flatten)]
    files: ReadArgs,
    /// Output format
    #[arg(long, value_enum, default_value_t)]
    format: Format,
    #[command(flatten)]
    sweep: SweepArgs,
}

impl Args {
    /// Whether its work is cut into units, which many can share.
    pub fn is_sweep(&self) -> bool {
        self.record_hard_cases.is_none() && self.claims.is_none()
    }
}

/// Runs the command.
///
/// # Errors
/// A scene that can't be run, a directory that can't be written.
pub fn run(args: &Args) -> miette::Result<Outcome> {
    if let Some(directory) = &args.record_hard_cases {
        return record(directory);
    }
    if let Some(claim) = args.claims {
        return judged(args, claim);
    }
    sweep::enter(&args.sweep)?;
    let run = verification(args)?;
    let mut taken = UnitTotals::default();
    let mut take = |unit, result: &str| taken.take(&run, unit, result);
    let Some(seconds) = args.sweep.run(&run, &args.out, &mut take)? else {
        return Ok(Outcome::Passed);
    };
    taken.report(&run, seconds, args.format, &args.out)
}

/// Our cullers by the cases of a claim, fresh ones of the first seed among them.
fn judged(args: &Args, claim: Claim) -> miette::Result<Outcome> {
    let options = Options {
        claim,
        seed: Some(args.first_seed),
        time: args.time.map(Duration::from_secs),
        ..Options::default()
    };
    let ours = OwnCullers::new(Rotation::new(&tiers(args)));
    let verdict = examine(&ours, &options, |_, _| {}).into_diagnostic()?;
    emit_verdict(args.format.into(), &verdict)?;
    Ok(Outcome::from(&verdict))
}

fn tiers(args: &Args) -> Vec<Tier> {
    match args.simd {
        Some(tier) => vec![tier],
        None => [Tier::available(), vec![Tier::SCALAR_FLUSH]].concat(),
    }
}

/// The report of merged shards. A scene whose frames show a failure is read again, if it is where
/// it was.
///
/// # Errors
/// Results of another command, a CPU that lacks a tier, a directory that can't be written.
pub fn merged(merged: &MergedUnits, out: &Path, format: Format) -> miette::Result<Outcome> {
    let settings = merged.header.settings().into_diagnostic()?;
    let run = Verification::new(settings)?;
    let mut taken = UnitTotals::default();
    for (&unit, result) in &merged.done {
        taken.take(&run, unit, result)?;
    }
    taken.report(&run, merged.seconds, format, out)
}

fn verification(args: &Args) -> miette::Result<Verification> {
    let deadline = args.time.map(Duration::from_secs);
    // A time beyond the clock's end is none.
    let deadline = deadline.and_then(|time| Instant::now().checked_add(time));
    // A scene that can't be built is reported before the long work.
    let most = args.files.max_bytes();
    let build = |path: &PathBuf| SceneFile::read_within(path, most).and_then(|file| file.build());
    let scenes = args.scenes.iter().map(build);
    let scenes = scenes.collect::<Result<Vec<Scene>, _>>()?;
    let name = |scene: &Scene| {
        let (name, bodies) = (&scene.name, scene.bodies.len());
        format!("{name}, {bodies} bodies, {} frames", args.frames)
    };
    let groups = match &args.group[..] {
        [] => FILES.iter().map(|file| file.0.to_owned()).collect(),
        named => named.to_vec(),
    };
    let run = Verification::new(Settings {
        groups,
        first_seed: args.first_seed,
        seeds: args.seeds,
        scenes: scenes.iter().map(name).collect(),
        frames: args.frames,
        tiers: tiers(args).iter().map(|tier| tier.name().to_owned()).collect(),
    })?;
    Ok(run.with_scenes(scenes, deadline))
}

/// What units have given.
#[derive(Default)]
struct UnitTotals {
    /// How many.
    units: usize,
    ledgers: BTreeMap<UnitOrigin, Ledger>,
    /// The first unit of each that knows of a failure.
    failed: BTreeMap<UnitOrigin, usize>,
}

impl UnitTotals {
    fn take(&mut self, run: &Verification, unit: usize, result: &str) -> miette::Result<()> {
        self.units += 1;
        for (origin, ledger, failed) in run.take(unit, result)? {
            self.ledgers.entry(origin).or_default().add(ledger);
            if failed {
                self.failed.entry(origin).or_insert(unit);
            }
        }
        Ok(())
    }

    /// Prints the report; a failure is looked up and shrunk.
    fn report(
        self,
        run: &Verification,
        seconds: f64,
        format: Format,
        out: &Path,
    ) -> miette::Result<Outcome> {
        let settings = run.settings();
        let mut report = Report::new(&settings.tiers);
        let scenes = settings.scenes.iter().enumerate();
        let scenes = scenes.map(|(n, name)| (UnitOrigin::Scene(n), name.as_str()));
        let rounds = [
            (UnitOrigin::Hard, "hard cases"),
            (UnitOrigin::Near, "near pairs"),
            (UnitOrigin::Random, "random pairs"),
        ];
        for (origin, name) in rounds.into_iter().chain(scenes) {
            let none = Ledger::default();
            report.add(name.to_owned(), self.ledgers.get(&origin).unwrap_or(&none));
        }
        let none = Ledger::default();
        let of = |origin| self.ledgers.get(&origin).unwrap_or(&none);
        let boxes = &of(UnitOrigin::Boxes).boxes;
        let histories = &of(UnitOrigin::Histories).histories;
        let units = [run.units(), self.units];
        report.finish(units, seconds, (boxes, histories), run.rotation());
        let why = report.why();
        emit_with_reason(format, &report, why.as_deref(), Report::tables)?;
        let outcome = Outcome::new(report.conclusion(), why);
        if let Some((origin, &unit)) = self.failed.first_key_value() {
            let judged = run.judge(unit)?.into_iter().filter(|(of, _)| of == origin);
            let ledger = judged.map(|(_, ledger)| ledger).next().unwrap_or_default();
            let told = ledger.boxes.failure.as_ref();
            let told = told.or(ledger.histories.failure.as_ref());
            match (ledger.failures.first(), told) {
                (Some(failure), _) => show(failure, out)?,
                (None, Some(told)) => print(told)?,
                (None, None) => print("the failure doesn't show on this machine")?,
            }
        }
        Ok(outcome)
    }
}

/// Shrinks a failure and says where the scene is.
fn show(failure: &Failure, out: &Path) -> miette::Result<()> {
    let [i, j] = failure.pair;
    let what = format!(
        "{} {} bodies {i} and {j} ({}, k = {}, {} axes, {}, {}, {}, {} threads)",
        failure.settings.strategy,
        if failure.missed { "misses" } else { "and all-pairs differ on" },
        failure.settings.pairs,
        failure.settings.k,
        failure.settings.axes,
        failure.settings.overlap,
        failure.mode.updates,
        failure.mode.tier,
        failure.mode.threads
    );
    let Some(smallest) = SmallestScene::of(failure) else {
        return print(&format!("{what}\nwhich does not show again"));
    };
    let (path, shown) = smallest
        .write(out)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot write to {}", out.display()))?;
    let case = &smallest.shrunk.case;
    if case.frames.len() > 1 {
        return print(&format!(
            "{what}\nthe frame alone does not show it: it depends on the frames before, {} in all, in {}",
            case.frames.len(),
            path.display()
        ));
    }
    let how = if shown {
        "shown by"
    } else {
        "not shown once its shapes are built anew, but its numbers are in"
    };
    print(&format!(
        "{what}\n{} bodies are enough, {how} {}",
        case.frames[0].bodies.len(),
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
        let mut group = HardCaseGroup::parse(&text).into_diagnostic()?;
        group.record().into_diagnostic()?;
        let head = text.split("\n[answers").next().unwrap_or(&text).trim_end();
        let text = format!("{head}\n{}", group.answers_toml());
        write(&format!("{name}.toml"), &text)?;
        texts.push((*name, text));
        bar.inc(1);
    }
    bar.finish_and_clear();
    let page = page(texts.iter().map(|(name, text)| (*name, text.as_str())));
    write("README.md", &page.into_diagnostic()?)?;
    Ok(Outcome::Passed)
}
