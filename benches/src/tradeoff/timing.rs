//! Time: the formula's prices for each variant, and its seconds per frame, measured in turns with
//! all others.
//!
//! A turn is a sample frame with the frames after it. Turns of the judged scene alternate with
//! those of its calibration ([`pass`](crate::cost::pass)), by the same protocol as everywhere.

use super::truth::windows;
use crate::cost::pass::{Frames, Pass, pass};
use crate::measure::turns::turn_frames;
use crate::measure::variant::Variant;
use crate::scene::Scene;
use crate::simulate::SimulationError;
use sdop::bodies::Bodies;
use sdop::simd::Tier;

/// The fewest passes of a result, separated in time.
pub const PASSES: usize = 3;

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

/// Times variants on a scene's windows in passes separated in time, without a calibration.
///
/// # Errors
/// The settings can't be carried out, or a body leaves the contract.
pub fn measure(
    scene: &Scene,
    variants: &[Variant],
    tier: Tier,
    count: u32,
) -> Result<Vec<Pass>, SimulationError> {
    let windows = Windows::new(scene, count)?;
    let mut passes = Vec::new();
    for _ in 0..PASSES {
        let frames = &mut windows.clone();
        passes.push(pass(scene, variants, tier, frames, None, &mut ())?);
    }
    Ok(passes)
}
