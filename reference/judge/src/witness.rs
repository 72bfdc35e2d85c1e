//! Evidence for a person that a pair really meets: a common point as exact fractions, and how deep
//! the bodies are in one another.

use serde::Serialize;

use super::case::{Case, Frame};
use super::score::Miss;
use super::truth::Truth;

/// A certificate.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Witness {
    /// The coordinates of a point that both bodies share, as fractions in lowest terms.
    pub point: [String; 3],
    /// The same, rounded to f64.
    pub decimals: [f64; 3],
    /// The least shift of the second body, of those tried, that parts the two, in the scene's unit
    /// of length.
    pub depth: Option<f64>,
    /// The same in units of `ulp`.
    pub depth_ulps: Option<u64>,
    /// The spacing of f32 numbers at the pair's largest coordinate.
    pub ulp: f64,
}

/// The largest shift tried: beyond it, the bodies are anything but close to being apart.
pub(super) const DEEPEST: u64 = 1 << 24;

impl Witness {
    /// The certificate for a pair of which the case's claim holds; `None` for any other.
    #[must_use]
    pub fn of(case: &Case, Miss { frame, pair }: Miss) -> Option<Self> {
        let truth = Truth::new(case.claim, &case.shapes).ok()?;
        let frame = &case.frames[frame];
        let point = truth.common_point(frame, pair)?;
        let ends = pair.map(|body| frame.boxes[body as usize]);
        let size = ends.as_flattened().iter().fold(0.0, |m: f32, x| m.max(x.abs()));
        let ulp = f64::from(size.next_up()) - f64::from(size);
        let directions = directions(frame, pair);
        let depth = directions.iter().fold(None, |least, direction| {
            depth(&truth, frame, pair, direction, ulp, least).or(least)
        });
        Some(Self {
            point: point.fractions(),
            decimals: point.decimals(),
            depth: depth.map(|ulps| ulps as f64 * ulp),
            depth_ulps: depth,
            ulp,
        })
    }
}

/// Along the axes, along the cube's diagonals, and away from the first body.
fn directions(frame: &Frame, [i, j]: [u32; 2]) -> Vec<[f64; 3]> {
    let mut all = Vec::new();
    for n in 0..27 {
        let d = [n % 3, n / 3 % 3, n / 9].map(|c| f64::from(c) - 1.0);
        if d.iter().filter(|c| **c != 0.0).count() % 2 == 1 {
            all.push(d);
        }
    }
    let (a, b) = (frame.boxes[i as usize], frame.boxes[j as usize]);
    let away = [0, 1, 2].map(|axis| {
        f64::from(b[axis]) + f64::from(b[axis + 3]) - f64::from(a[axis]) - f64::from(a[axis + 3])
    });
    let size = away.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    if size > 0.0 {
        all.push(away.map(|x| x / size));
    }
    all
}

/// The least number of ulps below `least` by which a shift along a direction parts the pair:
/// doubled until it does, then halved down to it.
fn depth(
    truth: &Truth,
    frame: &Frame,
    pair: [u32; 2],
    direction: &[f64; 3],
    ulp: f64,
    least: Option<u64>,
) -> Option<u64> {
    let most = least.unwrap_or(DEEPEST);
    let parted = |ulps: u64| {
        truth.pair(&shifted(frame, pair[1], direction, ulps as f64 * ulp), pair) == Ok(false)
    };
    let mut high = 1;
    while !parted(high) {
        high *= 2;
        if high >= most {
            return None;
        }
    }
    let mut low = high / 2;
    while high - low > 1 {
        let middle = (low + high) / 2;
        if parted(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    Some(high)
}

fn shifted(frame: &Frame, body: u32, direction: &[f64; 3], by: f64) -> Frame {
    let mut shifted = frame.clone();
    let body = body as usize;
    for (axis, along) in direction.iter().enumerate() {
        let shift = |x: &mut f32| *x = (f64::from(*x) + along * by) as f32;
        shift(&mut shifted.bodies.translation[body][axis]);
        shift(&mut shifted.boxes[body][axis]);
        shift(&mut shifted.boxes[body][axis + 3]);
    }
    shifted
}
