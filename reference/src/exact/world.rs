//! World-aligned k-DOPs re-fitted from the vertices, exactly: `aabb` is k = 6.
//!
//! Along an integer direction d, A's highest vertex |qB|² d·R(qA)v is compared with B's lowest
//! |qA|² d·R(qB)v + |qA|²|qB|² d·(tB − tA). In f64 every body is fitted once, about its own origin; only vertices that
//! may be the extreme one are looked at again in intervals and integers.

use std::cmp::Ordering;

use dashu_int::IBig;

use super::relative::{largest, quaternion};
use super::{Decision, Interval, cascade};
use crate::linear::{Vector, apply, dot, integers, norm_squared, rotation, sub};
use crate::number::{Number, unit_of};
use crate::pose::{Body, Pose, separation};
use crate::volume::DirectionSet;

/// Relative error of a height: 90u by hand for a rotation (8u an entry), a product and a sum over three axes; 256u.
const HEIGHT_ERROR: f64 = 128.0 * f64::EPSILON;

/// A body's extents along each direction about its own origin, in f64.
#[derive(Clone, Debug)]
pub struct Extents<'a> {
    body: Body<'a>,
    directions: Vec<[i32; 3]>,
    ends: Vec<[f64; 2]>,
    error: f64,
}

impl<'a> Extents<'a> {
    /// Fits the posed vertices.
    pub fn new(body: &Body<'a>, directions: DirectionSet) -> Self {
        let ends = crate::overlap::world::extents(body, directions);
        let reach = body.shape.points().map(|p| largest(&p)).fold(0.0, f64::max);
        let directions = directions.coefficients();
        Self {
            body: *body,
            directions,
            ends,
            error: HEIGHT_ERROR * reach,
        }
    }

    /// The vertices that may be the highest (`end` = 1) or lowest (0) along a direction.
    fn candidates(&self, n: usize, end: usize) -> Vec<Vector<f64>> {
        let direction = apply(
            &crate::linear::transpose(&self.body.pose.rotation()),
            &integers(self.directions[n]),
        );
        let near =
            |p: &Vector<f64>| (dot(&direction, p) - self.ends[n][end]).abs() <= 4.0 * self.error;
        self.body.shape.points().filter(near).collect()
    }
}

/// Whether the re-fitted k-DOPs of two bodies overlap.
pub fn overlap(a: &Body, b: &Body, directions: DirectionSet) -> Decision<bool> {
    overlap_extents(&Extents::new(a, directions), &Extents::new(b, directions))
}

/// [`overlap`] of bodies already fitted along the same directions.
pub fn overlap_extents(a: &Extents, b: &Extents) -> Decision<bool> {
    let delta = separation(&a.body.pose, &b.body.pose);
    let bound = a.error + b.error + HEIGHT_ERROR * largest(&delta);
    let gap = |n: usize| {
        let shift = dot(&integers(a.directions[n]), &delta);
        let ([lo_a, hi_a], [lo_b, hi_b]) = (a.ends[n], b.ends[n]);
        (lo_b + shift - hi_a).max(lo_a - hi_b - shift)
    };
    let gaps: Vec<f64> = (0..a.directions.len()).map(gap).collect();
    let open = || (0..gaps.len()).filter(|n| gaps[*n] >= -bound);
    cascade(
        || {
            if gaps.iter().any(|gap| *gap > bound) {
                Some(true)
            } else {
                open().next().is_none().then_some(false)
            }
        },
        || any_separates::<Interval>(a, b, open()),
        || any_separates::<IBig>(a, b, open()),
    )
    .map(|separated| !separated)
}

fn any_separates<N: Number>(
    a: &Extents,
    b: &Extents,
    open: impl Iterator<Item = usize>,
) -> Option<bool> {
    let mut found = Some(false);
    for n in open {
        match separates::<N>(a, b, n) {
            Some(true) => return Some(true),
            Some(false) => {}
            None => found = None,
        }
    }
    found
}

/// Whether direction n has A wholly below B or B wholly below A.
fn separates<N: Number>(a: &Extents, b: &Extents, n: usize) -> Option<bool> {
    let candidates = [a, b].map(|e| [e.candidates(n, 0), e.candidates(n, 1)]);
    let lengths = candidates.iter().flatten().flatten().flatten().copied();
    let (pose_a, pose_b) = (&a.body.pose, &b.body.pose);
    let unit = unit_of(
        lengths
            .chain(pose_a.translation())
            .chain(pose_b.translation()),
    );
    let direction = integers::<N>(a.directions[n]);
    let norms = [pose_a, pose_b].map(|pose| norm_squared(&quaternion::<N>(pose)));
    let [ta, tb] = [pose_a, pose_b].map(|pose| pose.translation().map(|x| N::lift(x, unit)));
    let shift = norms[0]
        .times(&norms[1])
        .times(&dot(&direction, &sub(&tb, &ta)));
    let end = |pose: &Pose, points: &[Vector<f64>], other: &N, higher: fn(&N, &N) -> N| {
        let along = apply(
            &crate::linear::transpose(&rotation(&quaternion::<N>(pose))),
            &direction,
        );
        let heights = points
            .iter()
            .map(|p| other.times(&dot(&along, &p.map(|x| N::lift(x, unit)))));
        heights.reduce(|x, y| higher(&x, &y))
    };
    let [[low_a, high_a], [low_b, high_b]] = &candidates;
    let gap = |low: Option<N>, shift: &N, high: Option<N>| {
        Some(low?.plus(shift).minus(&high?).sign()? == Ordering::Greater)
    };
    let above = gap(
        end(pose_b, low_b, &norms[0], N::smaller),
        &shift,
        end(pose_a, high_a, &norms[1], N::larger),
    );
    let back = N::integer(0).minus(&shift);
    let below = gap(
        end(pose_a, low_a, &norms[1], N::smaller),
        &back,
        end(pose_b, high_b, &norms[0], N::larger),
    );
    match (above, below) {
        (Some(true), _) | (_, Some(true)) => Some(true),
        (Some(false), Some(false)) => Some(false),
        _ => None,
    }
}
