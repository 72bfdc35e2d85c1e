//! Comparing every engine's pairs with the oracle's, before anything is timed and again at the end.

use miette::Diagnostic;
use sdop::rounding::U;
use thiserror::Error;

use crate::boxes::{Frame, meet};
use crate::entry::{Entry, Work};
use crate::oracle;

/// The pairs that a frame must have.
pub struct ExpectedPairs<'a> {
    frame: &'a Frame,
    number: usize,
    boxes: Vec<[u32; 2]>,
    spheres: Vec<[u32; 2]>,
}

/// The error for an engine whose pairs differ from the expected ones.
#[derive(Debug, Error, Diagnostic)]
#[error("{engine}, frame {frame}: the pair ({i}, {j}) is {fault}", i = pair[0], j = pair[1])]
#[diagnostic(help("the boxes are {boxes}; nothing is timed while answers differ"))]
pub struct Mismatch {
    engine: &'static str,
    frame: usize,
    pair: [u32; 2],
    fault: &'static str,
    boxes: String,
}

impl<'a> ExpectedPairs<'a> {
    /// The truth about a frame.
    pub fn of(frame: &'a Frame, number: usize) -> Self {
        let boxes = oracle::pairs(&frame.boxes);
        // Spheres that touch lie in boxes that do. What f64 can't tell from a contact isn't
        // required.
        let touch = |&pair: &[u32; 2]| relative_gap(frame, pair) <= -1e-14;
        Self { spheres: boxes.iter().copied().filter(touch).collect(), boxes, frame, number }
    }

    /// The number of the frame.
    pub fn number(&self) -> usize {
        self.number
    }

    /// How many pairs of boxes there are.
    pub fn boxes(&self) -> usize {
        self.boxes.len()
    }

    /// Compares an engine's pairs, which may come in any order and either way round. Returns their
    /// number.
    ///
    /// # Errors
    /// The first pair that is missing, wrong or listed twice.
    pub fn judge(&self, entry: &Entry, mut pairs: Vec<[u32; 2]>) -> Result<usize, Mismatch> {
        pairs.iter_mut().for_each(|pair| pair.sort_unstable());
        pairs.sort_unstable();
        let required = match entry.work {
            Work::Boxes => self.boxes.as_slice(),
            Work::Spheres => &self.spheres,
            Work::SDop | Work::Hulls | Work::Meshes => &[],
        };
        let twice = pairs.windows(2).find(|two| two[0] == two[1]);
        let faults = [
            (twice.map(|two| two[0]), "reported twice"),
            (first_outside(required, &pairs), "missing"),
            (self.first_wrong(entry, &pairs), "no pair"),
        ];
        let fault = faults.into_iter().find_map(|(pair, fault)| Some((pair?, fault)));
        match fault {
            None => Ok(pairs.len()),
            Some((pair, fault)) => Err(Mismatch {
                engine: entry.name,
                frame: self.number,
                pair,
                fault,
                boxes: pair
                    .map(|body| format!("{:?}", self.frame.boxes.get(body as usize)))
                    .join(" and "),
            }),
        }
    }

    /// The first pair that doesn't touch.
    fn first_wrong(&self, entry: &Entry, pairs: &[[u32; 2]]) -> Option<[u32; 2]> {
        let bodies = self.frame.boxes.len();
        let touch = |&[i, j]: &[u32; 2]| match entry.work {
            _ if i == j || j as usize >= bodies => false,
            Work::Boxes => {
                let [a, b] = [i, j].map(|body| &self.frame.boxes[body as usize]);
                meet(a, b)
            }
            // What the sphere test's rounding may add: `sdop::rounding::sphere`.
            _ => relative_gap(self.frame, [i, j]) <= 15.0 * U,
        };
        pairs.iter().copied().find(|pair| !touch(pair))
    }
}

/// How far two spheres are apart over the sum of their radii; negative when they overlap.
fn relative_gap(frame: &Frame, pair: [u32; 2]) -> f64 {
    let [a, b] = pair.map(|body| frame.bodies.translation[body as usize].map(f64::from));
    let distance = (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt();
    let [ra, rb] = pair.map(|body| f64::from(frame.radii[body as usize]));
    distance / (ra + rb) - 1.0
}

/// The first of the sorted `pairs` that the sorted `others` lack.
fn first_outside(pairs: &[[u32; 2]], others: &[[u32; 2]]) -> Option<[u32; 2]> {
    let mut others = others.iter().peekable();
    pairs.iter().copied().find(|pair| {
        while others.next_if(|other| *other < pair).is_some() {}
        others.peek() != Some(&pair)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three boxes in a row, the first two touching in a face.
    fn row() -> Frame {
        let mut frame = Frame::default();
        for (body, x) in [0.0, 2.0, 4.5_f32].into_iter().enumerate() {
            frame.bodies.push(0, true, [0.0, 0.0, 0.0, 1.0], [x, 0.0, 0.0]);
            frame.radii.push(1.0);
            frame.boxes.push([[x - 1.0, x + 1.0], [-1.0, 1.0], [-1.0, 1.0]]);
            assert_eq!(frame.bodies.len(), body + 1);
        }
        frame
    }

    fn engine(work: Work) -> Entry {
        Entry {
            name: "engine",
            version: "",
            work,
            threads: 1,
            ages: true,
            new: |_| Err(miette::miette!("never asked for")),
        }
    }

    fn fault(work: Work, pairs: &[[u32; 2]]) -> Option<String> {
        let judged = ExpectedPairs::of(&row(), 7).judge(&engine(work), pairs.to_vec());
        judged.err().map(|mismatch| mismatch.to_string())
    }

    /// Touching boxes are a pair either way round.
    #[test]
    fn touching_boxes_pair_in_either_order() {
        for work in [Work::Boxes, Work::Spheres, Work::SDop] {
            assert_eq!(fault(work, &[[1, 0]]), None);
        }
        assert_eq!(fault(Work::SDop, &[]), None);
    }

    /// A fault names engine frame and pair.
    #[test]
    fn mismatch_names_engine_frame_pair() {
        let expect = |pairs: &[[u32; 2]], end: &str| {
            let text = fault(Work::Boxes, pairs);
            assert_eq!(text, Some(format!("engine, frame 7: the pair {end}")));
        };
        expect(&[], "(0, 1) is missing");
        expect(&[[0, 1], [1, 0]], "(0, 1) is reported twice");
        expect(&[[0, 1], [1, 2]], "(1, 2) is no pair");
        expect(&[[0, 1], [2, 2]], "(2, 2) is no pair");
        expect(&[[0, 1], [1, 9]], "(1, 9) is no pair");
    }
}
