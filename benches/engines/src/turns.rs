//! The loop that times engines in turns on the same frames.

use sdop_bench::measure::turns::Turns;

use crate::boxes::Frame;
use crate::entry::Engine;
use crate::scenes::{Course, Schedule};

/// An engine with the times of its frames.
pub struct TimedEngine {
    /// The engine.
    pub engine: Engine,
    /// Whether it keeps anything but buffers from frame to frame; if not, it joins for the last
    /// turn before the clock counts.
    pub ages: bool,
    /// On how many threads it works.
    pub threads: usize,
    /// Milliseconds of each frame that counts.
    pub ms: Vec<f64>,
}

impl TimedEngine {
    /// An engine without times yet.
    pub fn new(engine: Engine, ages: bool, threads: usize) -> Self {
        Self { engine, ages, threads, ms: Vec::new() }
    }

    /// The mean of each turn of `turn` frames. Some engines do work in only some frames (they build
    /// a list of neighbours, or balance a tree). A median over frames would hide that.
    pub fn turns(&self, turn: usize) -> Vec<f64> {
        means(&self.ms, turn)
    }
}

fn means(ms: &[f64], turn: usize) -> Vec<f64> {
    let mean = |turn: &[f64]| turn.iter().sum::<f64>() / turn.len() as f64;
    ms.chunks(turn).map(mean).collect()
}

/// Builds engines with the first frame of a course, and times them in turns on the following
/// frames. Returns them with the last frame.
pub fn take_turns(
    mut course: Course,
    schedule: Schedule,
    build: impl FnOnce(&Course, &Frame) -> miette::Result<Vec<TimedEngine>>,
) -> miette::Result<(Vec<TimedEngine>, Frame)> {
    let Schedule { warm_up, timed, turn, .. } = schedule;
    let mut frames = vec![Frame::default(); turn];
    course.next_frame(&mut frames[0])?;
    let mut all = build(&course, &frames[0])?;
    let mut turns = Turns::default();
    for done in (0..warm_up + timed).step_by(turn) {
        frames.truncate(warm_up + timed - done);
        for frame in &mut frames[usize::from(done == 0)..] {
            course.next_frame(frame)?;
        }
        let joining = all.iter_mut().filter(|one| one.ages || done + turn >= warm_up);
        let (mut engines, mut times): (Vec<_>, Vec<_>) =
            joining.map(|one| (&mut one.engine, (&mut one.ms, one.threads))).unzip();
        turns.round(&mut engines, &frames, |frame| {
            if done + frame.frame >= warm_up {
                let (ms, threads) = &mut times[frame.number];
                // While one of several threads waits, the others work: that isn't time lost.
                let waited = if *threads > 1 { frame.waited } else { 0.0 };
                ms.push(1e3 * (frame.seconds + waited));
            }
        });
    }
    Ok((all, frames.pop().unwrap_or_default()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A turn counts with its mean and the last one may be shorter.
    #[test]
    fn last_turn_may_be_shorter() {
        let ms = [1.0, 1.0, 7.0, 2.0, 2.0, 2.0, 5.0];
        assert_eq!(means(&ms, 3), [3.0, 2.0, 5.0]);
    }
}
