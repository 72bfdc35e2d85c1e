//! Strategies measured side by side: each culls the same frames, in turns of a few frames, on one thread.
//!
//! Turns share out what the machine does meanwhile (other processes, clock changes) among all strategies alike. A frame's
//! time is the median over frames, so that frames in which another process ran don't count.

use std::time::Instant;

use crate::bodies::Bodies;
use crate::counters::{Counters, Seconds};
use crate::culler::Culler;
use crate::lab::scene::Scene;
use crate::lab::simulate::SimulationError;
use crate::pairs::PairList;
use crate::settings::{CullSettings, SettingsError, Strategy};
use crate::simd::Tier;

/// Bodies of the frames that are prepared at once: their poses stay in the second-level cache until they are culled.
const TURN: usize = 1 << 13;

/// One strategy being measured.
#[derive(Debug)]
pub struct Trial {
    strategy: Strategy,
    culler: Culler,
    frames: Vec<Seconds>,
}

impl Trial {
    /// Prepares a strategy for the scene's bodies; the scene's other culling settings stay.
    ///
    /// # Errors
    /// Settings that can't be carried out.
    pub fn new(scene: &Scene, strategy: Strategy, tier: Tier) -> Result<Self, SettingsError> {
        let settings = CullSettings {
            strategy,
            ..scene.cull.clone()
        };
        Ok(Self {
            strategy,
            culler: Culler::new(&scene.shapes, &scene.bodies, &settings, tier)?,
            frames: Vec::new(),
        })
    }

    /// The strategy measured.
    #[must_use]
    pub fn strategy(&self) -> Strategy {
        self.strategy
    }

    /// Culls and times one frame.
    pub fn frame(&mut self, bodies: &Bodies) -> &PairList {
        let before = *self.culler.seconds();
        self.culler.cull(bodies);
        self.frames.push(self.culler.seconds().since(&before));
        self.culler.pairs()
    }

    /// Counters summed over frames.
    #[must_use]
    pub fn counters(&self) -> &Counters {
        self.culler.counters()
    }

    /// Seconds summed over frames.
    #[must_use]
    pub fn sums(&self) -> &Seconds {
        self.culler.seconds()
    }

    /// The seconds of each frame so far.
    #[must_use]
    pub fn frames(&self) -> &[Seconds] {
        &self.frames
    }

    /// Medians over frames, stage by stage: the stages need not add up to the total.
    #[must_use]
    pub fn medians(&self) -> Seconds {
        let of = |stage: fn(&Seconds) -> f64| median(self.frames.iter().map(stage).collect());
        Seconds {
            construct: self.culler.seconds().construct,
            effects: 0.0,
            update: of(|s| s.update),
            pair_finding: of(|s| s.pair_finding),
            ordop: of(|s| s.ordop),
            total: of(|s| s.total),
        }
    }
}

/// Simulates `frames` frames of the scene and has every trial cull each of them. `reported` sees the pairs of trial
/// number t in a frame, outside of the timing. Returns the median seconds of a simulation step.
///
/// # Errors
/// Effects that the scene can't have, a body that leaves the contract.
pub fn side_by_side(
    scene: &Scene,
    trials: &mut [Trial],
    frames: u32,
    mut reported: impl FnMut(usize, u32, &PairList),
) -> Result<f64, SimulationError> {
    let mut effects = scene.start_effects()?;
    let mut steps = Vec::new();
    let mut state = scene.bodies.clone();
    // Up to 32 frames a turn; a million bodies go frame by frame.
    let turn = (TURN / state.len().max(1)).clamp(1, 32) as u32;
    let mut poses: Vec<Bodies> = Vec::new();
    for first in (0..frames).step_by(turn as usize) {
        poses.clear();
        for frame in first..frames.min(first + turn) {
            if frame > 0 {
                let start = Instant::now();
                let step = effects.step(&mut state);
                step.map_err(|error| SimulationError::Contract { frame, error })?;
                steps.push(start.elapsed().as_secs_f64());
            }
            poses.push(state.clone());
        }
        // Another strategy begins each time: whoever comes first finds colder caches.
        let begin = (first / turn) as usize % trials.len().max(1);
        for trial in (begin..trials.len()).chain(0..begin) {
            for (frame, bodies) in (first..).zip(&poses) {
                let pairs = trials[trial].frame(bodies);
                reported(trial, frame, pairs);
            }
        }
    }
    Ok(median(steps))
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

/// The median, or the mean of the two middle values; 0 of none.
#[must_use]
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => 0.0,
        n if n % 2 == 1 => values[middle],
        _ => 0.5 * (values[middle - 1] + values[middle]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn median_is_the_middle_or_the_mean_of_the_two() {
        assert_eq!(median(vec![]), 0.0);
        assert_eq!(median(vec![3.0]), 3.0);
        assert_eq!(median(vec![9.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(vec![9.0, 1.0, 2.0, 4.0]), 3.0);
    }
}
