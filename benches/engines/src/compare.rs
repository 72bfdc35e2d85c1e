//! Comparing engines on one scene: all get the same frames, are checked, and then timed in turns.
//!
//! Turns are those of every measurement here ([`Turns`]). Frames are made between turns and never
//! timed. A time is the mean of a turn's frames, a ratio theirs over ours *on the same frames*;
//! both are medians over turns.
//!
//! If there is a limit, an engine that exceeds it for a frame is left out and listed.

use std::time::Instant;

use miette::miette;
use sdop_bench::measure::turns::{Quartiles, median};
use serde::Serialize;

use crate::boxes::Frame;
use crate::check::ExpectedPairs;
use crate::entry::{Engine, Entry, OURS, Setup};
use crate::facts::{LeftOut, Timings};
use crate::memory::{self, Memory};
use crate::scenes::{Course, EXPECTED, Order, Schedule, Spread};
use crate::turns::{TimedEngine, take_turns};

/// A scene and a number of threads.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Case {
    /// How bodies are spread.
    pub spread: Spread,
    /// In which order they are numbered.
    pub order: Order,
    /// How many there are.
    pub bodies: usize,
    /// Threads that each engine may use.
    pub threads: usize,
    /// Frames.
    #[serde(flatten)]
    pub schedule: Schedule,
}

/// A case with its answers.
pub type CaseTimings = Timings<EngineTiming, Case>;

/// What one engine did in a case.
#[derive(Clone, Debug, Serialize)]
pub struct EngineTiming {
    /// The case.
    #[serde(flatten)]
    pub case: Case,
    /// The engine.
    pub engine: &'static str,
    /// Its version.
    pub version: &'static str,
    /// What it finds.
    pub work: &'static str,
    /// Pairs in the last frame.
    pub pairs: usize,
    /// Milliseconds per frame, the mean of a turn: over turns the lower quartile, the median and
    /// the upper quartile.
    pub ms_low: f64,
    /// See above.
    pub ms: f64,
    /// See above.
    pub ms_high: f64,
    /// Milliseconds of single frames: the median and the most.
    pub ms_p50: f64,
    /// See above.
    pub ms_most: f64,
    /// `ms` over the number of bodies.
    pub ns_a_body: f64,
    /// Median over turns of its time over ours for boxes.
    pub ratio: f64,
    /// Bytes per body that it holds.
    pub bytes_a_body: f64,
    /// The most bytes per body that it had at once; of C++ what it holds.
    pub peak_bytes_a_body: f64,
}

/// Checks and times everyone who keeps to the limit, in milliseconds per frame.
///
/// # Errors
/// An engine whose pairs are not the scene's, an engine that can't be built.
pub fn run(case: Case, entries: &[Entry], limit_ms: f64) -> miette::Result<CaseTimings> {
    let able = |entry: &&Entry| entry.threads >= case.threads && case.spread.has(entry.work);
    let able = entries.iter().filter(able);
    let (checked, left_out) = check(case, &able.collect::<Vec<_>>(), limit_ms)?;
    let entries: Vec<_> = checked.iter().map(|(entry, _)| *entry).collect();
    let (timed, pairs) = timed(case, &entries)?;
    let ours = entries.iter().position(|entry| entry.name == OURS);
    let ours = ours.map(|at| &timed[at]);
    let mut rows = Vec::new();
    for ((own, pairs), (entry, memory)) in timed.iter().zip(pairs).zip(checked) {
        let turn = case.schedule.turn;
        let ratio = ours.map(|ours| median_ratio(&own.turns(turn), &ours.turns(turn)));
        let ms = Quartiles::of(own.turns(turn));
        let bodies = case.bodies as f64;
        rows.push(EngineTiming {
            case,
            engine: entry.name,
            version: entry.version,
            work: entry.work.name(),
            pairs,
            ms_low: ms.low,
            ms: ms.median,
            ms_high: ms.high,
            ms_p50: median(own.ms.clone()),
            ms_most: own.ms.iter().copied().fold(0.0, f64::max),
            ns_a_body: 1e6 * ms.median / bodies,
            ratio: ratio.unwrap_or(f64::NAN),
            bytes_a_body: memory.held as f64 / bodies,
            peak_bytes_a_body: memory.peak as f64 / bodies,
        });
    }
    Ok(Timings { rows, left_out })
}

/// Which engines have passed, and which have not been checked.
type CheckedEngines<'a> = (Vec<(&'a Entry, Memory)>, Vec<LeftOut<Case>>);

/// Runs every engine alone over the first frames and judges its pairs; counts its memory on the
/// way.
fn check<'a>(
    case: Case,
    entries: &[&'a Entry],
    limit_ms: f64,
) -> miette::Result<CheckedEngines<'a>> {
    let mut course = course(case)?;
    let count = case.schedule.checked;
    let mut frames = vec![Frame::default(); count];
    for frame in &mut frames {
        course.next_frame(frame)?;
    }
    let sampled = [0, 1, count - 1].map(|number| ExpectedPairs::of(&frames[number], number));
    definition_holds(case, &sampled[0])?;
    let setup = Setup { scene: &course.scene, first: &frames[0], threads: case.threads };
    let (mut passed, mut left_out) = (Vec::new(), Vec::new());
    for &entry in entries {
        let (tried, memory) = memory::measure(|| tried(entry, &setup, &frames, limit_ms));
        let (peer, ms) = tried?;
        drop(peer);
        if ms > limit_ms && entry.name != OURS {
            left_out.push(LeftOut { case, engine: entry.name, ms, limit_ms });
            continue;
        }
        passed.push((entry, memory));
        let mut peer = (entry.new)(&setup)?;
        for (number, frame) in frames.iter().enumerate() {
            peer.frame(frame);
            peer.settle();
            if let Some(truth) = sampled.iter().find(|truth| truth.number() == number) {
                truth.judge(entry, peer.pairs())?;
            }
        }
    }
    Ok((passed, left_out))
}

/// How often the limit the first frame may take, which builds an engine's structures.
const FIRST_FRAME: f64 = 4.0;

/// The engine after these frames, and milliseconds of the last one or of the first that showed that
/// it is too slow.
fn tried(
    entry: &Entry,
    setup: &Setup<'_>,
    frames: &[Frame],
    limit_ms: f64,
) -> miette::Result<(Engine, f64)> {
    let mut peer = (entry.new)(setup)?;
    let mut ms = 0.0;
    for (number, frame) in frames.iter().enumerate() {
        let start = Instant::now();
        peer.frame(frame);
        ms = 1e3 * start.elapsed().as_secs_f64();
        let most = if number == 0 { FIRST_FRAME } else { 1.0 };
        if ms > most * limit_ms {
            break;
        }
    }
    Ok((peer, ms))
}

fn course(case: Case) -> miette::Result<Course> {
    Course::new(case.spread, case.bodies, case.order, case.schedule.warm_up)
}

fn definition_holds(case: Case, first: &ExpectedPairs<'_>) -> miette::Result<()> {
    let known = EXPECTED
        .iter()
        .find(|(spread, bodies, _)| (*spread, *bodies) == (case.spread, case.bodies));
    match known {
        Some(&(_, _, pairs)) if pairs != first.boxes() => Err(miette!(
            help = "if the scene code was meant to change, update the definition in `scenes.rs`",
            "{:?} of {} has {} pairs in its first frame, its definition says {pairs}",
            case.spread,
            case.bodies,
            first.boxes(),
        )),
        _ => Ok(()),
    }
}

/// Times everyone in turns, and judges their last pairs: how many each has.
fn timed(case: Case, entries: &[&Entry]) -> miette::Result<(Vec<TimedEngine>, Vec<usize>)> {
    let schedule = case.schedule;
    let (timed, last) = take_turns(course(case)?, schedule, |course, first| {
        let setup = Setup { scene: &course.scene, first, threads: case.threads };
        let timed =
            |entry: &&Entry| Ok(TimedEngine::new((entry.new)(&setup)?, entry.ages, case.threads));
        entries.iter().map(timed).collect()
    })?;
    let truth = ExpectedPairs::of(&last, schedule.warm_up + schedule.timed - 1);
    let judged = entries.iter().zip(&timed);
    let judged = judged.map(|(entry, timed)| truth.judge(entry, timed.engine.pairs()));
    let pairs = judged.collect::<Result<Vec<_>, _>>()?;
    Ok((timed, pairs))
}

/// The median of times over others of the same frames.
pub fn median_ratio(times: &[f64], others: &[f64]) -> f64 {
    let ratios = times.iter().zip(others).map(|(time, other)| time / other);
    median(ratios.collect())
}
