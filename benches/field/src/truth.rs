//! Comparing every engine's answers with the exact ones, before anything is timed and again at the
//! end: with the oracle's pairs, with those of a newly built culler of meshes, or with the answers
//! to questions.

use miette::Diagnostic;
use sdop::culler::Culler;
use sdop::rounding::U;
use sdop_bench::remedy::OrReport as _;
use sdop_bench::scene::Scene;
use sdop_judge::Claim;
use thiserror::Error;

use crate::entry::Entry;
use crate::frame::{Frame, meet};
use crate::oracle;
use crate::questions::{Question, judge};

/// What must be found in a frame.
pub struct Truth<'a> {
    present: &'a Frame,
    boxes: Vec<[u32; 2]>,
    spheres: Vec<[u32; 2]>,
    culled: Vec<[u32; 2]>,
    asked: Option<(Question, Vec<Vec<u32>>)>,
}

/// How an engine's answer compares with the truth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Judged {
    /// Pairs, or answers.
    pub pairs: usize,
    /// Those that need not be reported.
    pub extra: usize,
    /// Answers to questions that are missing.
    pub missed: usize,
}

/// The error for an engine whose pairs differ from the expected ones.
#[derive(Debug, Error, Diagnostic)]
#[error("{engine}: the pair ({i}, {j}) is {fault}", i = pair[0], j = pair[1])]
#[diagnostic(help("the boxes are {boxes}; nothing is timed while answers differ"))]
pub struct Mismatch {
    engine: &'static str,
    pair: [u32; 2],
    fault: &'static str,
    boxes: String,
}

impl<'a> Truth<'a> {
    /// The truth about all present bodies, as far as these engines need it.
    pub fn of(present: &'a Frame, scene: &Scene, entries: &[Entry]) -> miette::Result<Self> {
        let mut truth = Self {
            present,
            boxes: Vec::new(),
            spheres: Vec::new(),
            culled: Vec::new(),
            asked: None,
        };
        if let Some((question, questions)) = &present.question {
            truth.asked = Some((*question, questions.truth(*question)));
            return Ok(truth);
        }
        truth.boxes = oracle::pairs(&present.boxes);
        let has = |claim| entries.iter().any(|entry| entry.row.claim == claim);
        if has(Claim::Sphere) {
            // Spheres that touch lie in boxes that do. What f64 can't tell from a contact isn't
            // required.
            let touch = |&&pair: &&[u32; 2]| relative_gap(present, pair) <= -1e-14;
            truth.spheres = truth.boxes.iter().filter(touch).copied().collect();
        }
        if has(Claim::Mesh) {
            let mut culler = Culler::new(&scene.shapes, &present.bodies).or_report()?;
            truth.culled = culler.cull(&present.bodies).or_report()?.iter().collect();
            truth.culled.sort_unstable();
        }
        Ok(truth)
    }

    /// How many pairs of boxes there are.
    pub fn boxes(&self) -> usize {
        self.boxes.len()
    }

    /// Compares an engine's pairs, which may come in any order and either way round.
    ///
    /// # Errors
    /// The first pair that is missing, listed twice, or additional where it must not be; of answers
    /// to questions, missing and wrong ones are counted.
    pub fn judge(&self, entry: &Entry, mut pairs: Vec<[u32; 2]>) -> Result<Judged, Mismatch> {
        if let Some((question, truth)) = &self.asked {
            let [missed, extra] = judge(*question, truth, &pairs);
            return Ok(Judged { pairs: pairs.len(), extra, missed });
        }
        pairs.iter_mut().for_each(|pair| pair.sort_unstable());
        pairs.sort_unstable();
        let required = match entry.row.claim {
            Claim::Sphere => &self.spheres,
            Claim::Mesh => &self.culled,
            _ => &self.boxes,
        };
        let additional = outside(&pairs, required);
        let refused = additional.iter().find(|pair| !self.allows(entry, **pair));
        let twice = pairs.windows(2).find(|two| two[0] == two[1]);
        let faults = [
            (twice.map(|two| two[0]), "reported twice"),
            (outside(required, &pairs).first().copied(), "missing"),
            (refused.copied(), "no pair"),
        ];
        match faults.into_iter().find_map(|(pair, fault)| Some((pair?, fault))) {
            None => Ok(Judged { pairs: pairs.len(), extra: additional.len(), missed: 0 }),
            Some((pair, fault)) => Err(Mismatch {
                engine: entry.name(),
                pair,
                fault,
                boxes: pair
                    .map(|body| format!("{:?}", self.present.boxes.get(body as usize)))
                    .join(" and "),
            }),
        }
    }

    /// Whether an engine may report this additional pair.
    fn allows(&self, entry: &Entry, pair: [u32; 2]) -> bool {
        let [Some(a), Some(b)] = pair.map(|body| self.present.boxes.get(body as usize)) else {
            return false;
        };
        if entry.row.claim == Claim::Sphere {
            // What the sphere test's rounding may add: `sdop::rounding::sphere`.
            return pair[0] != pair[1] && relative_gap(self.present, pair) <= 15.0 * U;
        }
        let timed = &entry.row.timed;
        // The coordinates' own rounding is far less than the thousandth.
        let reach = 1.001 * timed.within;
        let grown = a.map(|[lo, hi]| [lo - reach, hi + reach]);
        pair[0] != pair[1] && (timed.late || (reach > 0.0 && meet(&grown, b)))
    }
}

/// How far two spheres are apart over the sum of their radii; negative when they overlap.
fn relative_gap(frame: &Frame, pair: [u32; 2]) -> f64 {
    let [a, b] = pair.map(|body| frame.bodies.translation[body as usize].map(f64::from));
    let distance = (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt();
    let [ra, rb] = pair.map(|body| f64::from(frame.radii[body as usize]));
    distance / (ra + rb) - 1.0
}

/// Those of the sorted `these` that the sorted `those` lack.
fn outside(these: &[[u32; 2]], those: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let mut those = those.iter().peekable();
    let is_outside = |pair: &&[u32; 2]| {
        while those.next_if(|other| other < pair).is_some() {}
        those.peek() != Some(pair)
    };
    these.iter().filter(is_outside).copied().collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;
    use sdop_bench::roster::{Roster, TimedUse};

    /// Three boxes in a row: 0 and 1 touch in a face, 2 is a tenth from 1.
    fn row() -> Frame {
        let mut frame = Frame::default();
        for x in [0.0, 2.0, 4.1_f32] {
            frame.bodies.push(0, true, [0.0, 0.0, 0.0, 1.0], [x, 0.0, 0.0]);
            frame.radii.push(1.0);
            frame.boxes.push([[x - 1.0, x + 1.0], [-1.0, 1.0], [-1.0, 1.0]]);
        }
        frame
    }

    fn entry(claim: Claim, within: f32, late: bool) -> Entry {
        let roster = Roster::parse(include_str!("../engines.toml")).unwrap();
        let mut row = roster.engine.into_iter().next().unwrap();
        (row.name, row.claim) = ("engine".to_owned(), claim);
        row.timed = TimedUse { within, late, ..TimedUse::default() };
        Entry { row: Box::leak(Box::new(row)), new: |_| Err(miette::miette!("never asked for")) }
    }

    fn judged(entry: &Entry, pairs: &[[u32; 2]]) -> Result<(usize, usize), String> {
        let present = row();
        let boxes = oracle::pairs(&present.boxes);
        let truth =
            Truth { present: &present, boxes, spheres: vec![], culled: vec![], asked: None };
        let judged = truth.judge(entry, pairs.to_vec());
        judged.map(|it| (it.pairs, it.extra)).map_err(|fault| fault.to_string())
    }

    /// Touching boxes are a pair either way round, and a fault names the engine and the pair.
    #[test]
    fn additional_pairs_are_within_the_margin() {
        let judged =
            |within, late, pairs: &[[u32; 2]]| judged(&entry(Claim::Aabb, within, late), pairs);
        assert_eq!(judged(0.0, false, &[[1, 0]]), Ok((1, 0)));
        let near = [[0, 1], [2, 1]];
        assert_eq!(judged(0.11, false, &near), Ok((2, 1)));
        assert_eq!(judged(0.0, true, &[[0, 1], [0, 2]]), Ok((2, 1)));
        for (within, late, pairs, fault) in [
            (0.0, false, &near[..], "(1, 2) is no pair"),
            (0.09, false, &near, "(1, 2) is no pair"),
            (0.0, true, &[[1, 2]], "(0, 1) is missing"),
            (0.0, false, &[[0, 1], [1, 0]], "(0, 1) is reported twice"),
            (0.0, true, &[[0, 1], [2, 2]], "(2, 2) is no pair"),
            (0.0, true, &[[0, 1], [1, 9]], "(1, 9) is no pair"),
        ] {
            assert_eq!(judged(within, late, pairs), Err(format!("engine: the pair {fault}")));
        }
    }

    /// Spheres that touch may be reported, and need not.
    #[test]
    fn touching_spheres_may_be_reported() {
        let spheres = entry(Claim::Sphere, 0.0, false);
        assert_eq!(judged(&spheres, &[[0, 1]]), Ok((1, 1)));
        assert_eq!(judged(&spheres, &[]), Ok((0, 0)));
        assert!(judged(&spheres, &[[1, 2]]).is_err());
    }
}
