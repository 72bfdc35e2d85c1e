//! Queries: tests of volumes and lines against bodies, in f64, rounded so that every body is found
//! that shares a point with them in exact arithmetic.
//!
//! A query has f64 coordinates in the world frame. Against a box only a difference, a square and a
//! quotient are rounded, and each is widened by more than its rounding error ([`crossing`],
//! [`is_beyond`]). Against a posed body everything is transformed into the body's frame
//! ([`into_body`]), where its slabs are exact f32, and each slab is moved out by the [`slack`] of
//! the sizes involved. Theorem Q of `paper/proofs/LEMMAS.md` counts the errors in units of 2⁻⁵³ of
//! these sizes; the slack is 256 of them, of which 228 are needed.

use super::exp2;
use super::pose::Rotation;

/// 2⁻⁴⁸ = 32·2⁻⁵³: error of one coordinate of [`into_body`], as a multiple of |p − t|∞. Proof:
/// `query_point.g`.
pub const BODY_ERROR: f64 = exp2(-48);

/// 2⁻⁴⁵ = 256·2⁻⁵³: by how much a slab is moved out to compensate for rounding, as a multiple of
/// the distance of the query plus the sizes of both, per length of the slab's normal.
pub const QUERY_ERROR: f64 = exp2(-45);

/// 2⁻¹⁰⁰⁰: the same for products that underflow.
pub const QUERY_FLOOR: f64 = exp2(-1000);

/// 2⁻⁵⁰ = 8·2⁻⁵³: by how much parameters and squares are widened; a parameter has five roundings, a
/// sum of three squares has six. Proof: `query_line.g`.
pub const WIDENING: f64 = exp2(-50);

/// 2⁻⁸⁰⁰: a line that is slower than this along an axis doesn't move along it.
pub const STILL: f64 = exp2(-800);

/// 2⁻⁶⁰⁰: more than such a line moves along that axis near any body. Their coordinates are below
/// 2¹²⁹, and a ray is no slower than 2⁻⁶⁰ along some axis.
pub const STILL_FLOOR: f64 = exp2(-600);

/// 2¹⁰⁰⁰: beyond the parameters of all points near any body.
pub const ALL: f64 = exp2(1000);

/// The distance by which slabs are moved out if sizes sum to `size`, per length of their normals.
#[inline(always)]
#[must_use]
pub const fn slack(size: f64) -> f64 {
    size * QUERY_ERROR + QUERY_FLOOR
}

/// Rᵀ(p − t): a point of the world frame in a body's frame. Also returns |p − t|∞; the error of a
/// coordinate is [`BODY_ERROR`] times that.
#[inline(always)]
#[must_use]
pub fn into_body(r: &Rotation, p: [f64; 3], t: [f64; 3]) -> ([f64; 3], f64) {
    let w = [p[0] - t[0], p[1] - t[1], p[2] - t[2]];
    (turn_back(r, w), largest(w))
}

/// Rᵀw.
#[inline(always)]
#[must_use]
pub fn turn_back(r: &Rotation, [x, y, z]: [f64; 3]) -> [f64; 3] {
    [
        r[0][0] * x + r[1][0] * y + r[2][0] * z,
        r[0][1] * x + r[1][1] * y + r[2][1] * z,
        r[0][2] * x + r[1][2] * y + r[2][2] * z,
    ]
}

/// The largest absolute value of the coordinates.
#[inline(always)]
#[must_use]
pub fn largest(v: [f64; 3]) -> f64 {
    v.iter().fold(0.0, |most: f64, x| most.max(x.abs()))
}

/// The motion of a line along one direction: at + s·speed.
#[derive(Clone, Copy, Debug)]
pub struct Course {
    /// The position at s = 0.
    pub at: f64,
    /// One over its speed, or 0 if it is slower than [`STILL`].
    pub inverse: f64,
}

impl Course {
    /// The motion of a line with this speed.
    #[inline(always)]
    #[must_use]
    pub fn new(at: f64, speed: f64) -> Self {
        let inverse = if speed.abs() < STILL { 0.0 } else { 1.0 / speed };
        Self { at, inverse }
    }
}

impl Course {
    /// Whether the position falls as s grows.
    #[inline(always)]
    #[must_use]
    pub fn is_falling(self) -> bool {
        self.inverse < 0.0
    }

    /// The parameters s at which a line is at two ends, the first of which it reaches first, in
    /// f64: off by up to [`WIDENING`] of themselves. A line that doesn't move is between the ends
    /// for all s or for none.
    #[inline(always)]
    #[must_use]
    pub fn between(self, [near, far]: [f64; 2]) -> [f64; 2] {
        let Self { at, inverse } = self;
        if inverse == 0.0 {
            let is_between = near - STILL_FLOOR <= at && at <= far + STILL_FLOOR;
            return if is_between { [-ALL, ALL] } else { [ALL, -ALL] };
        }
        [(near - at) * inverse, (far - at) * inverse]
    }
}

/// The parameters s, from the first to the last, for which a line is between two ends, including
/// all exact ones. If there are none, the first is above the last.
#[inline(always)]
#[must_use]
pub fn crossing(course: Course, [lo, hi]: [f64; 2]) -> [f64; 2] {
    let [near, far] = if course.is_falling() { [hi, lo] } else { [lo, hi] };
    let [first, last] = course.between([near, far]);
    [earlier(first), later(last)]
}

/// A parameter that is certainly not later than the exact one.
#[inline(always)]
#[must_use]
pub fn earlier(s: f64) -> f64 {
    s - (s.abs() * WIDENING + QUERY_FLOOR)
}

/// A parameter that is certainly not earlier than the exact one.
#[inline(always)]
#[must_use]
pub fn later(s: f64) -> f64 {
    s + (s.abs() * WIDENING + QUERY_FLOOR)
}

/// Whether a point is farther than `radius` from a box. True only if it is certain.
#[inline(always)]
#[must_use]
pub fn is_beyond(p: [f64; 3], radius: f64, lo: [f64; 3], hi: [f64; 3]) -> bool {
    let outside = |axis: usize| {
        let (below, above) = (lo[axis] - p[axis], p[axis] - hi[axis]);
        let outside = if below > above { below } else { above };
        if outside > 0.0 { outside } else { 0.0 }
    };
    let [x, y, z] = [outside(0), outside(1), outside(2)];
    let within = radius * radius;
    (x * x + y * y) + z * z > within + (within * WIDENING + QUERY_FLOOR)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rounding::pose::rotation;

    /// A point beyond by less than f64 can show is not reported as beyond; one a little farther
    /// away is.
    #[test]
    fn point_at_radius_is_inside() {
        let (lo, hi) = ([0.0; 3], [1.0; 3]);
        // (2, 3, 6) has the length 7.
        assert!(!is_beyond([3.0, 4.0, 7.0], 7.0, lo, hi));
        assert!(!is_beyond([-2.0, -3.0, -6.0], 7.0, lo, hi));
        assert!(is_beyond([3.0, 4.0, 7.0], 7.0 - 1e-13, lo, hi));
        assert!(!is_beyond([0.5; 3], 0.0, lo, hi));
        assert!(!is_beyond([1.0; 3], 0.0, lo, hi));
        assert!(is_beyond([1.0, 1.0, 1.0f64.next_up()], 0.0, lo, hi));
    }

    /// A still line is where it is.
    #[test]
    fn still_line_has_no_crossing_time() {
        let ends = [0.0, 2.0];
        for speed in [0.0, -0.0, exp2(-801), -exp2(-1014)] {
            let is_in = |at: f64| {
                let [first, last] = crossing(Course::new(at, speed), ends);
                first <= last
            };
            assert!(is_in(0.0) && is_in(2.0) && is_in(1.0));
            assert!(!is_in(2.0f64.next_up()) && !is_in(-exp2(-500)));
        }
    }

    /// A line crosses at its ends and a little beyond.
    #[test]
    fn crossing_contains_exact_one() {
        for (speed, wanted) in [(0.1, [10.0, 30.0]), (-0.1, [-30.0, -10.0])] {
            let [first, last] = crossing(Course::new(-1.0, speed), [0.0, 2.0]);
            assert!(first < wanted[0] && first > wanted[0] - 1e-13, "{first}");
            assert!(last > wanted[1] && last < wanted[1] + 1e-13, "{last}");
        }
    }

    #[test]
    fn a_turn_back_undoes_a_turn() {
        let turn = rotation([0.0, 0.0, 1.0, 1.0]);
        let (seen, size) = into_body(&turn, [8.0, 1.0, 3.0], [10.0, 0.0, 0.0]);
        assert_eq!((seen, size), ([1.0, 2.0, 3.0], 3.0));
    }
}
