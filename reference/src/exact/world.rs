//! World-aligned k-DOPs re-fitted from the vertices, exactly: `aabb` is k = 6.
//!
//! Along an integer direction d, A's highest vertex |qB|² d·R(qA)v is compared with B's lowest
//! |qA|² d·R(qB)v + |qA|²|qB|² d·(tB − tA). In f64 every body is fitted once,
//! about its own origin. Intervals and integers then examine only the vertices that may be the
//! extreme one.

use std::cmp::Ordering;

use dashu_int::IBig;

use super::relative::quaternion;
use super::{Decision, Interval, any, cascade, either};
use crate::linear::{
    Vector, apply, dot, integers, largest, norm_squared, rotation, scale, sub, transpose,
};
use crate::number::{Number, unit_of};
use crate::overlap::world::extents;
use crate::pose::{Pose, separation};
use crate::shape::Body;
use crate::volume::DirectionSet;

/// Relative error of a height: 90u by hand for a rotation (8u an entry), a product and a sum over
/// three axes; 256u.
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
        let ends = extents(body, directions);
        let reach = body.shape.points().map(|p| largest(&p)).fold(0.0, f64::max);
        let directions = directions.coefficients();
        Self { body: *body, directions, ends, error: HEIGHT_ERROR * reach }
    }

    /// The vertices that may be the highest (`end` = 1) or lowest (0) along a direction.
    fn candidates(&self, n: usize, end: usize) -> Vec<Vector<f64>> {
        let direction =
            apply(&transpose(&self.body.pose.rotation()), &integers(self.directions[n]));
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
    let closed = |n: usize| gaps[n] < -bound;
    let open = || (0..gaps.len()).filter(|n| !closed(*n));
    let filter = || {
        let apart = gaps.iter().any(|gap| *gap > bound);
        if apart { Some(true) } else { open().next().is_none().then_some(false) }
    };
    cascade(
        filter,
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
    any(open.map(|n| separates::<N>(a, b, n)))
}

/// Whether direction n has A wholly below B or B wholly below A.
fn separates<N: Number>(a: &Extents, b: &Extents, n: usize) -> Option<bool> {
    let candidates = [a, b].map(|extents| [extents.candidates(n, 0), extents.candidates(n, 1)]);
    let poses = [&a.body.pose, &b.body.pose];
    let lengths = candidates.iter().flatten().flatten().flatten().copied();
    let unit = unit_of(lengths.chain(poses.into_iter().flat_map(Pose::translation)));
    let direction = integers::<N>(a.directions[n]);
    let [qa, qb] = poses.map(quaternion::<N>);
    let [ta, tb] = poses.map(|pose| pose.translation().map(|x| N::lift(x, unit)));
    let (norm_a, norm_b) = (norm_squared(&qa), norm_squared(&qb));
    let shift = norm_a.times(&norm_b).times(&dot(&direction, &sub(&tb, &ta)));
    let along = |q, norm| scale(norm, &apply(&transpose(&rotation(q)), &direction));
    let fit_a = fit(&along(&qa, &norm_b), &candidates[0], unit);
    let fit_b = fit(&along(&qb, &norm_a), &candidates[1], unit);
    let (Some([low_a, high_a]), Some([low_b, high_b])) = (fit_a, fit_b) else {
        // A body without vertices.
        return Some(true);
    };
    let positive = |gap: N| gap.sign().map(|sign| sign == Ordering::Greater);
    let beyond = positive(low_b.plus(&shift).minus(&high_a));
    either(beyond, || positive(low_a.minus(&high_b.plus(&shift))))
}

/// The lowest of the first points and the highest of the second along a vector.
fn fit<N: Number>(
    along: &Vector<N>,
    [low, high]: &[Vec<Vector<f64>>; 2],
    unit: i32,
) -> Option<[N; 2]> {
    let height = |p: &Vector<f64>| dot(along, &p.map(|x| N::lift(x, unit)));
    let lowest = low.iter().map(height).reduce(|x, y| x.smaller(&y));
    let highest = high.iter().map(height).reduce(|x, y| x.larger(&y));
    Some([lowest?, highest?])
}
