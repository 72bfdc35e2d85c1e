//! The questions of a comparison, and their true answers.

use clap::ValueEnum;
use miette::miette;
use sdop_bench::random::Stream;
use sdop_reference::exact::query::{ExactLine, ball_meets_box, fraction, line_meets_box};
use serde::Serialize;

use crate::entry::Setup;
use crate::frame::{Slabs, lower, meet, upper};
use crate::oracle;

/// What is asked of a set of boxes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Question {
    /// All that meet a box.
    Box,
    /// All that meet a ball.
    Ball,
    /// All along a segment.
    Along,
    /// The first along a segment.
    First,
    /// All pairs of a box with an even number and one with an odd number.
    Sets,
}

impl Question {
    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Box => "box",
            Self::Ball => "ball",
            Self::Along => "along",
            Self::First => "first",
            Self::Sets => "sets",
        }
    }
}

/// A segment between two points.
pub type Segment = [[f32; 3]; 2];

/// A set of boxes and what is asked of it, f32 throughout, so that engines are given the same
/// values.
#[derive(Debug)]
pub struct Questions {
    /// The boxes.
    pub boxes: Vec<Slabs>,
    /// Boxes of half side 2.5 about bodies, which have a half side of 1.
    pub probes: Vec<Slabs>,
    /// Centres of balls with [`RADIUS`].
    pub centres: Vec<[f32; 3]>,
    /// Segments from between two bodies to another body.
    pub segments: Vec<Segment>,
}

/// The radius of the balls.
pub const RADIUS: f32 = 2.5;

impl Questions {
    /// So many questions of each kind.
    pub fn new(boxes: Vec<Slabs>, count: usize) -> Self {
        let mut random = Stream::new(1, 0);
        let middle = |slabs: &Slabs| slabs.map(|[lo, hi]| 0.5 * (lo + hi));
        let mut drawn = || middle(&boxes[random.index(boxes.len() as u32) as usize]);
        let mut probes = Vec::new();
        let mut centres = Vec::new();
        let mut segments = Vec::new();
        for _ in 0..count {
            probes.push(drawn().map(|x| [x - RADIUS, x + RADIUS]));
            centres.push(drawn());
            let (one, other) = (drawn(), drawn());
            let from = [0, 1, 2].map(|axis| 0.5 * (one[axis] + other[axis]));
            segments.push([from, drawn()]);
        }
        Self { boxes, probes, centres, segments }
    }

    /// Those of the first frame.
    ///
    /// # Errors
    /// A frame without questions.
    pub fn of<'a>(setup: &Setup<'a>) -> miette::Result<&'a Self> {
        let asked = setup.first.question.as_ref();
        asked
            .map(|(_, questions)| &**questions)
            .ok_or_else(|| miette!("it is only asked questions"))
    }

    /// The boxes with even and with odd numbers.
    pub fn halves(&self) -> [Vec<Slabs>; 2] {
        [0, 1].map(|first| self.boxes.iter().skip(first).step_by(2).copied().collect())
    }

    /// The true answers, sorted. Those of [`Question::First`] are all boxes that are met at most
    /// 2⁻²⁰ of the segment after the first, since engines have f32. Those of [`Question::Sets`] are
    /// the partners of each even body.
    pub fn truth(&self, question: Question) -> Vec<Vec<u32>> {
        match question {
            Question::Box => self.each(&self.probes, meet),
            Question::Ball => self.each(&self.centres, |centre, slabs| {
                ball_meets_box(centre.map(f64::from), f64::from(RADIUS), corners(slabs))
            }),
            Question::Along => self.each(&self.segments, |segment, slabs| {
                line_meets_box(&exact(segment), corners(slabs)).is_some()
            }),
            Question::First => self.segments.iter().map(|one| self.first(one)).collect(),
            Question::Sets => {
                let mut partners = vec![Vec::new(); self.boxes.len().div_ceil(2)];
                for [i, j] in oracle::pairs(&self.boxes) {
                    let [even, odd] = if i % 2 == 0 { [i, j] } else { [j, i] };
                    if even % 2 != odd % 2 {
                        partners[even as usize / 2].push(odd);
                    }
                }
                partners.iter_mut().for_each(|odd| odd.sort_unstable());
                partners
            }
        }
    }

    fn each<Q: Around>(
        &self,
        questions: &[Q],
        holds: impl Fn(&Q, &Slabs) -> bool,
    ) -> Vec<Vec<u32>> {
        let met = |question: &Q| {
            let near = self.near(question.around());
            let met = near.filter(|(_, slabs)| holds(question, slabs));
            met.map(|(body, _)| body).collect()
        };
        questions.iter().map(met).collect()
    }

    /// The boxes that meet one, with their numbers.
    fn near(&self, around: Slabs) -> impl Iterator<Item = (u32, &Slabs)> {
        let all = (0..).zip(&self.boxes);
        all.filter(move |(_, slabs)| meet(&around, slabs))
    }

    fn first(&self, segment: &Segment) -> Vec<u32> {
        let line = exact(segment);
        let met: Vec<_> = self
            .near(segment.around())
            .filter_map(|(body, slabs)| Some((line_meets_box(&line, corners(slabs))?, body)))
            .collect();
        let Some((least, _)) = met.iter().min() else {
            return Vec::new();
        };
        let last = least.clone() + fraction(1, 1 << 20);
        let first = met.iter().filter(|(at, _)| *at <= last);
        first.map(|&(_, body)| body).collect()
    }
}

/// A box around a question, beyond which no box is an answer.
trait Around {
    fn around(&self) -> Slabs;
}

impl Around for Slabs {
    fn around(&self) -> Slabs {
        *self
    }
}

impl Around for [f32; 3] {
    fn around(&self) -> Slabs {
        self.map(|x| [(x - RADIUS).next_down(), (x + RADIUS).next_up()])
    }
}

impl Around for Segment {
    fn around(&self) -> Slabs {
        [0, 1, 2].map(|axis| {
            let [a, b] = self.map(|end| end[axis]);
            [a.min(b), a.max(b)]
        })
    }
}

fn exact([from, to]: &Segment) -> ExactLine {
    ExactLine::segment(from.map(f64::from), to.map(f64::from))
}

fn corners(slabs: &Slabs) -> [[f64; 3]; 2] {
    [lower(slabs), upper(slabs)].map(|corner| corner.map(f64::from))
}

/// Lists as pairs of a list's number and one of its bodies.
pub fn flat(lists: &[Vec<u32>]) -> impl Iterator<Item = [u32; 2]> {
    (0..).zip(lists).flat_map(|(number, list)| list.iter().map(move |&body| [number, body]))
}

/// How many answers are missing, and how many are wrong, of pairs of a question's number and a
/// body; one that is given twice is wrong.
pub fn judge(question: Question, truth: &[Vec<u32>], answers: &[[u32; 2]]) -> [usize; 2] {
    let mut lists = vec![Vec::new(); truth.len()];
    let mut wrong = 0;
    for &[number, body] in answers {
        match lists.get_mut(number as usize) {
            Some(list) => list.push(body),
            None => wrong += 1,
        }
    }
    let mut missed = 0;
    for (truth, mut answer) in truth.iter().zip(lists) {
        let given = answer.len();
        answer.sort_unstable();
        answer.dedup();
        answer.retain(|body| truth.binary_search(body).is_ok());
        wrong += given - answer.len();
        missed += match question {
            Question::First => usize::from(!truth.is_empty() && answer.is_empty()),
            _ => truth.len() - answer.len(),
        };
    }
    [missed, wrong]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Unit boxes in a row, a gap of one between two.
    fn row() -> Questions {
        let boxes = (0..10_u8).map(|i| {
            let x = 2.0 * f32::from(i);
            [[x, x + 1.0], [0.0, 1.0], [0.0, 1.0]]
        });
        Questions {
            segments: vec![[[1.5, 0.5, 0.5], [6.0, 0.5, 0.5]], [[1.5, 2.0, 0.5], [9.0, 2.0, 0.5]]],
            ..Questions::new(boxes.collect(), 3)
        }
    }

    #[test]
    fn truth_of_a_row() {
        let row = row();
        assert_eq!(row.truth(Question::Along), [vec![1, 2, 3], vec![]]);
        assert_eq!(row.truth(Question::First), [vec![1], vec![]]);
        assert_eq!(row.truth(Question::Box).len(), 3);
        assert!(row.truth(Question::Sets).iter().all(Vec::is_empty));
    }

    #[test]
    fn every_error_counts() {
        let truth = [vec![1, 2, 3], vec![]];
        let all = |question, answers: [Vec<u32>; 2]| {
            judge(question, &truth, &flat(&answers).collect::<Vec<_>>())
        };
        assert_eq!(all(Question::Along, truth.clone()), [0, 0]);
        assert_eq!(all(Question::Along, [vec![1, 3, 4], vec![0]]), [1, 2]);
        assert_eq!(all(Question::First, [vec![2], vec![]]), [0, 0]);
        assert_eq!(all(Question::First, [vec![4], vec![7]]), [1, 2]);
        assert_eq!(all(Question::First, [vec![], vec![]]), [1, 0]);
    }
}
