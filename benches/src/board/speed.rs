//! Recall against time: a library and our culler on the same frames, each with its own clock.

use std::time::Instant;

use sdop::BoxCuller;
use sdop_judge::answer::Answer;
use sdop_judge::score::judge_answers;
use sdop_judge::{Case, Claim, Subject};
use serde::{Deserialize, Serialize};

use crate::outsiders::timing::{TimingError, ours, strategy};

/// The clock of programs.
pub(super) const SELF_REPORTED: &str = "self-reported";

/// The time of a contestant per frame, and its recall.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Speed {
    /// The library's name.
    pub name: String,
    /// The claim.
    pub claim: Claim,
    /// Whose clock measured.
    pub clock: String,
    /// Median over frames, without the first one, in nanoseconds.
    pub median_ns: u64,
    /// Reported pairs / required pairs, over all frames.
    pub recall: f64,
    /// Reported pairs, over all frames.
    pub reported: usize,
}

impl Speed {
    /// A program, with the times that it reports. `None` if it skips the scene, doesn't answer it
    /// or reports no time.
    ///
    /// # Errors
    /// The reference rejects a frame.
    pub fn of(name: &str, subject: &dyn Subject, case: &Case) -> Result<Option<Self>, TimingError> {
        match subject.answer(case) {
            Ok(answers) => Self::judged(name, SELF_REPORTED, case, &answers),
            Err(_) => Ok(None),
        }
    }

    /// Our culler on one thread, by the wall clock around its call; none for a claim that takes
    /// more than boxes or poses.
    ///
    /// # Errors
    /// The reference or our culler rejects a frame.
    pub fn ours(case: &Case) -> Result<Option<Self>, TimingError> {
        let (name, answers) = match strategy(case.claim) {
            Some(strategy) => (format!("sdop {strategy}"), ours(strategy, case)?),
            None if case.claim == Claim::Aabb => ("sdop BoxCuller".to_owned(), boxes(case)?),
            None => return Ok(None),
        };
        Self::judged(&name, "wall, around the call", case, &answers)
    }

    fn judged(
        name: &str,
        clock: &str,
        case: &Case,
        answers: &[Answer],
    ) -> Result<Option<Self>, TimingError> {
        let count = judge_answers(case, answers)?.count;
        let warm = answers.iter().skip(1);
        let mut times: Vec<u64> = warm.filter_map(|answer| answer.ns).collect();
        times.sort_unstable();
        Ok(times.get(times.len() / 2).map(|&median_ns| Self {
            name: name.to_owned(),
            claim: case.claim,
            clock: clock.to_owned(),
            median_ns,
            recall: (count.required - count.missed) as f64 / count.required.max(1) as f64,
            reported: answers.iter().map(|answer| answer.pairs.len()).sum(),
        }))
    }
}

/// Our culler of given boxes over the frames, each with its time.
fn boxes(case: &Case) -> Result<Vec<Answer>, TimingError> {
    let mut culler = BoxCuller::builder().threads(1).build()?;
    let mut answers = Vec::new();
    for frame in &case.frames {
        let corners = |&[a, b, c, d, e, f]: &[f32; 6]| sdop::Aabb::new([a, b, c], [d, e, f]);
        let given: Vec<sdop::Aabb> = frame.boxes.iter().map(corners).collect();
        let start = Instant::now();
        culler.cull(&given)?;
        let ns = start.elapsed().as_nanos() as u64;
        let is_pair =
            |pair: &[u32; 2]| pair.iter().any(|&body| frame.bodies.dynamic[body as usize]);
        let pairs = culler.pairs().sorted().into_iter().filter(is_pair).collect();
        answers.push(Answer { pairs, ns: Some(ns), ..Answer::default() });
    }
    Ok(answers)
}
