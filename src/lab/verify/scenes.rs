//! A scene's run judged frame by frame, end to end: every mesh pair that meets exactly must be in every strategy's list.

use miette::Diagnostic;
use rayon::prelude::*;
use thiserror::Error;

use super::answers::{Answers, Predicate};
use super::judged::Shapes;
use super::rounds::{Ledger, RoundError, Run};
use super::ways::{Rotation, rows};
use crate::bodies::Bodies;
use crate::lab::scene::Scene;
use crate::lab::simulate::{SimulationError, Trajectory};

/// Frames that are judged at once, to bound memory. A culler lives for one block, and each block is a turn of the rotation:
/// a hundred frames show every way in twenty modes.
const BLOCK: usize = 5;

/// Why a scene can't be judged.
#[derive(Debug, Error, Diagnostic)]
pub enum JudgeError {
    /// Culling or the reference refuses it.
    #[error(transparent)]
    Round(#[from] RoundError),
    /// The scene can't be run on.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Simulation(#[from] SimulationError),
}

/// Runs `frames` frames of a scene, judges every pair by every predicate, meshes included, and culls the frames in every
/// way, in the modes whose turn it is. `done` is told after each block of frames how many are behind.
///
/// # Errors
/// A scene that can't be run or judged.
pub fn scene(
    scene: &Scene,
    frames: usize,
    rotation: &Rotation,
    done: impl Fn(usize),
) -> Result<Ledger, JudgeError> {
    let shapes = Shapes::new(scene.shapes.clone()).map_err(RoundError::from)?;
    let rows = rows((scene.cull.k, scene.cull.axes));
    let trajectory = Trajectory::new(scene).map_err(SimulationError::from)?;
    let mut trajectory = trajectory.with_frames(frames as u32);
    let mut ledger = Ledger::default();
    let mut behind = 0;
    while behind < frames {
        let block = trajectory.by_ref().take(BLOCK);
        let block = block.collect::<Result<Vec<Bodies>, _>>()?;
        let judge = |frame| Answers::judge(&shapes, frame, scene.cull.k, &Predicate::ALL);
        let answers: Result<Vec<_>, _> = block.par_iter().map(judge).collect();
        let answers = answers.map_err(RoundError::from)?;
        answers.iter().for_each(|frame| ledger.note(frame));
        let modes = rotation.turn((behind / BLOCK) as u64);
        let run = Run {
            shapes: &shapes,
            frames: &block,
            answers: &answers,
        };
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
        behind += block.len();
        done(behind);
    }
    Ok(ledger)
}
