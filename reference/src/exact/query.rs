//! Queries in exact fractions: does a ball, a segment or a ray meet a box on the world's axes, or a
//! posed mesh, and where does a line meet it first?
//!
//! These are plain loops over the triangles. A mesh is its surface and the space that its closed
//! components enclose, as in [`meeting`]. Touching counts.

use dashu_int::IBig;
use dashu_ratio::RBig;

use super::common::{Rational, contains, crossing_parameter, lifted, world};
use super::meeting;
use super::mesh::Mesh;
use crate::linear::{Vector, add, cross, dot, scale, sub};
use crate::number::Number;
use crate::{Pose, Shape};

/// A segment, or a ray without an end: from + s·direction for 0 ≤ s ≤ `last`.
#[derive(Clone, Debug)]
pub struct ExactLine {
    from: Rational,
    direction: Rational,
    last: Option<RBig>,
}

impl ExactLine {
    /// The segment between two points, s = 0 and s = 1.
    #[must_use]
    pub fn segment(from: Vector<f64>, to: Vector<f64>) -> Self {
        let [from, to] = [from, to].map(lifted);
        Self { direction: sub(&to, &from), from, last: Some(RBig::ONE) }
    }

    /// The ray from a point in a direction.
    #[must_use]
    pub fn ray(origin: Vector<f64>, direction: Vector<f64>) -> Self {
        Self { from: lifted(origin), direction: lifted(direction), last: None }
    }

    fn point(&self, s: &RBig) -> Rational {
        add(&self.from, &scale(s, &self.direction))
    }

    fn has(&self, s: &RBig) -> bool {
        *s >= RBig::ZERO && self.last.as_ref().is_none_or(|last| s <= last)
    }
}

/// Whether a ball meets the box between two corners.
#[must_use]
pub fn ball_meets_box(centre: Vector<f64>, radius: f64, [lo, hi]: [Vector<f64>; 2]) -> bool {
    let [centre, lo, hi] = [centre, lo, hi].map(lifted);
    let nearest = [0, 1, 2].map(|axis| centre[axis].larger(&lo[axis]).smaller(&hi[axis]));
    square_of(&sub(&centre, &nearest)) <= squared(radius)
}

/// The first parameter at which a line meets the box between two corners.
#[must_use]
pub fn line_meets_box(line: &ExactLine, [lo, hi]: [Vector<f64>; 2]) -> Option<RBig> {
    let [lo, hi] = [lo, hi].map(lifted);
    let (mut first, mut last) = (RBig::ZERO, line.last.clone());
    for axis in 0..3 {
        let (at, speed) = (&line.from[axis], &line.direction[axis]);
        if speed.is_zero() {
            if *at < lo[axis] || *at > hi[axis] {
                return None;
            }
            continue;
        }
        let at_end = |end: &RBig| (end - at) / speed;
        let [enters, leaves] = [at_end(&lo[axis]), at_end(&hi[axis])];
        let (enters, leaves) = (enters.smaller(&leaves), enters.larger(&leaves));
        first = first.larger(&enters);
        last = Some(last.map_or(leaves.clone(), |last| last.smaller(&leaves)));
    }
    let is_met = last.is_none_or(|last| first <= last);
    is_met.then_some(first)
}

/// Whether a ball meets a posed mesh.
#[must_use]
pub fn ball_meets_mesh(centre: Vector<f64>, radius: f64, shape: &Shape, pose: &Pose) -> bool {
    let (point, within) = (lifted(centre), squared(radius));
    let is_near = |triangle: &[Rational; 3]| square_of_distance(&point, triangle) <= within;
    triangles(shape, pose).any(|triangle| is_near(&triangle)) || is_in(centre, shape, pose)
}

/// The first parameter at which a line meets a posed mesh.
#[must_use]
pub fn line_meets_mesh(line: &ExactLine, shape: &Shape, pose: &Pose) -> Option<RBig> {
    let from = line.from.each_ref().map(RBig::to_f64_fast);
    if lifted(from) == line.from && is_in(from, shape, pose) {
        return Some(RBig::ZERO);
    }
    let met = triangles(shape, pose).filter_map(|triangle| line_meets_triangle(line, &triangle));
    met.min()
}

/// The mesh's triangles in world coordinates.
fn triangles<'a>(shape: &'a Shape, pose: &'a Pose) -> impl Iterator<Item = [Rational; 3]> + 'a {
    let triangles = shape.mesh().triangles.iter();
    triangles.map(move |corners| corners.map(|corner| world(pose, &lifted(corner))))
}

/// Whether a point is on a posed mesh or within a closed component of it.
fn is_in(point: Vector<f64>, shape: &Shape, pose: &Pose) -> bool {
    let mesh = Mesh::checked(&[[0.0; 3]], &[[0; 3]]);
    let at = Pose::of_f64([0.0, 0.0, 0.0, 1.0], point);
    meeting::meet((&mesh, &at), (shape.mesh(), pose)).meets
}

fn line_meets_triangle(line: &ExactLine, triangle: &[Rational; 3]) -> Option<RBig> {
    let [a, b, c] = triangle;
    let normal = cross(&sub(b, a), &sub(c, a));
    let speed = dot(&normal, &line.direction);
    let mut at = vec![RBig::ZERO];
    if !speed.is_zero() {
        at.push(dot(&normal, &sub(a, &line.from)) / speed);
    }
    // In the triangle's plane, or of a triangle without one, it comes in by an edge or a corner.
    let along = square_of(&line.direction);
    for (p, q) in [(a, b), (b, c), (c, a)] {
        at.extend(crossing_parameter([&line.from, &line.direction], [p, &sub(q, p)]));
        if !along.is_zero() {
            at.push(dot(&sub(p, &line.from), &line.direction) / &along);
        }
    }
    let met = |s: &RBig| line.has(s) && contains(triangle, &line.point(s));
    at.into_iter().filter(met).min()
}

/// The least squared distance of a point from a triangle of any kind.
fn square_of_distance(point: &Rational, triangle: &[Rational; 3]) -> RBig {
    let [a, b, c] = triangle;
    let normal = cross(&sub(b, a), &sub(c, a));
    let size = square_of(&normal);
    if !size.is_zero() {
        let height = dot(&normal, &sub(point, a));
        let foot = sub(point, &scale(&(&height / &size), &normal));
        if contains(triangle, &foot) {
            return &height * &height / size;
        }
    }
    let of_edge = |p: &Rational, q: &Rational| {
        let edge = sub(q, p);
        let length = square_of(&edge);
        let mut s = RBig::ZERO;
        if !length.is_zero() {
            s = dot(&sub(point, p), &edge) / length;
        }
        let s = s.larger(&RBig::ZERO).smaller(&RBig::ONE);
        square_of(&sub(point, &add(p, &scale(&s, &edge))))
    };
    of_edge(a, b).smaller(&of_edge(b, c)).smaller(&of_edge(c, a))
}

fn square_of(v: &Rational) -> RBig {
    dot(v, v)
}

fn squared(radius: f64) -> RBig {
    let radius = RBig::lift(radius, 0);
    &radius * &radius
}

/// Whether a parameter as f64 is no greater than an exact one.
#[must_use]
pub fn is_no_later(at: f64, exact: &RBig) -> bool {
    RBig::lift(at, 0) <= *exact
}

/// The fraction of two whole numbers.
#[must_use]
pub fn fraction(numerator: i64, denominator: i64) -> RBig {
    RBig::from(IBig::from(numerator)) / RBig::from(IBig::from(denominator))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;

    /// A cube of side 2 about its origin, or its lower face alone.
    fn cube(is_whole: bool) -> Shape {
        let corner = |n: u32| [n & 1, n >> 1 & 1, n >> 2].map(|bit| 2.0 * bit as f32 - 1.0);
        let vertices = (0..8).map(corner).collect();
        let mut faces = vec![[0, 2, 1], [1, 2, 3]];
        if is_whole {
            faces.extend([[4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4], [2, 6, 3], [3, 6, 7]]);
            faces.extend([[0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5]]);
        }
        Shape::of_mesh(vertices, faces).unwrap()
    }

    const CORNERS: [Vector<f64>; 2] = [[-1.0; 3], [1.0; 3]];

    /// Balls meet cubes from without and within.
    #[test]
    fn balls_meet_cubes() {
        let (whole, face) = (cube(true), cube(false));
        let pose = Pose::IDENTITY;
        for (centre, radius, meets_whole, meets_face) in [
            // (2, 3, 6) has the length 7.
            ([3.0, 4.0, 7.0], 7.0, true, false),
            ([3.0, 4.0, 7.0], 7.0f64.next_down(), false, false),
            ([-3.0, -4.0, -7.0], 7.0, true, true),
            ([0.0, 0.0, -2.0], 1.0, true, true),
            ([0.0, 0.0, -2.0], 1.0f64.next_down(), false, false),
            ([0.0, 0.25, 0.0], 0.0, true, false),
            ([0.0, 0.25, 0.0], 1.0, true, true),
        ] {
            let found = |shape| ball_meets_mesh(centre, radius, shape, &pose);
            assert_eq!(found(&whole), meets_whole, "{centre:?}");
            assert_eq!(found(&face), meets_face, "{centre:?}");
            assert_eq!(ball_meets_box(centre, radius, CORNERS), meets_whole);
        }
    }

    /// Lines meet cubes first where they enter.
    #[test]
    fn lines_enter_cubes() {
        let (whole, face) = (cube(true), cube(false));
        let pose = Pose::IDENTITY;
        let segment = ExactLine::segment;
        for (line, on_whole, on_face) in [
            (segment([-2.0, 0.0, 0.0], [1.0, 0.0, 0.0]), Some((1, 3)), None),
            (segment([-2.0, 0.0, 0.0], [-1.0, 0.0, 0.0]), Some((1, 1)), None),
            (segment([-2.0, 0.0, 0.0], [-1.25, 0.0, 0.0]), None, None),
            // From within; from a point.
            (segment([0.5; 3], [9.0; 3]), Some((0, 1)), None),
            (segment([0.5; 3], [0.5; 3]), Some((0, 1)), None),
            // Over an edge, of which it has one point.
            (ExactLine::ray([0.0, -2.0, -2.0], [0.0, 1.0, -1.0]), None, None),
            (ExactLine::ray([-2.0, -2.0, 0.0], [1.0, 0.0, -1.0]), None, None),
            (ExactLine::ray([-2.0, 0.0, 0.0], [1.0, 0.0, -1.0]), Some((1, 1)), Some((1, 1))),
            // In the plane of the lower face, and away from it.
            (ExactLine::ray([-4.0, 0.5, -1.0], [3.0, 0.0, 0.0]), Some((1, 1)), Some((1, 1))),
            (ExactLine::ray([-4.0, 0.5, -1.0], [-3.0, 0.0, 0.0]), None, None),
            // Along an edge.
            (ExactLine::ray([-8.0, 1.0, -1.0], [1.0, 0.0, 0.0]), Some((7, 1)), Some((7, 1))),
        ] {
            let exact = |at: Option<(i64, i64)>| at.map(|(n, d)| fraction(n, d));
            assert_eq!(line_meets_mesh(&line, &whole, &pose), exact(on_whole), "{line:?}");
            assert_eq!(line_meets_mesh(&line, &face, &pose), exact(on_face), "{line:?}");
            assert_eq!(line_meets_box(&line, CORNERS), exact(on_whole), "{line:?}");
        }
    }

    /// The segment as a mesh of one flat triangle, by the other formulation.
    #[test]
    fn segments_meet_what_flat_triangles_meet() {
        let whole = cube(true);
        let mut found = [0; 2];
        for n in 0..300_i32 {
            let draw = |k: i32| f64::from((n * 7919 + k * 104_729) % 61 - 30) / 8.0;
            let (from, to) = ([draw(1), draw(2), draw(3)], [draw(4), draw(5), draw(6)]);
            let q = [1.0, -2.0, 0.5, (n % 5) as f32];
            let pose = Pose::from_f64(q, [draw(7), 1.0e9, 0.1]).unwrap();
            let there = |p: Vector<f64>| [p[0], p[1] + 1.0e9, p[2]];
            let ends = [from, to].map(|p| p.map(|x| x as f32));
            let flat = Mesh::checked(&ends, &[[0, 1, 1]]);
            let at = Pose::of_f64([0.0, 0.0, 0.0, 1.0], there([0.0; 3]));
            let wanted = meeting::meet((&flat, &at), (whole.mesh(), &pose)).meets;
            let line = ExactLine::segment(there(from), there(to));
            let first = line_meets_mesh(&line, &whole, &pose);
            assert_eq!(first.is_some(), wanted, "{n}");
            found[usize::from(wanted)] += 1;
        }
        assert!(found.iter().all(|&count| count > 20), "{found:?}");
    }
}
