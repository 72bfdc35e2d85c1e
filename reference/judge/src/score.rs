//! One case judged: what was missed, what was reported on top, and why.

use serde::Serialize;

use super::answer::{Answer, Stop, Trouble, sorted};
use super::case::{Case, Frame};
use super::claim::Claim;
use super::subject::Subject;
use super::truth::{Truth, boxes_meet};
use crate::contestant::WorldBox;
use crate::ours::judged::InvalidInput;

/// Pairs counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Count {
    /// Pairs judged, over all frames.
    pub judged: u64,
    /// Pairs of which the claim holds.
    pub required: u64,
    /// Of those, not reported: the claim broken.
    pub missed: u64,
    /// Reported although the claim doesn't hold, in all.
    pub extra: u64,
    /// Of those: it would hold if the bodies were nearer by 2⁻¹⁸ of their size and distance. The price of rounding.
    pub by_rounding: u64,
    /// Of the others: their bounding balls meet (with given boxes: the boxes grown by half of their size). A looser volume.
    pub by_looseness: u64,
    /// Of the others: both bodies are static.
    pub both_static: u64,
}

impl Count {
    /// Adds another count.
    pub fn add(&mut self, other: &Self) {
        self.judged += other.judged;
        self.required += other.required;
        self.missed += other.missed;
        self.extra += other.extra;
        self.by_rounding += other.by_rounding;
        self.by_looseness += other.by_looseness;
        self.both_static += other.both_static;
    }

    /// Extra pairs without a cause that anyone would state.
    #[must_use]
    pub fn unexplained(&self) -> u64 {
        self.extra - self.by_rounding - self.by_looseness - self.both_static
    }
}

/// How a case ended.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(tag = "outcome", rename_all = "kebab-case")]
pub enum Outcome {
    /// Nothing was missed.
    Pass,
    /// A pair was missed, or answers differ from run to run.
    Fail {
        /// What is wrong, in a sentence.
        why: String,
    },
    /// Not judged, and why.
    Skipped {
        /// The reason that was given.
        why: String,
    },
    /// No answer that could be judged.
    Error {
        /// What happened.
        trouble: Trouble,
    },
}

/// A missed pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Miss {
    /// The frame's number.
    pub frame: usize,
    /// The pair.
    pub pair: [u32; 2],
}

/// A case's result.
#[derive(Clone, Debug)]
pub struct Judged {
    /// How it ended.
    pub outcome: Outcome,
    /// Pairs counted; all zero unless it was judged.
    pub count: Count,
    /// The first missed pair.
    pub miss: Option<Miss>,
    /// Pairs by frame, sorted.
    pub lists: Vec<Vec<[u32; 2]>>,
}

impl Judged {
    fn without_answers(outcome: Outcome) -> Self {
        Self {
            outcome,
            count: Count::default(),
            miss: None,
            lists: Vec::new(),
        }
    }
}

/// Lets a subject answer a case and judges the answers. With `twice` it answers again, and has to say the same.
///
/// # Errors
/// A case that the reference refuses.
pub fn judge_case(
    subject: &dyn Subject,
    case: &Case,
    claim: Claim,
    twice: bool,
) -> Result<Judged, InvalidInput> {
    let answers = match subject.answer(case, claim) {
        Ok(answers) => answers,
        Err(stop) => return Ok(stopped(stop)),
    };
    let mut judged = judge_answers(case, claim, &answers)?;
    if twice && judged.outcome == Outcome::Pass {
        let again = match subject.answer(case, claim) {
            Ok(answers) => judge_answers(case, claim, &answers)?,
            Err(stop) => stopped(stop),
        };
        if again.outcome != Outcome::Pass {
            return Ok(again);
        }
        if again.lists != judged.lists {
            let why = "reports other pairs when it runs again".to_owned();
            judged.outcome = Outcome::Fail { why };
        }
    }
    Ok(judged)
}

fn stopped(stop: Stop) -> Judged {
    Judged::without_answers(match stop {
        Stop::Skipped(why) => Outcome::Skipped { why },
        Stop::Trouble(trouble) => Outcome::Error { trouble },
    })
}

/// Judges answers that are there already.
///
/// # Errors
/// A case that the reference refuses.
pub fn judge_answers(
    case: &Case,
    claim: Claim,
    answers: &[Answer],
) -> Result<Judged, InvalidInput> {
    if answers.len() != case.frames.len() {
        let trouble = Trouble::Early {
            answered: answers.len(),
            frames: case.frames.len(),
            said: String::new(),
        };
        return Ok(Judged::without_answers(Outcome::Error { trouble }));
    }
    let mut lists = Vec::new();
    for (number, (frame, answer)) in case.frames.iter().zip(answers).enumerate() {
        match sorted(number, frame, answer) {
            Ok(list) => lists.push(list),
            Err(trouble) => return Ok(Judged::without_answers(Outcome::Error { trouble })),
        }
    }
    let (truth, balls) = (
        Truth::new(claim, &case.shapes)?,
        Truth::new(Claim::Sphere, &case.shapes)?,
    );
    let (mut count, mut miss) = (Count::default(), None);
    count.judged = case.pairs();
    for (number, (frame, list)) in case.frames.iter().zip(&lists).enumerate() {
        let required = truth.pairs(frame)?;
        count.required += required.len() as u64;
        for pair in required
            .iter()
            .filter(|pair| list.binary_search(pair).is_err())
        {
            count.missed += 1;
            miss = miss.or(Some(Miss {
                frame: number,
                pair: *pair,
            }));
        }
        for pair in list
            .iter()
            .filter(|pair| required.binary_search(pair).is_err())
        {
            explain(&truth, &balls, claim, frame, *pair, &mut count)?;
        }
    }
    let outcome = match miss {
        None => Outcome::Pass,
        Some(Miss {
            frame,
            pair: [i, j],
        }) => Outcome::Fail {
            why: format!(
                "misses {} of {} pairs, first bodies {i} and {j} in frame {frame}",
                count.missed, count.required
            ),
        },
    };
    Ok(Judged {
        outcome,
        count,
        miss,
        lists,
    })
}

/// Counts an extra pair by its cause.
fn explain(
    truth: &Truth,
    balls: &Truth,
    claim: Claim,
    frame: &Frame,
    pair: [u32; 2],
    count: &mut Count,
) -> Result<(), InvalidInput> {
    count.extra += 1;
    let is_fixed = |body: &u32| !frame.bodies.dynamic[*body as usize];
    if pair.iter().all(is_fixed) {
        count.both_static += 1;
    } else if truth.pair(&nearer(frame, pair), pair)? {
        count.by_rounding += 1;
    } else if match claim {
        Claim::Aabb => boxes_meet(
            &grown(&frame.boxes[pair[0] as usize]),
            &grown(&frame.boxes[pair[1] as usize]),
        ),
        _ => balls.pair(frame, pair)?,
    } {
        count.by_looseness += 1;
    }
    Ok(())
}

/// A box with half of its size around it.
fn grown(ends: &WorldBox) -> WorldBox {
    let mut grown = *ends;
    for axis in 0..3 {
        let margin = 0.5 * (ends[axis + 3] - ends[axis]);
        grown[axis] -= margin;
        grown[axis + 3] += margin;
    }
    grown
}

/// The frame with the second body moved toward the first by 2⁻¹⁸ of their size and distance from the origin, on each axis.
fn nearer(frame: &Frame, [i, j]: [u32; 2]) -> Frame {
    let mut nearer = frame.clone();
    let (i, j) = (i as usize, j as usize);
    let (a, b) = (frame.boxes[i], frame.boxes[j]);
    let size = a.iter().chain(&b).fold(0.0, |m: f32, x| m.max(x.abs()));
    let by = size * 2_f32.powi(-18);
    for axis in 0..3 {
        let gap = (b[axis] + b[axis + 3]) / 2.0 - (a[axis] + a[axis + 3]) / 2.0;
        let step = by.min(gap.abs()) * -gap.signum();
        nearer.bodies.translation[j][axis] += step;
        nearer.boxes[j][axis] += step;
        nearer.boxes[j][axis + 3] += step;
    }
    nearer
}
