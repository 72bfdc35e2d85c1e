//! Sphere against sphere, exactly: ‖M cB + w − s cA‖² ≤ s²(rA + rB)² ([`Relative`]).

use std::cmp::Ordering;

use dashu_int::IBig;

use super::relative::{Approximate, Relative};
use super::{Decision, Interval, cascade};
use crate::linear::{Vector, dot, largest, sub};
use crate::number::{Number, unit_of};
use crate::pose::Pose;
use crate::shape::Body;
use crate::volume::Ball;

/// Whether the posed bounding spheres overlap.
pub fn overlap(a: &Body, b: &Body) -> Decision<bool> {
    overlap_balls((&a.shape.ball, &a.pose), (&b.shape.ball, &b.pose))
}

/// Whether two posed balls overlap.
pub fn overlap_balls(a: (&Ball, &Pose), b: (&Ball, &Pose)) -> Decision<bool> {
    cascade(
        || filter(a, b),
        || judge::<Interval>(a, b, 0),
        || judge::<IBig>(a, b, common_unit(a, b)),
    )
}

/// The largest unit of length such that all lengths of both are multiples of it.
pub(crate) fn common_unit(a: (&Ball, &Pose), b: (&Ball, &Pose)) -> i32 {
    let unit = |(ball, pose): (&Ball, &Pose)| {
        let lengths = ball.centre.map(f64::from).into_iter().chain(pose.translation());
        unit_of(lengths.chain([f64::from(ball.radius)]))
    };
    unit(a).min(unit(b))
}

pub(crate) fn judge<N: Number>(a: (&Ball, &Pose), b: (&Ball, &Pose), unit: i32) -> Option<bool> {
    let relative = Relative::<N>::between(a.1, b.1, unit);
    let lift = |x: f32| N::lift(f64::from(x), unit);
    let [centre_a, centre_b] = [a.0.centre, b.0.centre].map(|c| c.map(f64::from));
    let d = sub(&relative.seen(&centre_b, unit), &relative.own(&centre_a, unit));
    let reach = relative.scale.times(&lift(a.0.radius).plus(&lift(b.0.radius)));
    Some(reach.times(&reach).minus(&dot(&d, &d)).sign()? != Ordering::Less)
}

pub(crate) fn filter(a: (&Ball, &Pose), b: (&Ball, &Pose)) -> Option<bool> {
    let relative = Approximate::between(a.1, b.1);
    let (centre_a, centre_b) = (a.0.centre.map(f64::from), b.0.centre.map(f64::from));
    let d = sub(&relative.map(&centre_b), &centre_a);
    compare(&d, relative.error(largest(&centre_b)), f64::from(a.0.radius) + f64::from(b.0.radius))
}

/// ‖d‖ ≤ reach? in f64. d̂² − r̂² is off by less than 6δ|d|∞ + 3δ² from the coordinates and 4u(d² +
/// r²) from its own operations, where δ bounds the error of d before the last subtraction and that
/// subtraction's, and the reach is the rounded sum or difference of two f32.
pub(crate) fn compare(d: &Vector<f64>, error: f64, reach: f64) -> Option<bool> {
    let (distance, reach) = (dot(d, d), reach * reach);
    let error = error + f64::EPSILON * largest(d);
    let bound = 8.0 * error * (largest(d) + error) + 4.0 * f64::EPSILON * (distance + reach);
    match reach - distance {
        gap if gap > bound => Some(true),
        gap if gap < -bound => Some(false),
        _ => None,
    }
}
