//! Bodies that approach slowly. A culler may keep its list of candidates until a body has moved
//! far; if it measures that distance wrongly, it keeps the list too long and misses a pair.

use rand::{Rng, RngExt};

use super::DrawnCase;
use crate::case::Frame;
use crate::draw::forms::{self, Form, FormError};
use sdop::bodies::Bodies;
use sdop::volume::{Axes, DirectionSet};

/// How the bodies of a pair move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ApproachKind {
    /// Two bodies approach each other, each by half of the distance.
    Both,
    /// One approaches, the other rests.
    One,
    /// One moves away first, then approaches.
    Return,
}

const PAIRS: usize = 12;
const FRAMES: usize = 33;

/// Pairs of cubes, each with its own speed and gap. Speeds are from a 64th of the radius per frame,
/// which no list notices from one frame to the next, to a quarter.
pub fn approach(
    kind: ApproachKind,
    number: u32,
    rng: &mut impl Rng,
) -> Result<DrawnCase, FormError> {
    let form = Form::of("box", [0.0, 0.0]);
    let shapes = forms::build(&[form], 1, DirectionSet::K18, Axes::Model, rng)?.built;
    let axis = number as usize % 3;
    let half = 1.0 / 3.0_f32.sqrt();
    let pairs: Vec<[f32; 2]> = (0..PAIRS)
        .map(|pair| {
            let step = 2.0_f32.powi(-2 - (pair % 5) as i32);
            // They meet at some time in the last three quarters.
            [step, step * rng.random_range(8.0..30.0)]
        })
        .collect();
    let frame = |n: usize| {
        let mut bodies = Bodies::default();
        for (row, &[step, gap]) in pairs.iter().enumerate() {
            let way = step * n as f32; // few frames
            let turning = step * (FRAMES / 4) as f32;
            let [first, second] = match kind {
                ApproachKind::Both => [way / 2.0, way / 2.0],
                ApproachKind::One => [0.0, way],
                ApproachKind::Return if way <= turning => [0.0, -way],
                ApproachKind::Return => [0.0, 2.0 * (way - turning) - turning],
            };
            // A static body doesn't come: the other goes the whole way.
            let is_static = kind != ApproachKind::Both && row % 3 == 0;
            let [first, second] = if is_static { [first + second, 0.0] } else { [first, second] };
            let side = if row % 2 == 0 { 1.0 } else { -1.0 };
            for (dynamic, along) in [(true, first), (!is_static, 2.0 * half + gap - second)] {
                let mut t = [0.0; 3];
                t[axis] = side * along;
                t[(axis + 1) % 3] = 64.0 * row as f32; // few rows
                bodies.push(0, dynamic, [0.0, 0.0, 0.0, 1.0], t);
            }
        }
        Frame::fitted(bodies, &shapes)
    };
    let frames = (0..FRAMES).map(frame).collect();
    Ok(DrawnCase { shapes, frames })
}
