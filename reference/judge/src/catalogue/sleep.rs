//! Bodies that fall asleep and wake while they touch others to the bit.
//!
//! Cubes are in pairs whose faces touch exactly, since all coordinates are short binary numbers.
//! Most never move. In each frame a few move once and then sleep again: to a touch or along one, or
//! an ulp apart. So a culler that keeps the verdicts of sleeping bodies has some to keep, and must
//! test again those of the one body of a pair that has moved.

use rand::{Rng, RngExt};

use super::exact_touches::solids;
use super::{CatalogueError, DrawnCase};
use crate::case::Frame;
use crate::contestant::WorldBox;
use sdop::bodies::Bodies;
use sdop::rounding::{ceil_f32, floor_f32};

/// Pairs that move, and pairs that don't: in a frame fewer than one in sixteen bodies moves.
const MOVING: usize = 16;
const SLEEPING: usize = 48;
const FRAMES: usize = 11;
/// In how many different frames pairs begin to move.
const PHASES: usize = 6;
/// Frames from the move of a pair's second body to that of its first.
const SLEEP: usize = 3;
/// Half sizes from the centre of a cube to that of one that touches it.
const REACH: f32 = 2.0;
/// Half sizes by which a cube slides along another one.
const SLIDE: f32 = 0.5;
/// Half sizes between pairs.
const SPACING: f32 = 16.0;

const UNTURNED: [f32; 4] = [0.0, 0.0, 0.0, 1.0];

/// A case of pairs that touch along the axis of this number, modulo 3.
pub fn touching(number: u32, rng: &mut impl Rng) -> Result<DrawnCase, CatalogueError> {
    let size = 2_f32.powi(rng.random_range(-6..=6));
    let shapes = solids(size)?.to_vec();
    let axis = number as usize % 3;
    // The centre's ulps along the axis are not those of zero.
    let at: [f32; 3] = std::array::from_fn(|_| rng.random_range(8..=64) as f32);
    let frame = |n: usize| {
        let mut bodies = Bodies::default();
        for pair in 0..MOVING + SLEEPING {
            for cube in cubes(pair, n, at, axis) {
                bodies.push(0, true, UNTURNED, cube.scaled(size));
            }
        }
        let boxes = bodies.translation.iter().map(|&t| about(t, size));
        Frame { boxes: boxes.collect(), ..Frame::fitted(bodies, &shapes) }
    };
    let frames = (0..FRAMES).map(frame).collect();
    Ok(DrawnCase { shapes, frames })
}

/// The box of a cube at a place: its own ends, so that boxes touch to the bit where cubes do.
/// [`Frame::fitted`] would leave room for a rotation's rounding.
fn about(t: [f32; 3], size: f32) -> WorldBox {
    let [x, y, z] = t.map(f64::from);
    let size = f64::from(size);
    let [x0, y0, z0] = [x, y, z].map(|x| floor_f32(x - size));
    let [x1, y1, z1] = [x, y, z].map(|x| ceil_f32(x + size));
    [x0, y0, z0, x1, y1, z1]
}

/// Where a cube is.
struct Cube {
    /// In half sizes.
    centre: [f32; 3],
    /// The axis along which it is an ulp further out, and whether that is upwards.
    away: Option<(usize, bool)>,
}

impl Cube {
    fn scaled(&self, size: f32) -> [f32; 3] {
        let mut t = self.centre.map(|x| x * size);
        if let Some((axis, is_up)) = self.away {
            t[axis] = if is_up { t[axis].next_up() } else { t[axis].next_down() };
        }
        t
    }
}

/// The two cubes of a pair in a frame. Of an even pair, the second one comes to touch the first in
/// one frame, and the first one slides along it some frames later. Of an odd one, the second
/// slides, and the first goes an ulp away later.
fn cubes(pair: usize, n: usize, mut at: [f32; 3], axis: usize) -> [Cube; 2] {
    at[(axis + 1) % 3] += SPACING * pair as f32; // few pairs
    let side = if (pair / 2).is_multiple_of(2) { 1.0 } else { -1.0 };
    let mut other = at;
    other[axis] += side * REACH;
    let moves = pair < MOVING;
    let begin = 1 + pair % PHASES;
    let (has_second_moved, has_first_moved) = (moves && n >= begin, moves && n >= begin + SLEEP);
    let across = (axis + 2) % 3;
    let (mut first, mut second) = (None, None);
    if pair.is_multiple_of(2) {
        second = (moves && !has_second_moved).then_some((axis, side > 0.0));
        at[across] += if has_first_moved { SLIDE } else { 0.0 };
    } else {
        other[across] += if has_second_moved { SLIDE } else { 0.0 };
        first = has_first_moved.then_some((axis, side < 0.0));
    }
    let cube = |centre, away| Cube { centre, away };
    [cube(at, first), cube(other, second)]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    use super::*;

    /// In each frame but the first and the last some bodies move, one of a pair and fewer than one
    /// in sixteen.
    #[test]
    fn few_bodies_move_per_frame() {
        for number in 0..3 {
            let case = touching(number, &mut ChaCha8Rng::seed_from_u64(1)).unwrap();
            let moved = case.frames.windows(2).map(|frames| {
                let [before, now] = [0, 1].map(|at| &frames[at].bodies.translation);
                let moved = |&body: &usize| before[body] != now[body];
                let moved: Vec<usize> = (0..now.len()).filter(moved).collect();
                assert!(16 * moved.len() <= now.len());
                assert!(moved.windows(2).all(|two| two[0] / 2 != two[1] / 2));
                moved.len()
            });
            let moved: Vec<usize> = moved.collect();
            assert_eq!(moved.iter().sum::<usize>(), 2 * MOVING);
            assert!(moved[..PHASES + SLEEP - 1].iter().all(|&count| count > 0));
        }
    }
}
