//! A pass: a round of calibration, then one run of a scene, or of several. Rounds and runs
//! alternate, so that a drift of the machine affects the prices and the predicted times alike.
//! Passes are separated in time, and each is one observation.

use super::calibrate::CalibrationRound;
use super::construct::build;
use super::predict::Prices;
use crate::measure::counts::Counts;
use crate::measure::culling::Culling;
use crate::measure::estimate::Estimate;
use crate::measure::turns::{
    FrameTimes, MOST_TURN_FRAMES, Regime, Turns, median, next_turn, turn_frames,
};
use crate::measure::variant::Variant;
use crate::scene::Scene;
use crate::simulate::{SimulationError, Trajectory};
use sdop::bodies::Bodies;
use sdop::simd::Tier;
use sdop::volume::Shape;

/// The results of one variant in a run.
#[derive(Clone, Debug, Default, serde::Serialize, serde::Deserialize)]
pub struct VariantRun {
    /// Its frames' times.
    pub times: FrameTimes,
    /// Its counters.
    pub counts: Counts,
    /// Frames culled.
    pub frames: u32,
    /// Co: seconds to build its volumes and its culler.
    pub construct: f64,
}

/// One pass.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct Pass {
    /// The results of each variant.
    pub culled: Vec<VariantRun>,
    /// The prices of each variant for warm and for cold frames, from the round before the run;
    /// empty without a calibration.
    pub prices: [Vec<Prices>; 2],
}

/// The frames of a scene, turn after turn.
pub trait Frames {
    /// Number of turns.
    fn turns(&self) -> usize;

    /// The poses of the next turn and the number of its first frame; `None` after the last.
    ///
    /// # Errors
    /// A body leaves the contract.
    fn next_turn(&mut self) -> Result<Option<(u32, Vec<Bodies>)>, SimulationError>;
}

/// The frames of a scene's run, from the first on.
///
/// Where bodies rest, turns are long: a world reads only a part of its data per frame, so it takes
/// several frames to bring that into the caches.
pub struct SceneFrames {
    trajectory: Trajectory,
    turn_frames: usize,
    frames: u32,
}

impl SceneFrames {
    /// The first `frames` frames.
    ///
    /// # Errors
    /// The scene can't have one of its effects.
    pub fn new(scene: &Scene, frames: u32) -> Result<Self, SimulationError> {
        Ok(Self {
            trajectory: Trajectory::new(scene)?.with_frames(frames),
            turn_frames: match scene.effects.rest {
                Some(_) => MOST_TURN_FRAMES,
                None => turn_frames(scene.bodies.len()),
            },
            frames,
        })
    }
}

impl Frames for SceneFrames {
    fn turns(&self) -> usize {
        (self.frames as usize).div_ceil(self.turn_frames)
    }

    fn next_turn(&mut self) -> Result<Option<(u32, Vec<Bodies>)>, SimulationError> {
        let first = self.trajectory.next_number();
        let poses = next_turn(&mut self.trajectory, self.turn_frames)?;
        Ok((!poses.is_empty()).then_some((first, poses)))
    }
}

/// Observes the reports of cullers, outside of the timing.
pub trait Observer {
    /// Called after each frame with the variant's number, the frame and the culler. It should only
    /// copy, and do its work between turns, since it changes caches and branch predictors for the
    /// next frame (hashing the pairs here made warm frames up to 20 % slower).
    fn frame(&mut self, number: usize, frame: u32, culling: &Culling);

    /// Called when all variants have taken their turn.
    fn between_turns(&mut self) {}
}

/// Observes nothing.
impl Observer for () {
    fn frame(&mut self, _: usize, _: u32, _: &Culling) {}
}

/// Runs a pass.
///
/// # Errors
/// The scene can't have its settings or effects, or a body leaves the contract.
pub fn pass(
    scene: &Scene,
    variants: &[Variant],
    tier: Tier,
    frames: &mut dyn Frames,
    calibration: Option<CalibrationRound>,
    observer: &mut dyn Observer,
) -> Result<Pass, SimulationError> {
    let mut culled = vec![VariantRun::default(); variants.len()];
    let shapes: Vec<Vec<Shape>> = variants.iter().map(|variant| variant.shapes(scene)).collect();
    let (mut cullers, mut built) = (Vec::new(), vec![Vec::new(); variants.len()]);
    for (at, variant) in variants.iter().enumerate() {
        let (culler, construct) = build(variant, &shapes[at], scene, tier)?;
        built[at].push(construct);
        cullers.push(culler);
    }
    let (all, mut turn) = (frames.turns().max(1), 0);
    let CalibrationRound { prices, builds } = calibration.unwrap_or_default();
    let mut turns = Turns::default();
    while let Some((first, poses)) = frames.next_turn()? {
        turns.round(&mut cullers, &poses, |timed| {
            culled[timed.number].times.push(&timed);
            culled[timed.number].frames += 1;
            observer.frame(timed.number, first + timed.frame as u32, timed.contestant);
        });
        observer.between_turns();
        turn += 1;
        // Co is measured repeatedly between the turns.
        if built.first().is_some_and(|built| built.len() * all < builds * turn) {
            for (at, variant) in variants.iter().enumerate() {
                built[at].push(build(variant, &shapes[at], scene, tier)?.1);
            }
        }
    }
    for (culled, culler) in culled.iter_mut().zip(&cullers) {
        culler.accepted()?;
        culled.counts = culler.counts();
    }
    for (culled, built) in culled.iter_mut().zip(built) {
        culled.construct = median(built);
    }
    Ok(Pass { culled, prices })
}

/// The median seconds per frame of variant number `at`, from passes in the order of time.
#[must_use]
pub fn medians(passes: &[Pass], at: usize, regime: Regime) -> Estimate {
    let seconds = |pass: &Pass| pass.culled[at].times.quartiles(regime).median;
    Estimate::in_order(&passes.iter().map(seconds).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use std::path::Path;

    use super::*;
    use crate::scene::SceneFile;

    #[test]
    fn turns_are_long_with_rest() {
        let turns = |rest: &str| {
            let text = format!(
                "name = \"a\"\nframes = 16\n[box]\npartners = 1\n\
                 [[bodies]]\nshape = \"box\"\ncount = 5000\n\
                 [effects]\nmotion = true\n{rest}\n"
            );
            let file = SceneFile::parse(&text, "a.toml", Path::new(".")).unwrap();
            let mut frames = SceneFrames::new(&file.build().unwrap(), 16).unwrap();
            let (_, poses) = frames.next_turn().unwrap().unwrap();
            (frames.turns(), poses.len())
        };
        assert_eq!(turns(""), (8, 2));
        assert_eq!(turns("rest = { speed = 1.0, after = 0.1 }"), (2, 8));
    }
}
