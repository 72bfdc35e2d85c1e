//! Recall against time: a library and our culler on the same frames, each with its own clock.

use sdop_judge::answer::Answer;
use sdop_judge::score::judge_answers;
use sdop_judge::{Case, Claim, Subject};
use serde::{Deserialize, Serialize};

use crate::outsiders::{TimingError, ours, own_name};

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
        if !Claim::PLAIN.contains(&case.claim) {
            return Ok(None);
        }
        Self::judged(&own_name(case.claim), "wall, around the call", case, &ours(case)?)
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
