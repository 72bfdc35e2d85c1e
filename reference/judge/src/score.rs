//! Judges one case: missed pairs, additional pairs, and their causes.

use std::sync::OnceLock;

use serde::Serialize;

use super::answer::{Answer, AnswerError, StopReason, sorted};
use super::case::{Case, Frame};
use super::claim::Claim;
use super::subject::Subject;
use super::truth::{Truth, boxes_meet, images};
use crate::contestant::WorldBox;
use crate::truth::reference_shapes::InvalidInput;
use sdop::rounding::period::wrap;

/// Pairs counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct PairCounts {
    /// Pairs judged, over all frames.
    pub judged: u64,
    /// Pairs for which the claim holds.
    pub required: u64,
    /// Required pairs that were not reported: the claim is broken.
    pub missed: u64,
    /// The number of all reported pairs for which the claim doesn't hold.
    pub extra: u64,
    /// Of those: it would hold if the bodies were nearer by 2⁻¹⁸ of their size and distance. The
    /// price of rounding.
    pub by_rounding: u64,
    /// Of the others: their bounding balls meet (with given boxes: the boxes grown by half of their
    /// size). A looser volume.
    pub by_looseness: u64,
    /// Of the others: both bodies are static.
    pub both_static: u64,
}

impl PairCounts {
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

    /// Extra pairs without a known cause.
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
    /// Not judged, with the reason.
    Skipped {
        /// The reason that was given.
        why: String,
    },
    /// There is no answer to judge.
    Error {
        /// What happened.
        trouble: AnswerError,
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
pub struct CaseScore {
    /// How it ended.
    pub outcome: Outcome,
    /// Pairs counted; all zero unless it was judged.
    pub count: PairCounts,
    /// The first missed pair.
    pub miss: Option<Miss>,
    /// Pairs by frame, sorted.
    pub lists: Vec<Vec<[u32; 2]>>,
}

impl CaseScore {
    fn without_answers(outcome: Outcome) -> Self {
        Self { outcome, count: PairCounts::default(), miss: None, lists: Vec::new() }
    }
}

/// Lets a subject answer a case and judges the answers. With `twice` it answers again, and has to
/// say the same.
///
/// # Errors
/// A case that the reference refuses.
pub fn judge_case(
    subject: &dyn Subject,
    case: &Case,
    twice: bool,
) -> Result<CaseScore, InvalidInput> {
    KnownCase::new(case).judge(subject, twice)
}

/// Judges given answers.
///
/// # Errors
/// A case that the reference refuses.
pub fn judge_answers(case: &Case, answers: &[Answer]) -> Result<CaseScore, InvalidInput> {
    KnownCase::new(case).judge_answers(answers)
}

/// A case whose truth is found once, when it is first needed.
pub struct KnownCase<'a> {
    case: &'a Case,
    known: OnceLock<CaseTruth>,
}

/// By the claim, by balls, and the pairs that are required in each frame.
type CaseTruth = (Truth, Truth, Vec<Vec<[u32; 2]>>);

impl<'a> KnownCase<'a> {
    /// A case of which nothing is known yet.
    #[must_use]
    pub fn new(case: &'a Case) -> Self {
        Self { case, known: OnceLock::new() }
    }

    fn known(&self) -> Result<&CaseTruth, InvalidInput> {
        if let Some(known) = self.known.get() {
            return Ok(known);
        }
        let case = self.case;
        let truth = Truth::new(case.claim, &case.shapes)?;
        let required = case.frames.iter().map(|frame| truth.pairs(frame));
        let required = required.collect::<Result<_, _>>()?;
        let balls = Truth::new(Claim::Sphere, &case.shapes)?;
        Ok(self.known.get_or_init(|| (truth, balls, required)))
    }

    /// The pairs that the claim requires in each frame, sorted.
    ///
    /// # Errors
    /// A case that the reference refuses.
    pub fn required(&self) -> Result<&[Vec<[u32; 2]>], InvalidInput> {
        Ok(&self.known()?.2)
    }

    /// As [`judge_case`].
    ///
    /// # Errors
    /// A case that the reference refuses.
    pub fn judge(&self, subject: &dyn Subject, twice: bool) -> Result<CaseScore, InvalidInput> {
        let judge = || match subject.answer(self.case) {
            Ok(answers) => self.judge_answers(&answers),
            Err(stop) => stopped(self.case, stop),
        };
        let mut judged = judge()?;
        if self.case.claim == Claim::Order
            && judged.outcome == Outcome::Pass
            && let Some(other) = in_other_orders(subject, self.case, &judged)?
        {
            return Ok(other);
        }
        if twice && judged.outcome == Outcome::Pass {
            let again = judge()?;
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

    /// Judges given answers.
    ///
    /// # Errors
    /// A case that the reference refuses.
    pub fn judge_answers(&self, answers: &[Answer]) -> Result<CaseScore, InvalidInput> {
        let case = self.case;
        if answers.len() != case.frames.len() {
            let trouble = AnswerError::Early {
                answered: answers.len(),
                frames: case.frames.len(),
                said: String::new(),
            };
            return Ok(CaseScore::without_answers(Outcome::Error { trouble }));
        }
        let mut lists = Vec::new();
        for (number, (frame, answer)) in case.frames.iter().zip(answers).enumerate() {
            match sorted(number, frame, answer) {
                Ok(list) => lists.push(list),
                Err(trouble) => return Ok(CaseScore::without_answers(Outcome::Error { trouble })),
            }
        }
        let (truth, balls, required) = self.known()?;
        let (mut count, mut miss, mut parted) = (PairCounts::default(), None, Vec::new());
        count.judged = case.pairs();
        for (number, (frame, list)) in case.frames.iter().zip(&lists).enumerate() {
            let required = &required[number];
            count.required += required.len() as u64;
            for pair in required.iter().filter(|pair| list.binary_search(pair).is_err()) {
                count.missed += 1;
                miss = miss.or(Some(Miss { frame: number, pair: *pair }));
            }
            let extra = list.iter().filter(|pair| required.binary_search(pair).is_err());
            for (n, pair) in extra.enumerate() {
                if truth.parts(frame, *pair) {
                    parted.push((number, *pair));
                }
                if n >= MOST_EXPLAINED {
                    count.extra += 1;
                    continue;
                }
                explain([truth, balls], frame, *pair, &mut count)?;
            }
        }
        let wrong = match (miss, parted.first(), not_restored(case, &lists)) {
            (Some(Miss { frame, pair }), ..) => {
                let ([i, j], PairCounts { missed, required, .. }) = (pair, count);
                Some(format!(
                    "misses {missed} of {required} pairs, first bodies {i} and {j} in frame {frame}"
                ))
            }
            (_, Some((frame, [i, j])), _) => Some(format!(
                "reports {} pairs that the filter parts, first bodies {i} and {j} in frame {frame}",
                parted.len()
            )),
            (.., Some(frame)) => Some(format!(
                "reports other pairs in frame {frame} than before its state was restored"
            )),
            (None, None, None) => None,
        };
        let outcome = wrong.map_or(Outcome::Pass, |why| Outcome::Fail { why });
        Ok(CaseScore { outcome, count, miss, lists })
    }
}

/// The case with its bodies in other orders, backwards and by threes: what is wrong with the first
/// of them that isn't answered alike.
fn in_other_orders(
    subject: &dyn Subject,
    case: &Case,
    judged: &CaseScore,
) -> Result<Option<CaseScore>, InvalidInput> {
    let backwards = |count: usize| (0..count).rev().collect::<Vec<_>>();
    let by_threes = |count: usize| (0..3).flat_map(|first| (first..count).step_by(3)).collect();
    for order in [backwards, by_threes] {
        let other = case.reordered(order);
        let mut again = match subject.answer(&other) {
            Ok(answers) => judge_answers(&other, &answers)?,
            Err(stop) => stopped(&other, stop)?,
        };
        for (list, frame) in again.lists.iter_mut().zip(&case.frames) {
            let order = order(frame.bodies.len());
            for pair in &mut *list {
                let [i, j] = pair.map(|body| order[body as usize] as u32);
                *pair = [i.min(j), i.max(j)];
            }
            list.sort_unstable();
        }
        if again.outcome == Outcome::Pass && again.lists != judged.lists {
            let why = "reports other pairs when its bodies come in another order".to_owned();
            again.outcome = Outcome::Fail { why };
        }
        if again.outcome != Outcome::Pass {
            // Its numbers are not the case's.
            again.miss = None;
            return Ok(Some(again));
        }
    }
    Ok(None)
}

/// The first frame after a saved state was restored whose list isn't the one that the same frame
/// had after the state was saved.
fn not_restored(case: &Case, lists: &[Vec<[u32; 2]>]) -> Option<usize> {
    let input = |frame: &Frame| Frame { save: false, restore: false, ..frame.clone() };
    let (mut saved, mut twin) = (0, None);
    for (number, frame) in case.frames.iter().enumerate() {
        if frame.restore {
            twin = Some(saved + 1);
        }
        twin = twin.filter(|&at: &usize| at < number && input(&case.frames[at]) == input(frame));
        if let Some(at) = twin {
            if lists[at] != lists[number] {
                return Some(number);
            }
            twin = Some(at + 1);
        }
        if frame.save {
            saved = number;
        }
    }
    None
}

/// The result of a case without all answers. A wrong answer counts, also if the rest of the case is
/// skipped.
fn stopped(case: &Case, stop: StopReason) -> Result<CaseScore, InvalidInput> {
    let (why, answered) = match stop {
        StopReason::Skipped { why, answered } => (why, answered),
        StopReason::Trouble(trouble) => {
            return Ok(CaseScore::without_answers(Outcome::Error { trouble }));
        }
    };
    let mut begun = case.clone();
    begun.frames.truncate(answered.len());
    let judged = judge_answers(&begun, &answered)?;
    Ok(match judged.outcome {
        Outcome::Fail { .. } | Outcome::Error { .. } => judged,
        Outcome::Pass | Outcome::Skipped { .. } => {
            CaseScore::without_answers(Outcome::Skipped { why })
        }
    })
}

/// Extra pairs of a frame whose causes are looked for: a culler that reports all pairs of a large
/// set has tens of millions.
const MOST_EXPLAINED: usize = 1 << 16;

/// Counts an extra pair by its cause.
fn explain(
    [truth, balls]: [&Truth; 2],
    frame: &Frame,
    pair: [u32; 2],
    count: &mut PairCounts,
) -> Result<(), InvalidInput> {
    count.extra += 1;
    let is_fixed = |body: &u32| !frame.bodies.dynamic[*body as usize];
    // The two alone: sets may be large.
    let alone = frame.picked(&pair.map(|body| body as usize));
    if pair.iter().all(is_fixed) {
        count.both_static += 1;
    } else if truth.pair(&nearer(&alone, [0, 1]), [0, 1]) == Ok(true) {
        count.by_rounding += 1;
    } else if meet_loosely([truth, balls], &alone, [0, 1])? {
        count.by_looseness += 1;
    }
    Ok(())
}

/// Whether a looser volume than the claim's meets.
fn meet_loosely(
    [truth, balls]: [&Truth; 2],
    frame: &Frame,
    pair: [u32; 2],
) -> Result<bool, InvalidInput> {
    if !truth.claim().is_of_boxes() {
        return balls.pair(frame, pair);
    }
    let [a, b] = pair.map(|body| grown(&frame.boxes[body as usize]));
    Ok(match frame.periods {
        Some(periods) => !images(&a, &b, periods).is_empty(),
        None => boxes_meet(&a, &b),
    })
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

/// The frame with the second body moved toward the first, or its nearest image, by 2⁻¹⁸ of their
/// size and distance from the origin, on each axis.
fn nearer(frame: &Frame, [i, j]: [u32; 2]) -> Frame {
    let mut nearer = frame.clone();
    let (i, j) = (i as usize, j as usize);
    let (a, b) = (frame.boxes[i], frame.boxes[j]);
    let size = a.iter().chain(&b).fold(0.0, |m: f32, x| m.max(x.abs()));
    let by = size * 2_f32.powi(-18);
    for axis in 0..3 {
        let gap = (b[axis] + b[axis + 3]) / 2.0 - (a[axis] + a[axis + 3]) / 2.0;
        let period = frame.periods.and_then(|periods| periods[axis]);
        let gap = period.map_or(gap, |period| wrap(f64::from(gap), period).0 as f32);
        let step = by.min(gap.abs()) * -gap.signum();
        nearer.bodies.translation[j][axis] += step;
        nearer.boxes[j][axis] += step;
        nearer.boxes[j][axis + 3] += step;
    }
    nearer
}

#[cfg(test)]
mod tests;
