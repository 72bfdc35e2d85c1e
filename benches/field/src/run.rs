//! Comparing engines in one case: all get the same frames. At first each is alone, so that its
//! answers can be checked and its memory counted; then they are timed in turns.
//!
//! Turns are those of every measurement here ([`Turns`]). Frames are made between turns and never
//! timed. A time is the mean of a turn's frames, a ratio theirs over ours *on the same frames*;
//! both are medians over turns. Some engines do work in only some frames (they build a list of
//! neighbours, or balance a tree); a median over frames would hide that.
//!
//! If there is a limit, an engine that exceeds it is left out and listed.

use std::time::Instant;

use miette::miette;
use sdop_bench::measure::turns::{Quartiles, Turns, median};
use sdop_bench::percentiles::Percentiles;
use sdop_bench::roster::Workload;
use sdop_judge::contestant::Contestant as _;

use crate::case::{Case, Frames};
use crate::entry::{Engine, Entry, Setup, ours};
use crate::frame::Frame;
use crate::memory::{self, Memory};
use crate::scenes::EXPECTED;
use crate::table::{LeftOut, Row};
use crate::truth::{Judged, Truth};

/// How often the limit the first frame may take, in which buffers grow.
const FIRST_FRAME: f64 = 4.0;

/// An engine with its times.
struct Timed {
    entry: Entry,
    engine: Engine,
    memory: Memory,
    /// Milliseconds of the last frame of the check.
    checked_ms: f64,
    /// Microseconds of each timed frame.
    us: Vec<f64>,
    judged: Judged,
}

/// Checks and times everyone who takes part and keeps to the limit, in milliseconds per frame.
///
/// # Errors
/// An engine whose answer is wrong, an engine that can't be built.
pub fn run(
    case: Case,
    entries: &[Entry],
    limit_ms: f64,
) -> miette::Result<(Vec<Row>, Vec<LeftOut>)> {
    let mut frames = Frames::new(&case)?;
    let entries = entries.iter().filter(|entry| case.has(entry));
    let built = entries.map(|&entry| Timed::new(entry, &case, &frames));
    let mut all = built.collect::<miette::Result<Vec<_>>>()?;
    let mut left_out = Vec::new();
    for number in 0..case.checked {
        let frame = frames.next_frame()?;
        let most_ms = limit_ms * if number == 0 { FIRST_FRAME } else { 1.0 };
        all.iter_mut().for_each(|timed| timed.check(&frame));
        all.retain(|timed| {
            let is_slow = timed.checked_ms > most_ms && !timed.entry.is_ours();
            let (engine, ms) = (timed.entry.name(), timed.checked_ms);
            left_out.extend(is_slow.then_some(LeftOut { case, engine, ms, limit_ms }));
            !is_slow
        });
        if number < 2 || number + 1 == case.checked {
            let pairs = judge(&frames, &mut all)?;
            if number == 0 {
                definition_holds(&case, pairs)?;
            }
        }
    }
    time(&case, &mut frames, &mut all)?;
    judge(&frames, &mut all)?;
    let ours = all.iter().find(|timed| timed.entry.name() == ours(case.workload));
    let ours = ours.or(all.first()).map(|timed| timed.turns(case.turn));
    let rows = all.iter().map(|timed| timed.row(case, ours.as_deref()));
    Ok((rows.collect(), left_out))
}

/// Times all engines in turns. What has no state but buffers only joins for the last turn of the
/// warm-up.
fn time(case: &Case, frames: &mut Frames, all: &mut [Timed]) -> miette::Result<()> {
    let mut turns = Turns::default();
    let mut done = case.checked;
    while done < case.warm_up + case.timed {
        let is_timed = done >= case.warm_up;
        let until = if is_timed { case.warm_up + case.timed } else { case.warm_up };
        let count = case.turn.min(until - done);
        let next = (0..count).map(|_| frames.next_frame());
        let next = next.collect::<miette::Result<Vec<_>>>()?;
        done += count;
        let joining =
            all.iter_mut().filter(|timed| timed.entry.row.timed.ages || done >= case.warm_up);
        let (mut engines, mut times): (Vec<_>, Vec<_>) =
            joining.map(|timed| (&mut timed.engine, &mut timed.us)).unzip();
        turns.round(&mut engines, &next, |frame| {
            if is_timed {
                // While one of several threads waits, the others work: that isn't time lost.
                let waited = if case.threads > 1 { frame.waited } else { 0.0 };
                times[frame.number].push(1e6 * (frame.seconds + waited));
            }
        });
    }
    Ok(())
}

/// Compares all answers with the truth; how many pairs of boxes there are.
fn judge(frames: &Frames, all: &mut [Timed]) -> miette::Result<usize> {
    let entries: Vec<Entry> = all.iter().map(|timed| timed.entry).collect();
    let truth = Truth::of(frames.present(), frames.scene(), &entries)?;
    for timed in all {
        timed.judged = truth.judge(&timed.entry, timed.engine.pairs())?;
    }
    Ok(truth.boxes())
}

fn definition_holds(case: &Case, pairs: usize) -> miette::Result<()> {
    let of_case = |known: &&(_, _, _)| (known.0, known.1) == (case.spread, case.bodies);
    let known = EXPECTED.iter().find(of_case).filter(|_| case.workload == Workload::Boxes);
    match known {
        Some((.., known)) if *known != pairs => Err(miette!(
            help = "if the scene code was meant to change, update the definition in `scenes.rs`",
            "{case} has {pairs} pairs in its first frame, its definition says {known}"
        )),
        _ => Ok(()),
    }
}

impl Timed {
    fn new(entry: Entry, case: &Case, frames: &Frames) -> miette::Result<Self> {
        let setup = Setup {
            scene: frames.scene(),
            first: frames.present(),
            threads: case.threads,
            is_sparse: case.workload == Workload::Movers,
        };
        let (engine, memory) = memory::measure(Memory::default(), || (entry.new)(&setup));
        let mut engine = engine?;
        engine.settle();
        Ok(Self {
            entry,
            engine,
            memory,
            checked_ms: 0.0,
            us: Vec::new(),
            judged: Judged::default(),
        })
    }

    /// A frame on its own, with what it adds to the engine's memory.
    fn check(&mut self, frame: &Frame) {
        let engine = &mut self.engine;
        let (seconds, memory) = memory::measure(self.memory, || {
            let start = Instant::now();
            engine.frame(frame);
            start.elapsed().as_secs_f64()
        });
        (self.memory, self.checked_ms) = (memory, 1e3 * seconds);
        self.engine.settle();
    }

    /// The mean of each turn of so many frames.
    fn turns(&self, turn: usize) -> Vec<f64> {
        let mean = |turn: &[f64]| turn.iter().sum::<f64>() / turn.len() as f64;
        self.us.chunks(turn).map(mean).collect()
    }

    fn row(&self, case: Case, ours: Option<&[f64]>) -> Row {
        let turns = self.turns(case.turn);
        let ratios = turns.iter().zip(ours.unwrap_or_default()).map(|(time, ours)| time / ours);
        let ratio = median(ratios.collect());
        let (us, frames) = (Quartiles::of(turns), Percentiles::of(self.us.clone()));
        let us = [us.low, us.median, us.high, frames.p50, frames.p99, frames.most];
        let Judged { pairs, extra, missed } = self.judged;
        let [held, peak] = [self.memory.held, self.memory.peak].map(|bytes| bytes as f64);
        Row {
            case,
            engine: self.entry.name(),
            version: &self.entry.row.version,
            work: self.entry.finds(),
            margin: self.entry.row.timed.margin,
            pairs,
            extra,
            missed,
            us: us.map(|us| us / case.questions_asked() as f64),
            ratio,
            bytes_a_body: held / case.bodies as f64,
            peak_bytes_a_body: peak / case.bodies as f64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A turn counts with its mean and the last one may be shorter.
    #[test]
    fn last_turn_may_be_shorter() {
        let entry = crate::entry::roster()[0];
        let us = vec![1.0, 1.0, 7.0, 2.0, 2.0, 2.0, 5.0];
        let engine: Engine = Box::new(Idle);
        let (memory, judged) = (Memory::default(), Judged::default());
        let timed = Timed { entry, engine, memory, checked_ms: 0.0, us, judged };
        assert_eq!(timed.turns(3), [3.0, 2.0, 5.0]);
    }

    struct Idle;

    impl sdop_judge::contestant::Contestant<Frame> for Idle {
        fn frame(&mut self, _: &Frame) {}

        fn pairs(&self) -> Vec<[u32; 2]> {
            Vec::new()
        }
    }
}
