//! The judged culler: a Rust type, a function, or (in [`super::process`]) a program.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::answer::{Answer, AnswerError, StopReason};
use super::case::{Case, Frame};
use super::claim::Claim;
use crate::contestant::{Contestant, WorldBox};
use sdop::bodies::Bodies;
use sdop::volume::Shape;
use sdop_reference::broad_phase::all_pairs;

/// The input of a culler's constructor: the first frame of a case.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// The claim by which it is judged.
    pub claim: Claim,
    /// The shapes of the bodies.
    pub shapes: &'a [Shape],
    /// The bodies of the first frame.
    pub bodies: &'a Bodies,
    /// Their boxes.
    pub boxes: &'a [WorldBox],
}

/// Answers cases.
pub trait Subject: Sync {
    /// One answer per frame.
    ///
    /// # Errors
    /// It skips the case, or fails.
    fn answer(&self, case: &Case) -> Result<Vec<Answer>, StopReason>;
}

/// A maker of Rust cullers, one for each case.
pub struct ContestantFactory<F>(pub F);

impl<F, C> Subject for ContestantFactory<F>
where
    F: Fn(&Scene<'_>) -> C + Sync,
    C: Contestant,
{
    fn answer(&self, case: &Case) -> Result<Vec<Answer>, StopReason> {
        guarded(|answers| self.run(case, answers))
    }
}

/// The answers that `run` collects; a panic is an error of the case.
fn guarded(
    run: impl FnOnce(&mut Vec<Answer>) -> Result<(), StopReason>,
) -> Result<Vec<Answer>, StopReason> {
    let mut answers = Vec::new();
    match catch_unwind(AssertUnwindSafe(|| run(&mut answers))) {
        Ok(Ok(())) => Ok(answers),
        Ok(Err(stop)) => Err(stop),
        Err(payload) => {
            let text = payload.downcast_ref::<String>().map(String::as_str);
            let text = text.or(payload.downcast_ref::<&str>().copied());
            Err(StopReason::Trouble(AnswerError::Crashed {
                how: format!("panicked: {}", text.unwrap_or("without a message")),
                answered: answers.len(),
                said: String::new(),
            }))
        }
    }
}

impl<F, C> ContestantFactory<F>
where
    F: Fn(&Scene<'_>) -> C + Sync,
    C: Contestant,
{
    fn run(&self, case: &Case, answers: &mut Vec<Answer>) -> Result<(), StopReason> {
        let Some(first) = case.frames.first() else {
            return Ok(());
        };
        let mut culler = (self.0)(&Scene {
            claim: case.claim,
            shapes: &case.shapes,
            bodies: &first.bodies,
            boxes: &first.boxes,
        });
        for frame in &case.frames {
            let mut why = prepared(&mut culler, frame).err();
            if why.is_none() {
                culler.boxes(&frame.boxes);
                culler.frame(&frame.bodies);
                culler.settle();
                answers.push(Answer { pairs: culler.pairs(), ..Answer::default() });
                why = (frame.save && !culler.save()).then_some("its state can't be saved");
            }
            if let Some(why) = why {
                let (why, answered) = (why.to_owned(), std::mem::take(answers));
                return Err(StopReason::Skipped { why, answered });
            }
        }
        Ok(())
    }
}

/// Gives a culler what comes before a frame, or says what it can't do.
fn prepared(culler: &mut impl Contestant, frame: &Frame) -> Result<(), &'static str> {
    let can = |can: bool, why| if can { Ok(()) } else { Err(why) };
    if frame.restore {
        can(culler.restore(), "it can't go back to a saved state")?;
    }
    if let Some(was) = &frame.was {
        can(culler.change(&frame.bodies, was), "its set of bodies can't change")?;
    }
    if let Some(filter) = &frame.filter {
        can(culler.filter(filter), "it has no filters")?;
    }
    if let Some(margins) = &frame.margins {
        can(culler.margins(margins), "it has no margins")?;
    }
    if let Some(periods) = frame.periods {
        can(culler.periods(periods), "its space has no periods")?;
    }
    match &frame.parts {
        Some(parts) => can(culler.body_parts(parts), "its bodies are single shapes"),
        None => Ok(()),
    }
}

/// A culler that keeps nothing between frames: a function of a case's shapes and of a frame.
pub struct CullFunction<F>(pub F);

impl<F> Subject for CullFunction<F>
where
    F: Fn(&[Shape], &Frame) -> Vec<[u32; 2]> + Sync,
{
    fn answer(&self, case: &Case) -> Result<Vec<Answer>, StopReason> {
        guarded(|answers| {
            answers.extend(
                case.frames.iter().map(|frame| Answer {
                    pairs: (self.0)(&case.shapes, frame),
                    ..Answer::default()
                }),
            );
            Ok(())
        })
    }
}

/// A test of single pairs, run over all pairs, which makes a culler of it.
pub struct PairwiseTest<T>(pub T);

impl<T> Subject for PairwiseTest<T>
where
    T: Fn(&[Shape], &Frame, [usize; 2]) -> bool + Sync,
{
    fn answer(&self, case: &Case) -> Result<Vec<Answer>, StopReason> {
        let cull = |shapes: &[Shape], frame: &Frame| {
            let overlap = |&[i, j]: &[u32; 2]| (self.0)(shapes, frame, [i as usize, j as usize]);
            let pairs = all_pairs(&frame.bodies.dynamic).map(|(i, j)| [i, j]);
            pairs.filter(overlap).collect()
        };
        CullFunction(cull).answer(case)
    }
}
