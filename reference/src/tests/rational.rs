//! A second formulation of every decision, in rationals and world coordinates, sharing nothing with the cascade but
//! the input: poses by the quaternion sandwich q x q̄/|q|², and brute force in place of frames, trees and programs.

use dashu_int::{IBig, UBig};
use dashu_ratio::RBig;

use crate::number::dyadic;
use crate::{Ball, Pose};

/// A point or vector.
pub type Rational3 = [RBig; 3];

/// The exact value of a float.
pub fn rational(x: f64) -> RBig {
    let (mantissa, exponent) = dyadic(x);
    let shift = exponent.unsigned_abs() as usize;
    let mantissa = IBig::from(mantissa);
    if exponent < 0 {
        RBig::from_parts(mantissa, UBig::ONE << shift)
    } else {
        RBig::from(mantissa << shift)
    }
}

/// Each component.
pub fn rational3(v: [f32; 3]) -> Rational3 {
    v.map(|x| rational(f64::from(x)))
}

/// Hamilton product of (x, y, z, w) quaternions.
fn hamilton(a: &[RBig; 4], b: &[RBig; 4]) -> [RBig; 4] {
    let [ax, ay, az, aw] = a;
    let [bx, by, bz, bw] = b;
    [
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    ]
}

/// Where the pose puts a point, in world coordinates.
pub fn posed(pose: &Pose, x: &Rational3) -> Rational3 {
    let q = pose.quaternion().map(rational);
    let [qx, qy, qz, qw] = &q;
    let conjugate = [-qx, -qy, -qz, qw.clone()];
    let norm = qx * qx + qy * qy + qz * qz + qw * qw;
    let [x0, x1, x2] = x.clone();
    let turned = hamilton(&hamilton(&q, &[x0, x1, x2, RBig::ZERO]), &conjugate);
    let t = pose.translation().map(rational);
    [0, 1, 2].map(|i| &turned[i] / &norm + &t[i])
}

/// a·b
pub fn dot(a: &Rational3, b: &Rational3) -> RBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// a × b
pub fn cross(a: &Rational3, b: &Rational3) -> Rational3 {
    [
        &a[1] * &b[2] - &a[2] * &b[1],
        &a[2] * &b[0] - &a[0] * &b[2],
        &a[0] * &b[1] - &a[1] * &b[0],
    ]
}

/// a − b
pub fn sub(a: &Rational3, b: &Rational3) -> Rational3 {
    [&a[0] - &b[0], &a[1] - &b[1], &a[2] - &b[2]]
}

/// Whether ‖cB − cA‖ ≤ rA + rB.
pub fn balls_overlap(a: (&Ball, &Pose), b: (&Ball, &Pose)) -> bool {
    let centre = |(ball, pose): (&Ball, &Pose)| posed(pose, &rational3(ball.centre));
    let d = sub(&centre(b), &centre(a));
    let reach = rational(f64::from(a.0.radius)) + rational(f64::from(b.0.radius));
    dot(&d, &d) <= &reach * &reach
}

/// Whether the axis separates the point sets strictly.
pub fn separates(axis: &Rational3, a: &[Rational3], b: &[Rational3]) -> bool {
    let range = |points: &[Rational3]| {
        let heights: Vec<RBig> = points.iter().map(|p| dot(axis, p)).collect();
        Some((heights.iter().min()?.clone(), heights.iter().max()?.clone()))
    };
    match (range(a), range(b)) {
        (Some((lo_a, hi_a)), Some((lo_b, hi_b))) => hi_a < lo_b || hi_b < lo_a,
        _ => true,
    }
}
