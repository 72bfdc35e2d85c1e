//! The protocol of all timing: contestants take turns on the same frames, on one thread.
//!
//! In its turn a contestant culls several consecutive frames, then the next contestant does. Other
//! load (other processes, clock changes) therefore affects all contestants alike. The order of
//! turns is random in each round, because otherwise a contestant would always follow the same other
//! one and find its data in the caches. The first frame of a turn is *cold*, because others ran
//! before it. The following ones are *warm*: frames of one culler in sequence, as in a simulation.
//! Every number says which of the two it is.
//!
//! The position of the stack also affects a frame's time: loads and stores whose addresses agree
//! modulo a page wait for each other, and an access that crosses a page is slow. That position is
//! drawn once per process and differs by contestant. Each frame therefore begins [at a different
//! part of a page](displaced), so that a median is taken over many positions.
//!
//! Other load may interrupt a frame, with a probability that grows with its length. Time that a
//! thread waited for a processor is subtracted if the system reports it ([`WaitingTime`]), and is
//! recorded.

use std::num::NonZeroU32;
use std::time::Instant;

use serde::{Deserialize, Serialize};

use super::culling::{Culling, StageSeconds};
use super::waiting_time::WaitingTime;
use crate::random::Stream;
use crate::simulate::{SimulationError, Trajectory};
use sdop::bodies::Bodies;
use sdop::choice::choices;
use sdop_judge::contestant::Contestant;

/// The seed of the order of turns.
const SEED: u64 = 0x5a3e_7100_0000_0000;
/// The most bodies, over all frames, whose poses are prepared at once: they stay in the
/// second-level cache until they are culled.
const PREPARED_BODIES: usize = 1 << 13;
/// Waiting is only measured for frames of at least this many seconds. The measurement takes one or
/// two microseconds and disturbs the caches, and short frames are rarely interrupted.
const LEAST_WATCHED_SECONDS: f64 = 100e-6;
/// The most frames of a turn.
pub const MOST_TURN_FRAMES: usize = 8;
/// Bytes by which the stack is displaced at once, what a call takes included or not.
const DISPLACEMENT: usize = 208;
/// Displacements that go round a page, and by how many the next frame's is larger; they share no
/// divisor.
const DISPLACEMENTS: usize = 17;
const DISPLACED_BY: usize = 5;

choices! {
    /// The state of the caches when a culler is timed.
    Regime, "timing regime", {
        /// Data of the same culler's previous frame: frames follow one another, as in a simulation.
        Warm = "warm",
        /// Data of other cullers, which ran in between.
        Cold = "cold",
    }
}

/// One timed frame.
pub struct TimedFrame<'a, C> {
    /// The number of the contestant, in the given order.
    pub number: usize,
    /// The contestant after the frame.
    pub contestant: &'a mut C,
    /// Which frame of the turn.
    pub frame: usize,
    /// The frame's time, without waiting for a processor.
    pub seconds: f64,
    /// The time of waiting for a processor.
    pub waited: f64,
    /// Whether the frame was warm or cold.
    pub regime: Regime,
}

/// Rounds of turns.
#[derive(Clone, Copy, Debug, Default)]
pub struct Turns {
    round: u64,
    displacement: usize,
}

/// Runs the work below this many pads on the stack.
#[inline(never)]
fn displaced(pads: usize, work: &mut dyn FnMut()) {
    let pad = std::hint::black_box([0_u8; DISPLACEMENT]);
    match pads.checked_sub(1) {
        Some(pads) => displaced(pads, work),
        None => work(),
    }
    std::hint::black_box(&pad);
}

impl Turns {
    /// Rounds whose orders are drawn from a separate stream.
    #[must_use]
    pub fn from_stream(stream: u32) -> Self {
        Self { round: u64::from(stream) << 32, displacement: 0 }
    }

    /// Runs a round: every contestant takes all frames of the round in one turn. `each` gets every
    /// timed frame.
    pub fn round<Frame, C: Contestant<Frame>>(
        &mut self,
        contestants: &mut [C],
        frames: &[Frame],
        mut each: impl FnMut(TimedFrame<'_, C>),
    ) {
        let mut waiting = WaitingTime::of_this_thread();
        for number in self.order(contestants.len()) {
            let contestant = &mut contestants[number];
            let mut watched = true;
            for (frame, bodies) in frames.iter().enumerate() {
                let before = if watched { waiting.seconds() } else { 0.0 };
                let mut seconds = 0.0;
                self.displacement = (self.displacement + DISPLACED_BY) % DISPLACEMENTS;
                displaced(self.displacement, &mut || {
                    let start = Instant::now();
                    contestant.frame(bodies);
                    seconds = start.elapsed().as_secs_f64();
                });
                let after = if watched { waiting.seconds() } else { 0.0 };
                let waited = (after - before).clamp(0.0, seconds);
                let seconds = seconds - waited;
                watched = seconds > LEAST_WATCHED_SECONDS;
                contestant.settle();
                let regime = if frame == 0 { Regime::Cold } else { Regime::Warm };
                each(TimedFrame { number, contestant, frame, seconds, waited, regime });
            }
        }
    }

    /// The order of the contestants' turns in the next round.
    fn order(&mut self, contestants: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..contestants).collect();
        let mut draws = Stream::new(SEED, self.round);
        self.round += 1;
        for last in (1..contestants).rev() {
            order.swap(last, draws.index(last as u32 + 1) as usize);
        }
        order
    }
}

/// The fewest frames of a run that is timed: one is cold and one warm. A scene that has fewer is
/// simulated further.
pub const FEWEST_TIMED_FRAMES: NonZeroU32 = NonZeroU32::MIN.saturating_add(1);

/// How many consecutive frames a turn has for a scene with `bodies` bodies: at least two, one of
/// which is warm.
#[must_use]
pub fn turn_frames(bodies: usize) -> usize {
    (PREPARED_BODIES / bodies.max(1)).clamp(2, MOST_TURN_FRAMES)
}

/// The times of one contestant's frames by regime, in the order of their measurement.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct FrameTimes([Vec<StageSeconds>; 2]);

impl FrameTimes {
    /// Adds the last frame of a contestant, without waiting.
    pub fn push(&mut self, timed: &TimedFrame<'_, Culling>) {
        self.0[timed.regime as usize].push(timed.contestant.last.without(timed.waited));
    }

    /// The frames of one regime.
    #[must_use]
    pub fn of(&self, regime: Regime) -> &[StageSeconds] {
        &self.0[regime as usize]
    }

    /// Medians over frames per stage, which add up to the median of whole frames: the difference,
    /// including interruptions, counts as finding.
    #[must_use]
    pub fn medians(&self, regime: Regime) -> StageSeconds {
        let of =
            |stage: fn(&StageSeconds) -> f64| median(self.of(regime).iter().map(stage).collect());
        let (update, refining, hulls) = (of(|s| s.update), of(|s| s.refining), of(|s| s.hulls));
        let total = of(StageSeconds::total);
        StageSeconds { update, finding: total - update - refining - hulls, refining, hulls }
    }

    /// Whole frames: the median with its quartiles.
    #[must_use]
    pub fn quartiles(&self, regime: Regime) -> Quartiles {
        Quartiles::of(self.of(regime).iter().map(StageSeconds::total).collect())
    }

    /// Mean seconds of a frame of one regime.
    #[must_use]
    pub fn mean(&self, regime: Regime) -> f64 {
        let frames = self.of(regime);
        frames.iter().map(StageSeconds::total).sum::<f64>() / frames.len() as f64
    }
}

/// A median with the quartiles around it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Quartiles {
    /// A quarter of the values lies below.
    pub low: f64,
    /// Half of them does.
    pub median: f64,
    /// Three quarters of them do.
    pub high: f64,
}

impl Quartiles {
    /// The quartiles of some values; 0 for an empty list.
    #[must_use]
    pub fn of(mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        let at = |quarter: usize| {
            let place = (values.len().saturating_sub(1) * quarter) as f64 / 4.0;
            let [below, above] = [place.floor(), place.ceil()]
                .map(|place| values.get(place as usize).copied().unwrap_or(0.0));
            below + place.fract() * (above - below)
        };
        Self { low: at(1), median: at(2), high: at(3) }
    }
}

/// The poses of the next turn's frames, at most `frames`; none after the last frame.
///
/// # Errors
/// A body that leaves the contract.
pub fn next_turn(
    trajectory: &mut Trajectory,
    frames: usize,
) -> Result<Vec<Bodies>, SimulationError> {
    let mut poses = Vec::new();
    while poses.len() < frames {
        let Some(bodies) = trajectory.advance()? else {
            break;
        };
        poses.push(bodies.clone());
    }
    Ok(poses)
}

/// Seconds that `work` takes: the median of `repeats` runs.
pub fn time<T>(repeats: usize, mut work: impl FnMut() -> T) -> f64 {
    let run = |_| {
        let start = Instant::now();
        std::hint::black_box(work());
        start.elapsed().as_secs_f64()
    };
    median((0..repeats).map(run).collect())
}

/// The median, or the mean of the two middle values; 0 for an empty list.
#[must_use]
pub fn median(values: Vec<f64>) -> f64 {
    Quartiles::of(values).median
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Median is the middle or the mean of the two.
    #[test]
    fn median_of_odd_and_even_counts() {
        assert_eq!(median(vec![]), 0.0);
        assert_eq!(median(vec![3.0]), 3.0);
        assert_eq!(median(vec![9.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(vec![9.0, 1.0, 2.0, 4.0]), 3.0);
        let quartiles = Quartiles::of(vec![5.0, 1.0, 2.0, 3.0, 4.0]);
        assert_eq!((quartiles.low, quartiles.high), (2.0, 4.0));
    }

    /// Notes which frames it was given, by their numbers of bodies.
    #[derive(Default)]
    struct FrameRecorder(Vec<usize>);

    impl Contestant for FrameRecorder {
        fn frame(&mut self, frame: &Bodies) {
            self.0.push(frame.len());
        }

        fn pairs(&self) -> Vec<[u32; 2]> {
            Vec::new()
        }
    }

    /// Every contestant takes every frame in order and another begins.
    #[test]
    fn stack_positions_differ() {
        let mut places = Vec::new();
        for pads in 0..DISPLACEMENTS {
            displaced(pads, &mut || {
                let here = std::hint::black_box(0_u8);
                places.push(std::ptr::from_ref(&here).addr() % 4096);
            });
        }
        places.sort_unstable();
        places.dedup();
        let gaps = places.windows(2).map(|pair| pair[1] - pair[0]);
        assert!(places.len() >= 12 && gaps.max() < Some(1024), "{places:?}");
    }

    #[test]
    fn contestants_alternate_over_all_frames() {
        let frame = |bodies: usize| Bodies { shape: vec![0; bodies], ..Bodies::default() };
        let mut contestants: Vec<FrameRecorder> =
            (0..3).map(|_| FrameRecorder::default()).collect();
        let (mut turns, mut begins) = (Turns::default(), Vec::new());
        for round in 0..20 {
            let mut calls = Vec::new();
            let frames = [3 * round, 3 * round + 1, 3 * round + 2].map(frame);
            turns.round(&mut contestants, &frames, |timed| {
                let cold = timed.regime == Regime::Cold;
                assert_eq!(cold, timed.frame == 0);
                calls.push(timed.number);
            });
            let whole = |turn: &[usize]| turn.iter().all(|number| *number == turn[0]);
            assert!(calls.chunks(3).all(whole), "{calls:?}");
            begins.push(calls[0]);
        }
        for contestant in &contestants {
            assert_eq!(contestant.0, (0..60).collect::<Vec<_>>());
        }
        assert!((0..3).all(|number| begins.contains(&number)), "{begins:?}");
    }
}
