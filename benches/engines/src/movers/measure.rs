//! Checks and times all engines of a case.

use std::time::Instant;

use sdop_bench::measure::turns::{Quartiles, Turns};
use sdop_bench::percentiles::Percentiles;
use sdop_judge::contestant::Contestant as _;
use serde::Serialize;

use super::alone;
use super::course::MoverCourse;
use super::follower::Follower;
use super::judge::Truth;
use super::schedule::MoverCase;
use crate::compare::median_ratio;
use crate::facts::{LeftOut, Timings};
use crate::incremental::{MoverEntry, Moves};
use crate::memory;

/// How often the limit the first frame may take, in which buffers grow.
const FIRST_FRAME: f64 = 4.0;

/// What one engine did in a case.
#[derive(Clone, Debug, Serialize)]
pub struct MoverTiming {
    /// Bodies, movers and frames.
    #[serde(flatten)]
    pub case: MoverCase,
    /// The engine.
    pub engine: &'static str,
    /// Its version.
    pub version: &'static str,
    /// The length by which it grows each box.
    pub margin: f32,
    /// Whether it reports what began and ended; otherwise its answer is a list of pairs.
    pub events: bool,
    /// Pairs after the last frame.
    pub pairs: usize,
    /// Those of boxes that are apart.
    pub extra: usize,
    /// Microseconds per frame, the mean of a turn: over turns the lower quartile, the median and
    /// the upper quartile.
    pub us_low: f64,
    /// See above.
    pub us: f64,
    /// See above.
    pub us_high: f64,
    /// Microseconds of single frames: the median, the 99th percentile and the most.
    pub us_p50: f64,
    /// See above.
    pub us_p99: f64,
    /// See above.
    pub us_most: f64,
    /// Median over turns of its time over ours.
    pub ratio: f64,
    /// Bytes per body that it holds after the first frames.
    pub bytes_a_body: f64,
}

/// A case with its answers.
pub type MoverTimings = Timings<MoverTiming, MoverCase>;

/// An engine with its times.
struct Timed<'a> {
    entry: &'a MoverEntry,
    follower: Follower,
    bytes: u64,
    /// Milliseconds of the last frame of the check.
    ms: f64,
    us: Vec<f64>,
    pairs: (usize, usize),
}

/// Checks and times everyone who keeps to the limit, in milliseconds per frame.
///
/// # Errors
/// An engine whose pairs are wrong, an engine that can't be built.
pub fn run(case: MoverCase, entries: &[MoverEntry], limit_ms: f64) -> miette::Result<MoverTimings> {
    let mut course = MoverCourse::new(case.bodies, case.movers, case.motion)?;
    let takes_part = |entry: &&MoverEntry| case.has(entry);
    let build = |entry| Timed::new(entry, &course);
    let built = entries.iter().filter(takes_part).map(build);
    let mut all = built.collect::<miette::Result<Vec<_>>>()?;
    let mut left_out = Vec::new();
    let (mut turns, mut done) = (Turns::default(), 0);
    let in_turns = case.turns();
    for (number, &count) in in_turns.iter().enumerate() {
        let frames: Vec<_> = (0..count).map(|_| course.next_frame()).collect();
        // In the first turns each engine is alone, so that its memory can be counted.
        if number < 2 {
            all.iter_mut().for_each(|timed| timed.check(&frames[0]));
            all.retain(|timed| {
                let most = if number == 0 { FIRST_FRAME } else { 1.0 };
                let too_slow = timed.left_out(case, limit_ms, most);
                left_out.extend(too_slow);
                too_slow.is_none()
            });
        } else {
            let (mut followers, mut times): (Vec<_>, Vec<_>) =
                all.iter_mut().map(|timed| (&mut timed.follower, &mut timed.us)).unzip();
            turns.round(&mut followers, &frames, |frame| {
                if done >= case.warm_up {
                    times[frame.number].push(1e6 * frame.seconds);
                }
            });
        }
        done += count;
        if (1..=2).contains(&number) || number + 1 == in_turns.len() {
            judge(case, &course, &mut all)?;
        }
    }
    let ours = all.first().map(|timed| timed.turns(case.turn));
    let rows = all.iter().map(|timed| timed.row(case, ours.as_deref()));
    Ok(Timings { rows: rows.collect(), left_out })
}

fn judge(case: MoverCase, course: &MoverCourse, all: &mut [Timed<'_>]) -> miette::Result<()> {
    let shapes = &course.course.scene.shapes;
    let meshes = case.meshes.then_some((shapes.as_slice(), course.poses()));
    let truth = Truth::of(course.boxes(), meshes)?;
    for timed in all {
        timed.pairs = truth.judge(timed.entry, timed.follower.pairs())?;
    }
    Ok(())
}

impl<'a> Timed<'a> {
    fn new(entry: &'a MoverEntry, course: &MoverCourse) -> miette::Result<Self> {
        let setup = alone(&course.course, &course.first);
        let (follower, memory) = memory::measure(|| (entry.new)(&setup).map(Follower::new));
        let follower = follower?;
        Ok(Self {
            entry,
            bytes: memory.held.saturating_sub(follower.log_bytes()),
            follower,
            ms: 0.0,
            us: Vec::new(),
            pairs: (0, 0),
        })
    }

    /// A frame on its own, with what it adds to the engine's memory.
    fn check(&mut self, moves: &Moves) {
        let follower = &mut self.follower;
        let (seconds, memory) = memory::measure(|| {
            let start = Instant::now();
            follower.frame(moves);
            start.elapsed().as_secs_f64()
        });
        self.follower.settle();
        self.ms = 1e3 * seconds;
        self.bytes += memory.held;
    }

    /// Why it takes no part any more, if its last frame took more than `most` times the limit.
    fn left_out(&self, case: MoverCase, limit_ms: f64, most: f64) -> Option<LeftOut<MoverCase>> {
        let is_slow = self.ms > most * limit_ms && !self.entry.is_ours();
        is_slow.then_some(LeftOut { case, engine: self.entry.name, ms: self.ms, limit_ms })
    }

    /// The mean of each turn of so many frames.
    fn turns(&self, turn: usize) -> Vec<f64> {
        let mean = |turn: &[f64]| turn.iter().sum::<f64>() / turn.len() as f64;
        self.us.chunks(turn).map(mean).collect()
    }

    fn row(&self, case: MoverCase, ours: Option<&[f64]>) -> MoverTiming {
        let (turns, frames) = (self.turns(case.turn), Percentiles::of(self.us.clone()));
        let ratio = ours.map_or(f64::NAN, |ours| median_ratio(&turns, ours));
        let us = Quartiles::of(turns);
        MoverTiming {
            case,
            engine: self.entry.name,
            version: self.entry.version,
            margin: self.entry.margin,
            events: self.follower.has_events(),
            pairs: self.pairs.0,
            extra: self.pairs.1,
            us_low: us.low,
            us: us.median,
            us_high: us.high,
            us_p50: frames.p50,
            us_p99: frames.p99,
            us_most: frames.most,
            ratio,
            bytes_a_body: self.bytes as f64 / case.bodies as f64,
        }
    }
}
