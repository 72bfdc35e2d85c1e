//! Boxes with the additional input of a claim: filters, margins, states that are saved and
//! restored, orders of insertion.

use rand::{Rng, RngExt};

use super::boxes::{self, BoxKind, of_boxes};
use super::{CatalogueError, DrawnCase};
use crate::case::Frame;
use crate::contestant::{Filter, WorldBox};
use crate::truth::boxes_meet;

/// The additional input of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClaimInputKind {
    /// Groups and masks filter pairs; in some pairs, only one of the two bodies excludes the other.
    Groups,
    /// A list of pairs is excluded.
    Excluded,
    /// Filters change while nothing moves.
    AtRest,
    /// One margin for all.
    Margin,
    /// A margin for each body.
    Margins,
    /// The state is saved, restored, and restored again.
    Restored,
    /// The bodies are inserted in different orders.
    Insertion,
}

const COUNT: usize = 48;

/// A case of boxes with this input.
pub fn with_input(
    kind: ClaimInputKind,
    number: u32,
    rng: &mut impl Rng,
) -> Result<DrawnCase, CatalogueError> {
    match kind {
        ClaimInputKind::Margin | ClaimInputKind::Margins => margins(kind, rng),
        ClaimInputKind::Restored => restored(rng),
        ClaimInputKind::Insertion => {
            let of = [BoxKind::Grid, BoxKind::Ulp, BoxKind::Flat][number as usize % 3];
            boxes::boxes(of, COUNT, rng)
        }
        ClaimInputKind::Groups | ClaimInputKind::Excluded | ClaimInputKind::AtRest => {
            let DrawnCase { shapes, frames } = boxes::boxes(BoxKind::Grid, COUNT, rng)?;
            let (first, count) = (&frames[0], if kind == ClaimInputKind::AtRest { 5 } else { 1 });
            let frame = |n: usize| Frame {
                filter: Some(match (kind, n) {
                    (ClaimInputKind::Groups, _) | (ClaimInputKind::AtRest, 0 | 1 | 4) => {
                        groups(COUNT, rng)
                    }
                    (ClaimInputKind::AtRest, 3) => admits(Vec::new()),
                    _ => admits(excluded(first, rng)),
                }),
                ..first.clone()
            };
            let frames = (0..count).map(frame).collect();
            Ok(DrawnCase { shapes, frames })
        }
    }
}

/// Each body is in one of eight groups, including that of the highest bit, and has a mask of any of
/// them.
pub(super) fn groups(count: usize, rng: &mut impl Rng) -> Filter {
    let bit = |rng: &mut _| 1_u32 << [0, 1, 2, 3, 7, 15, 30, 31][RngExt::random_range(rng, 0..8)];
    let group = |_| {
        let own = bit(rng);
        let mask = match rng.random_range(0..6) {
            0 => 0,
            1 => u32::MAX,
            2 => !bit(rng),
            _ => (0..4).fold(0, |mask, _| mask | bit(rng)),
        };
        [own, mask]
    };
    Filter { groups: (0..count).map(group).collect(), excluded: Vec::new() }
}

fn admits(excluded: Vec<[u32; 2]>) -> Filter {
    Filter { groups: vec![[1, u32::MAX]; COUNT], excluded }
}

/// A third of the pairs that meet, and a few of the others, sorted.
fn excluded(frame: &Frame, rng: &mut impl Rng) -> Vec<[u32; 2]> {
    let mut pairs = Vec::new();
    for (i, a) in frame.boxes.iter().enumerate() {
        for (j, b) in frame.boxes.iter().enumerate().skip(i + 1) {
            if rng.random_range(0..if boxes_meet(a, b) { 3 } else { 40 }) == 0 {
                pairs.push([i as u32, j as u32]);
            }
        }
    }
    pairs
}

/// Rows of two boxes, as far apart along an axis as their margins reach, or an ulp more or less.
fn margins(kind: ClaimInputKind, rng: &mut impl Rng) -> Result<DrawnCase, CatalogueError> {
    const MARGINS: [f32; 6] = [0.0, 1e-3, 0.1, 0.25, 0.7, 3.0];
    let pick = |rng: &mut _| MARGINS[RngExt::random_range(rng, 0..MARGINS.len())];
    let all = MARGINS[rng.random_range(1..MARGINS.len())];
    let (mut boxes, mut margins): (Vec<WorldBox>, Vec<f32>) = (Vec::new(), Vec::new());
    for row in 0..COUNT / 2 {
        let own = match kind {
            ClaimInputKind::Margin => [all; 2],
            _ => [pick(rng), pick(rng)],
        };
        let axis = rng.random_range(0..3);
        let mut first: WorldBox = [0.0; 6];
        for at in 0..3 {
            first[at] = rng.random_range(-2.0..2.0_f32);
            first[at + 3] = first[at] + rng.random_range(0.1..1.0_f32);
        }
        let away = (axis + 1) % 3;
        first[away] += 32.0 * row as f32; // few rows
        first[away + 3] += 32.0 * row as f32;
        let mut second = first;
        let near = (f64::from(first[axis + 3]) + f64::from(own[0]) + f64::from(own[1])) as f32;
        second[axis] = [near, near.next_up(), near.next_down()][rng.random_range(0..3)];
        second[axis + 3] = second[axis] + rng.random_range(0.1..1.0_f32);
        boxes.extend([first, second]);
        margins.extend(own);
    }
    let dynamic = (0..COUNT).map(|i| i % 5 != 4).collect();
    let (shape, frame) = of_boxes(boxes, dynamic)?;
    let frames = vec![Frame { margins: Some(margins), ..frame }];
    Ok(DrawnCase { shapes: vec![shape], frames })
}

/// Steps 0 and 1, after which the state is saved; 2 to 4; back, and the same steps again; back, and
/// the last step alone. Half of the boxes move in each step.
fn restored(rng: &mut impl Rng) -> Result<DrawnCase, CatalogueError> {
    let DrawnCase { shapes, frames } = boxes::boxes(BoxKind::Grid, COUNT, rng)?;
    let mut steps = frames;
    for n in 1..5 {
        let mut next = steps[n - 1].clone();
        for body in 0..COUNT {
            if next.bodies.dynamic[body] && rng.random_range(0..2) == 0 {
                let by: [f32; 3] = std::array::from_fn(|_| rng.random_range(-4..=4) as f32);
                for (axis, by) in by.into_iter().enumerate() {
                    next.boxes[body][axis] += by;
                    next.boxes[body][axis + 3] += by;
                    next.bodies.translation[body][axis] += by;
                }
            }
        }
        steps.push(next);
    }
    let frame =
        |(n, save, restore): (usize, bool, bool)| Frame { save, restore, ..steps[n].clone() };
    let run = [
        (0, false, false),
        (1, true, false),
        (2, false, false),
        (3, false, false),
        (4, false, false),
        (2, false, true),
        (3, false, false),
        (4, false, false),
        (4, false, true),
    ];
    Ok(DrawnCase { shapes, frames: run.map(frame).to_vec() })
}
