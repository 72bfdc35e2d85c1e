//! Judges a scene's run frame by frame: every pair of meshes that meet exactly must be in every
//! strategy's list.

use std::ops::Range;

use miette::Diagnostic;
use rayon::prelude::*;
use thiserror::Error;

use crate::scene::Scene;
use crate::simulate::{SimulationError, Trajectory};
use sdop::bodies::Bodies;
use sdop_judge::configuration::{Rotation, rows};
use sdop_judge::truth::answers::{Answers, Predicate};
use sdop_judge::truth::reference_shapes::Shapes;
use sdop_judge::verify::{Ledger, RoundError, Run};

/// Frames that are judged at once, to bound memory. A culler is used for one block, and each block
/// takes the next modes of the rotation: a hundred frames test every configuration in twenty modes.
const FRAMES_PER_BLOCK: usize = 5;

/// Number of blocks of this number of frames.
#[must_use]
pub const fn blocks(frames: usize) -> usize {
    frames.div_ceil(FRAMES_PER_BLOCK)
}

/// The frames of a block.
#[must_use]
pub fn frames_of(block: usize, frames: usize) -> Range<usize> {
    block * FRAMES_PER_BLOCK..frames.min((block + 1) * FRAMES_PER_BLOCK)
}

/// The error of a scene that can't be judged.
#[derive(Debug, Error, Diagnostic)]
pub enum SceneJudgeError {
    /// Culling or the reference refuses it.
    #[error(transparent)]
    Round(#[from] RoundError),
    /// The simulation fails.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Simulation(#[from] SimulationError),
}

/// Runs a scene of `frames` frames up to the end of a block, judges every pair of the block by
/// every predicate, meshes included, and culls its frames in every configuration, in the block's
/// modes.
///
/// # Errors
/// The scene can't be run or judged.
pub fn block(
    scene: &Scene,
    frames: usize,
    block: usize,
    rotation: &Rotation,
) -> Result<Ledger, SceneJudgeError> {
    let shapes = Shapes::new(scene.shapes.clone()).map_err(RoundError::from)?;
    let rows = rows((scene.cull.k, scene.cull.axes));
    let trajectory = Trajectory::new(scene).map_err(SimulationError::from)?;
    let mut trajectory = trajectory.with_frames(frames as u32);
    let mut ledger = Ledger::default();
    let which = frames_of(block, frames);
    for _ in 0..which.start {
        trajectory.advance()?;
    }
    let bodies = trajectory.take(which.len());
    let bodies = bodies.collect::<Result<Vec<Bodies>, _>>()?;
    let judge = |frame| Answers::judge(&shapes, frame, scene.cull.k, &Predicate::ALL);
    let answers: Result<Vec<_>, _> = bodies.par_iter().map(judge).collect();
    let answers = answers.map_err(RoundError::from)?;
    answers.iter().for_each(|frame| ledger.note(frame));
    let modes = rotation.turn(block as u64);
    let run = Run { shapes: &shapes, frames: &bodies, answers: &answers };
    let culled: Result<Vec<_>, _> = rows
        .par_iter()
        .enumerate()
        .map(|(n, row)| {
            let mut part = Ledger::default();
            run.check_row(n, row, &modes, &mut part)?;
            Ok::<_, RoundError>(part)
        })
        .collect();
    culled?.into_iter().for_each(|part| ledger.add(part));
    Ok(ledger)
}
