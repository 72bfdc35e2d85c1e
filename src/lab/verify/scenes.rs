//! A scene's run judged frame by frame, end to end: every mesh pair that meets exactly must be in every strategy's list.

use miette::Diagnostic;
use rayon::prelude::*;
use thiserror::Error;

use super::answers::{Answers, Predicate};
use super::judged::Shapes;
use super::rounds::{Ledger, RoundError, check, ways};
use crate::bodies::Bodies;
use crate::lab::scene::Scene;
use crate::lab::simulate::SimulationError;
use crate::simd::Tier;

/// Frames that are judged at once, to bound memory; a culler lives for one block.
const BLOCK: usize = 10;

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
/// way on each of `levels`. `done` is told after each block of frames how many are behind.
///
/// # Errors
/// A scene that can't be run or judged.
pub fn scene(
    scene: &Scene,
    frames: usize,
    tiers: &[Tier],
    done: impl Fn(usize),
) -> Result<Ledger, JudgeError> {
    let shapes = Shapes::new(scene.shapes.clone()).map_err(RoundError::from)?;
    let ways = ways(scene.cull.k, scene.cull.axes);
    let mut effects = scene.start_effects().map_err(SimulationError::from)?;
    let mut bodies = scene.bodies.clone();
    let mut ledger = Ledger::default();
    let mut behind = 0;
    while behind < frames {
        let mut block: Vec<Bodies> = Vec::new();
        while block.len() < BLOCK.min(frames - behind) {
            let frame = behind + block.len();
            if frame > 0 {
                let step = effects.step(&mut bodies);
                step.map_err(|error| SimulationError::Contract {
                    frame: frame as u32,
                    error,
                })?;
            }
            block.push(bodies.clone());
        }
        let judge = |frame| Answers::judge(&shapes, frame, scene.cull.k, &Predicate::ALL);
        let answers: Result<Vec<_>, _> = block.par_iter().map(judge).collect();
        let answers = answers.map_err(RoundError::from)?;
        answers.iter().for_each(|frame| ledger.note(frame));
        let culled: Result<Vec<_>, _> = ways
            .par_iter()
            .enumerate()
            .map(|(n, way)| {
                let mut part = Ledger::default();
                let tier = tiers[n % tiers.len()];
                check(&shapes, &block, &answers, way, tier, &mut part)?;
                Ok::<_, RoundError>(part)
            })
            .collect();
        culled?.into_iter().for_each(|part| ledger.add(part));
        behind += block.len();
        done(behind);
    }
    Ok(ledger)
}
