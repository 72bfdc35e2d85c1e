//! `sdop run`: simulates and culls one scene, and prints counters and times.

use std::path::PathBuf;

use sdop::Tier;
use sdop::counters::{Counters, Seconds};
use sdop::settings::{Budget, CullSettings, Interest, Strategy, TestedVolume};
use sdop_bench::domain::{BorderSeconds, RankLine};
use sdop_bench::effects::EffectReport;
use sdop_bench::measure::conditions::Conditions;
use sdop_bench::measure::counts::Volume;
use sdop_bench::percentiles::Percentiles;
use sdop_bench::remedy::OrReport as _;
use sdop_bench::scene::Scene;
use sdop_bench::simulate::{Simulation, Summary};
use sdop_bench::tradeoff::truth::ExactJudge;
use sdop_judge::record::Recorder;
use serde::Serialize;
use serde_json::{Map, Value};

#[cfg(feature = "mpi")]
mod ranks;

use super::Outcome;
use super::output::{Format, Listing, counted, emit, paragraphs, progress, table};
use super::scene_args::{MachineArgs, SceneArgs};

/// Simulate and cull one scene
///
/// Runs the effects that the scene lists, culls every frame, and prints counters, the seconds of
/// each stage, percentiles of single frames, and hashes. Counters and hashes depend only on scene,
/// seed and flags, not on the CPU or threads; with --budget-us they depend on the clock. Under
/// mpirun (with the feature `mpi`), ranks share the scene and report the same pairs.
#[derive(clap::Args)]
#[command(
    after_help = "Example: sdop run data/scenes/paper-500.toml --strategy s-dop-batch --format json"
)]
pub struct Args {
    /// Write every frame's poses and pairs to this file, as lines of JSON
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Add to the record which meshes meet, decided in exact arithmetic; slow for large scenes
    #[arg(long, requires = "record")]
    truth: bool,
    /// Print all tables: also the effects, those that aren't simulated too
    #[arg(long)]
    all: bool,
    /// Output format
    #[arg(long, value_enum, default_value_t)]
    format: Format,
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    machine: MachineArgs,
    /// Number of threads; only times depend on it
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: u16,
}

/// What is printed.
#[derive(Serialize)]
struct RunReport<'a> {
    scene: &'a str,
    seed: u64,
    bodies: usize,
    frames: u32,
    strategy: &'static str,
    pairs: &'static str,
    finder: &'static str,
    k: usize,
    axes: &'static str,
    overlap: &'static str,
    updates: &'static str,
    interest: Option<&'a Interest>,
    budget: Option<Budget>,
    simd: &'static str,
    threads: usize,
    counters: Map<String, Value>,
    seconds: RunTerms,
    frame_seconds: Percentiles,
    /// Other load on the machine.
    conditions: Conditions,
    effects: Vec<EffectLine>,
    volumes_sha256: &'a str,
    pairs_sha256: Option<&'a str>,
    pairs_digest: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    ranks: Option<&'a [RankLine]>,
}

/// The terms of T: those of culling, and those of the borders between ranks.
#[derive(Serialize)]
struct RunTerms {
    #[serde(flatten)]
    culling: Seconds,
    #[serde(flatten)]
    border: Option<BorderSeconds>,
}

/// Additional results of ranks.
type RankResults<'a> = Option<(BorderSeconds, &'a [RankLine])>;

#[derive(Serialize)]
struct EffectLine {
    name: &'static str,
    steps: u64,
    seconds: f64,
}

/// Runs the command.
///
/// # Errors
/// An invalid scene or settings, a body that leaves the contract, a record that can't be written.
pub fn run(args: &Args) -> miette::Result<Outcome> {
    #[cfg(feature = "mpi")]
    if sdop_bench::mpi::launched() > 1 {
        return Ok(ranks::run(args));
    }
    let scene = args.scene.read_culled()?.build_exact()?;
    let tier = args.machine.tier();
    let mut recorder = match &args.record {
        Some(path) => {
            Some(Recorder::create(path, &sdop_bench::record::header(&scene)).or_report()?)
        }
        None => None,
    };
    let judge = if args.truth { Some(ExactJudge::new(&scene.shapes)?) } else { None };
    let before = Conditions::before();
    let bar = progress(scene.frames.into(), &scene.name);
    let threads = usize::from(args.threads);
    let simulation = Simulation::with_threads(&scene, tier, threads)?;
    let summary = simulation.run(|frame| -> miette::Result<()> {
        if let Some(recorder) = &mut recorder {
            let mut line = sdop_bench::record::frame_line(frame, scene.cull.strategy);
            if let Some(judge) = &judge {
                line.meets = Some(judge.meetings(frame.bodies, line.translations.as_deref())?);
            }
            recorder.frame(&line).or_report()?;
        }
        bar.inc(1);
        Ok(())
    })?;
    bar.finish_and_clear();
    if let Some(recorder) = recorder {
        recorder.finish().or_report()?;
    }
    let conditions = before.after(std::iter::empty());
    print(args, &scene, &summary, conditions, None)?;
    Ok(Outcome::Passed)
}

/// Prints what a run says of itself.
fn print(
    args: &Args,
    scene: &Scene,
    summary: &Summary,
    conditions: Conditions,
    shared: RankResults<'_>,
) -> miette::Result<()> {
    let (tier, threads) = (args.machine.tier(), args.threads.into());
    let report = report(scene, (tier, threads), summary, conditions, shared);
    emit(args.format, &report, |report| text(report, scene, summary, args.all))
}

fn report<'a>(
    scene: &'a Scene,
    (tier, threads): (Tier, usize),
    summary: &'a Summary,
    conditions: Conditions,
    shared: RankResults<'a>,
) -> RunReport<'a> {
    let CullSettings { strategy, pairs, k, axes, overlap, updates, interest, budget, .. } =
        &scene.cull;
    RunReport {
        scene: &scene.name,
        seed: scene.seed,
        bodies: scene.share().all,
        frames: scene.frames,
        strategy: strategy.name(),
        pairs: pairs.name(),
        finder: summary.finder.name(),
        k: k.k(),
        axes: axes.name(),
        overlap: overlap.name(),
        updates: updates.name(),
        interest: interest.as_ref(),
        budget: *budget,
        simd: tier.name(),
        threads,
        counters: counters(*strategy, &summary.counters),
        seconds: RunTerms { culling: summary.seconds, border: shared.map(|(border, _)| border) },
        frame_seconds: summary.frame_seconds,
        conditions,
        effects: summary.effects.iter().map(effect_line).collect(),
        volumes_sha256: &summary.volumes_sha256,
        pairs_sha256: summary.pairs_sha256.as_deref(),
        pairs_digest: summary.pairs_digest.as_deref(),
        ranks: shared.map(|(_, ranks)| ranks),
    }
}

fn effect_line(effect: &EffectReport) -> EffectLine {
    EffectLine { name: effect.name, steps: effect.steps, seconds: effect.seconds }
}

/// The volume of a strategy that has neither spheres nor or-DOPs.
fn other_volume(strategy: Strategy) -> Option<TestedVolume> {
    let is_other = |volume: &_| !matches!(volume, TestedVolume::Sphere | TestedVolume::OrDop);
    strategy.scheme().volumes().find(is_other)
}

fn counters(strategy: Strategy, counters: &Counters) -> Map<String, Value> {
    let Counters { sphere, ordop, .. } = counters;
    let mut map = Map::new();
    let mut put = |name: String, value: u64| map.insert(name, value.into());
    put("sphere_updates".into(), sphere.updates);
    put("ordop_updates".into(), ordop.updates);
    put("sphere_tests".into(), sphere.tests);
    put("sphere_hits".into(), sphere.hits);
    put("ordop_tests".into(), ordop.tests);
    put("ordop_hits".into(), ordop.hits);
    put("untested".into(), counters.untested);
    put("reported".into(), counters.reported);
    if let Some(volume) = other_volume(strategy) {
        let counters = counters.of(volume);
        put(format!("{volume}_updates"), counters.updates);
        put(format!("{volume}_tests"), counters.tests);
        put(format!("{volume}_hits"), counters.hits);
    }
    map
}

fn text(report: &RunReport<'_>, scene: &Scene, summary: &Summary, is_whole: bool) -> String {
    let mut parts =
        vec![heading(report, scene), stages(&report.seconds, report.frames).to_string()];
    let Percentiles { p50, p99, most } = report.frame_seconds;
    let [p50, p99, most] = [p50, p99, most].map(|seconds| 1e3 * seconds);
    parts.push(format!("culling per frame, ms: p50 {p50:.3}, p99 {p99:.3}, most {most:.3}"));
    parts.push(volumes(scene.cull.strategy, &summary.counters).to_string());
    let Counters { reported, untested, .. } = summary.counters;
    let per_frame = reported as f64 / f64::from(report.frames);
    let mut found = format!("reported {reported} pairs ({per_frame:.1} per frame)");
    if scene.cull.budget.is_some() {
        found += &format!(", of which untested {untested}");
    }
    parts.push(found);
    if is_whole {
        parts.push(effects(&summary.effects).to_string());
    }
    parts.push(format!("volumes sha256 {}", report.volumes_sha256));
    let hash = match report.pairs_digest {
        None => "– (nothing is culled)",
        Some(_) => report.pairs_sha256.unwrap_or("– (too many to sort in one place)"),
    };
    parts.push(format!("pairs sha256   {hash}"));
    parts.extend(report.pairs_digest.map(|digest| format!("pairs digest   {digest}")));
    parts.extend(report.ranks.map(|ranks| rank_rows(ranks, report.frames).to_string()));
    parts.extend(report.conditions.warning());
    paragraphs(&parts.join("\n"))
}

/// The scene, and the settings that its strategy has.
fn heading(report: &RunReport<'_>, scene: &Scene) -> String {
    let RunReport { scene: name, seed, bodies, frames, strategy, pairs, finder, .. } = report;
    let dynamic: usize = scene.share().moving.iter().map(|run| run.len()).sum();
    let mut settings = format!("{strategy}, pairs from {pairs}");
    if pairs != finder {
        settings += &format!(" ({finder})");
    }
    let tested: Vec<TestedVolume> = scene.cull.strategy.scheme().volumes().collect();
    if tested.contains(&TestedVolume::OrDop) {
        let RunReport { k, axes, overlap, updates, .. } = report;
        settings += &format!(", k = {k}, {axes} axes, {overlap}, {updates} updates");
    } else if tested.contains(&TestedVolume::KDop) {
        settings += &format!(", k = {}", report.k);
    }
    let threads = counted(report.threads, "thread");
    format!(
        "{name}, seed {seed}: {bodies} bodies ({dynamic} dynamic), {frames} frames\n{settings}; {}, {threads}",
        report.simd
    )
}

/// Seconds per stage. Construction happens once, so it has no time per frame.
fn stages(seconds: &RunTerms, frames: u32) -> Listing {
    let RunTerms { culling: seconds, border } = seconds;
    let mut rows = table(&["stage", "seconds", "ns / frame"]);
    rows.add_row(["construct", &format!("{:.6}", seconds.construct), "once"]);
    let border = border.iter().flat_map(|border| {
        [("ghosts", border.ghosts), ("migration", border.migration), ("waiting", border.waiting)]
    });
    let culling = [
        ("effects", seconds.effects),
        ("update", seconds.update),
        ("pair finding", seconds.pair_finding),
        ("or-dop", seconds.ordop),
        ("culling, total", seconds.total),
    ];
    for (stage, value) in culling.into_iter().chain(border) {
        let each = 1e9 * value / f64::from(frames);
        rows.add_row([stage, format!("{value:.6}").as_str(), format!("{each:.0}").as_str()]);
    }
    rows
}

/// What each rank had to do.
fn rank_rows(ranks: &[RankLine], frames: u32) -> Listing {
    let mut rows = table(&[
        "rank",
        "bodies",
        "ghosts",
        "ghosts' bytes",
        "migrated",
        "renewals",
        "cuts",
        "peak MB",
        "ms / frame: effects",
        "culling",
        "ghosts",
        "migration",
        "waiting",
    ]);
    for line in ranks {
        let a_frame = |count: u64| (count / u64::from(frames)).to_string();
        let ms = |seconds: f64| format!("{:.3}", 1e3 * seconds / f64::from(frames));
        rows.add_row([
            line.rank.to_string(),
            line.bodies.to_string(),
            a_frame(line.ghosts),
            a_frame(line.ghost_bytes),
            line.migrated.to_string(),
            line.renewals.to_string(),
            line.cuts.to_string(),
            (line.peak_bytes / 1_000_000).to_string(),
            ms(line.seconds.effects),
            ms(line.seconds.culling),
            ms(line.seconds.border.ghosts),
            ms(line.seconds.border.migration),
            ms(line.seconds.border.waiting),
        ]);
    }
    rows
}

/// The counts of the volumes that the strategy tests.
fn volumes(strategy: Strategy, counters: &Counters) -> Listing {
    let mut rows = table(&["volume", "updates", "tests", "hits", "hits / tests"]);
    for volume in strategy.scheme().volumes() {
        let counted = counters.of(volume);
        let share = match counted.tests {
            0 => "–".to_owned(),
            tests => format!("{:.3} %", 100.0 * counted.hits as f64 / tests as f64),
        };
        let [updates, tests, hits] =
            [counted.updates, counted.tests, counted.hits].map(|count| count.to_string());
        rows.add_row([Volume::from(volume).name().to_owned(), updates, tests, hits, share]);
    }
    rows
}

fn effects(reports: &[EffectReport]) -> Listing {
    let mut rows = table(&["effect", "steps", "seconds", "ns / body"]);
    for effect in reports {
        if effect.listed {
            let each = 1e9 * effect.seconds / effect.visited.max(1) as f64;
            let seconds = format!("{:.6}", effect.seconds);
            rows.add_row([effect.name, &effect.steps.to_string(), &seconds, &format!("{each:.2}")]);
        } else {
            rows.add_row([effect.name, "not simulated", "", ""]);
        }
    }
    rows
}
