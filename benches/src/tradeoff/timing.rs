//! Time: seconds per frame, measured in turns with all others.
//!
//! A turn is a sample frame with the frames after it, by the same protocol as everywhere
//! ([`pass`](crate::cost::pass)).

use super::counts::Tally;
use super::pays::Line;
use super::truth::{Sample, samples, windows};
use super::variant::Variant;
use crate::cost::pass::{Frames, Pass, SceneFrames, pass};
use crate::measure::turns::{FrameTimes, Regime, turn_frames};
use crate::scene::Scene;
use crate::simulate::SimulationError;
use sdop::bodies::Bodies;
use sdop::simd::Tier;

/// The fewest passes of a result, separated in time.
pub const PASSES: usize = 3;
/// Approximate number of bodies times frames of a timed run.
const RUN_BODIES: usize = 500_000;
/// Frames of a timed run whose pairs are counted.
const RUN_SAMPLES: u32 = 6;

/// Sample frames, each with the frames after it.
#[derive(Clone, Debug)]
pub struct Windows {
    windows: Vec<(u32, Vec<Bodies>)>,
    next: usize,
}

impl Windows {
    /// `count` windows of a scene's run, at equal distances.
    ///
    /// # Errors
    /// The scene can't have one of its effects, or a body leaves the contract.
    pub fn new(scene: &Scene, count: u32) -> Result<Self, SimulationError> {
        Ok(Self { windows: windows(scene, count, turn_frames(scene.bodies.len()))?, next: 0 })
    }
}

impl Frames for Windows {
    fn turns(&self) -> usize {
        self.windows.len()
    }

    fn next_turn(&mut self) -> Result<Option<(u32, Vec<Bodies>)>, SimulationError> {
        let window = self.windows.get(self.next).cloned();
        self.next += 1;
        Ok(window)
    }
}

/// Passes separated in time, without a calibration.
fn passes<F: Frames>(
    scene: &Scene,
    variants: &[Variant],
    tier: Tier,
    frames: impl Fn() -> Result<F, SimulationError>,
) -> Result<Vec<Pass>, SimulationError> {
    (0..PASSES).map(|_| pass(scene, variants, tier, &mut frames()?, None, &mut ())).collect()
}

/// Times in separate passes, and pairs per frame, of some variants on a scene's sample frames.
///
/// # Errors
/// The settings can't be carried out, or a body leaves the contract.
pub fn lines(
    scene: &Scene,
    variants: &[Variant],
    tier: Tier,
    count: u32,
) -> miette::Result<Vec<Line>> {
    let windows = Windows::new(scene, count)?;
    let passes = passes(scene, variants, tier, || Ok(windows.clone()))?;
    let median = |times: &FrameTimes| times.quartiles(Regime::Warm).median;
    lines_of((scene, variants, tier), &samples(scene, count)?, &passes, median)
}

/// The same on consecutive frames from the scene's first on, with the mean of warm ones, since a
/// finder may do more in some frames than in others.
///
/// # Errors
/// The settings can't be carried out, or a body leaves the contract.
pub fn lines_of_a_run(
    scene: &Scene,
    variants: &[Variant],
    tier: Tier,
) -> miette::Result<Vec<Line>> {
    let frames = scene.frames.min((RUN_BODIES / scene.bodies.len().max(1)).clamp(24, 80) as u32);
    let passes = passes(scene, variants, tier, || SceneFrames::new(scene, frames))?;
    let first = Scene { frames, ..scene.clone() };
    let mean = |times: &FrameTimes| times.mean(Regime::Warm);
    lines_of((scene, variants, tier), &samples(&first, RUN_SAMPLES)?, &passes, mean)
}

/// One line per variant: times from passes, pairs from sample frames.
fn lines_of(
    (scene, variants, tier): (&Scene, &[Variant], Tier),
    samples: &[Sample],
    passes: &[Pass],
    statistic: impl Fn(&FrameTimes) -> f64,
) -> miette::Result<Vec<Line>> {
    let mut lines = Vec::new();
    for (at, variant) in variants.iter().enumerate() {
        let tally = Tally::unjudged(scene, variant, tier, samples)?;
        lines.push(Line {
            name: variant.name.clone(),
            times: passes.iter().map(|pass| statistic(&pass.culled[at].times)).collect(),
            pairs: tally.reported_a_frame(),
        });
    }
    Ok(lines)
}
