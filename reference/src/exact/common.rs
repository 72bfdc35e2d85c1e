//! A point that two posed bodies share, as exact fractions in world coordinates: a certificate that
//! a person can check.
//!
//! Balls share the point that divides the line of their centres as rA : rB; or-DOPs the point that
//! their linear program ends with; meshes a corner of one triangle in another, the crossing of an
//! edge with a plane or of two edges, or a vertex of a body inside of the other. Candidates are
//! computed in rationals, and one that lies in both is returned.

use std::cmp::Ordering;
use std::fmt;

use dashu_int::{IBig, UBig};
use dashu_ratio::RBig;

use super::Record;
use super::ordop::{self, Certificate};
use super::parity::inside_closed;
use super::view::View;
use crate::Body;
use crate::linear::{
    Vector, add, apply, cross, dot, norm_squared, rotation, scale, sub, transpose,
};
use crate::number::{Number, dyadic};
use crate::pose::Pose;

pub(crate) type Rational = Vector<RBig>;

/// A point with rational coordinates.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Point(pub [RBig; 3]);

impl Point {
    /// The point with these coordinates.
    #[must_use]
    pub fn of(coordinates: [f32; 3]) -> Self {
        Self(lifted(coordinates.map(f64::from)))
    }

    /// The coordinates as fractions in lowest terms.
    #[must_use]
    pub fn fractions(&self) -> [String; 3] {
        self.0.each_ref().map(RBig::to_string)
    }

    /// The coordinates, each rounded to f64.
    #[must_use]
    pub fn decimals(&self) -> [f64; 3] {
        self.0.each_ref().map(RBig::to_f64_fast)
    }
}

impl fmt::Display for Point {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "({})", self.fractions().join(", "))
    }
}

impl Number for RBig {
    fn lift(x: f64, _unit: i32) -> Self {
        let (mantissa, exponent) = dyadic(x);
        Self::lift_integer(&IBig::from(mantissa), exponent, 0)
    }
    fn integer(n: i32) -> Self {
        Self::from(n)
    }
    fn lift_integer(x: &IBig, x_unit: i32, _unit: i32) -> Self {
        let shift = x_unit.unsigned_abs() as usize;
        if x_unit < 0 {
            Self::from_parts(x.clone(), UBig::ONE << shift)
        } else {
            Self::from(x << shift)
        }
    }
    fn plus(&self, other: &Self) -> Self {
        self + other
    }
    fn minus(&self, other: &Self) -> Self {
        self - other
    }
    fn times(&self, other: &Self) -> Self {
        self * other
    }
    fn larger(&self, other: &Self) -> Self {
        self.max(other).clone()
    }
    fn smaller(&self, other: &Self) -> Self {
        self.min(other).clone()
    }
    fn sign(&self) -> Option<Ordering> {
        Some(self.cmp(&Self::ZERO))
    }
}

/// A point of both bounding balls; `None` when they are apart.
pub fn of_balls(a: &Body, b: &Body) -> Option<Point> {
    let [from, to] =
        [a, b].map(|body| world(&body.pose, &lifted(body.shape.ball.centre.map(f64::from))));
    let [ra, rb] = [a, b].map(|body| RBig::lift(f64::from(body.shape.ball.radius), 0));
    let between = sub(&to, &from);
    let reach = ra.plus(&rb);
    if dot(&between, &between) > reach.times(&reach) {
        return None;
    }
    // Both radii are zero only when the centres coincide.
    let part = if reach.is_zero() { RBig::ZERO } else { ra / reach };
    Some(Point(add(&from, &scale(&part, &between))))
}

/// A point of both or-DOPs; `None` when they are apart.
pub fn of_slabs(a: &Body, b: &Body) -> Option<Point> {
    let polytope = &a.shape.polytope;
    let proof = ordop::meet((&a.pose, polytope), (&b.pose, &b.shape.polytope)).value;
    let Certificate::Common { numerators, denominator, unit } = proof else {
        return None;
    };
    let denominator = RBig::from(denominator);
    let xi = numerators.map(|n| RBig::lift_integer(&n, unit, 0) / &denominator);
    let basis = polytope.basis.map(lifted);
    let norm = dot(&basis[0], &basis[0]);
    let x = apply(&transpose(&basis), &xi).map(|component| component / &norm);
    Some(Point(world(&a.pose, &x)))
}

/// A point of both meshes; `None` when they don't meet.
pub fn of_meshes(a: &Body, b: &Body) -> Option<Point> {
    let (posed_a, posed_b) = ((a.shape.mesh(), &a.pose), (b.shape.mesh(), &b.pose));
    let view = View::new(posed_a, posed_b);
    for tb in 0..view.b.triangles.len() {
        let corners = &view.b.triangles[tb];
        let mapped = corners.each_ref().map(|p| view.map.map(p));
        let meets = |ta: &usize| view.triangles_meet(*ta as u32, tb as u32, &mapped).value;
        if let Some(ta) = (0..view.a.triangles.len()).find(meets) {
            let first = view.a.triangles[ta].map(|p| world(&a.pose, &lifted(p)));
            let second = corners.map(|p| world(&b.pose, &lifted(p)));
            return shared(&first, &second).map(Point);
        }
    }
    vertex_inside(&view, &b.pose).or_else(|| vertex_inside(&View::new(posed_b, posed_a), &a.pose))
}

/// A vertex of the second body inside of the first.
fn vertex_inside(view: &View, pose: &Pose) -> Option<Point> {
    let closed = view.a.components.iter().any(|component| component.closed);
    let inside = |vertex: &&Vector<f64>| inside_closed(view, vertex, &mut Record::default());
    let vertex = view.b.representatives.iter().find(|v| closed && inside(v))?;
    Some(Point(world(pose, &lifted(*vertex))))
}

pub(crate) fn lifted(v: Vector<f64>) -> Rational {
    v.map(|x| RBig::lift(x, 0))
}

/// R(q)x/|q|² + t
pub(super) fn world(pose: &Pose, x: &Rational) -> Rational {
    let q = pose.quaternion().map(|c| RBig::lift(c, 0));
    let norm = norm_squared(&q);
    let turned = apply(&rotation(&q), x).map(|component| component / &norm);
    add(&turned, &lifted(pose.translation()))
}

/// A common point of two triangles of any kind.
fn shared(a: &[Rational; 3], b: &[Rational; 3]) -> Option<Rational> {
    let edges =
        |t: &[Rational; 3]| [(0, 1), (1, 2), (2, 0)].map(|(i, j)| [t[i].clone(), t[j].clone()]);
    let mut candidates: Vec<Rational> = a.iter().chain(b).cloned().collect();
    for edge in edges(a) {
        candidates.extend(piercing(&edge, b));
        candidates.extend(edges(b).iter().filter_map(|other| crossing(&edge, other)));
    }
    candidates.extend(edges(b).iter().filter_map(|edge| piercing(edge, a)));
    candidates.into_iter().find(|x| contains(a, x) && contains(b, x))
}

/// Where the line of an edge crosses the plane of a triangle; `None` when they are parallel.
fn piercing([p, q]: &[Rational; 2], t: &[Rational; 3]) -> Option<Rational> {
    let normal = cross(&sub(&t[1], &t[0]), &sub(&t[2], &t[0]));
    let along = sub(q, p);
    let speed = dot(&normal, &along);
    (!speed.is_zero()).then(|| add(p, &scale(&(dot(&normal, &sub(&t[0], p)) / speed), &along)))
}

/// The point of the line pq that is nearest to the line ab; `None` when they are parallel.
fn crossing([p, q]: &[Rational; 2], [a, b]: &[Rational; 2]) -> Option<Rational> {
    let u = sub(q, p);
    let at = crossing_parameter([p, &u], [a, &sub(b, a)])?;
    Some(add(p, &scale(&at, &u)))
}

/// The s for which p + s·u is nearest to the line a + t·v; `None` when they are parallel.
pub(super) fn crossing_parameter([p, u]: [&Rational; 2], [a, v]: [&Rational; 2]) -> Option<RBig> {
    let normal = cross(u, v);
    let size = dot(&normal, &normal);
    (!size.is_zero()).then(|| dot(&cross(&sub(a, p), v), &normal) / size)
}

/// Whether a point is in a triangle of any kind.
pub(super) fn contains(t: &[Rational; 3], x: &Rational) -> bool {
    let edges = [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (&t[i], &t[j]));
    let normal = cross(&sub(&t[1], &t[0]), &sub(&t[2], &t[0]));
    let turn = |(a, b): (&Rational, &Rational)| cross(&sub(b, a), &sub(x, a));
    if normal.iter().all(RBig::is_zero) {
        return edges
            .into_iter()
            .any(|edge| turn(edge).iter().all(RBig::is_zero) && between(edge, x));
    }
    dot(&normal, &sub(x, &t[0])).is_zero()
        && edges.into_iter().all(|edge| dot(&normal, &turn(edge)) >= RBig::ZERO)
}

/// Whether a point of a segment's line is between its ends.
fn between((a, b): (&Rational, &Rational), x: &Rational) -> bool {
    (0..3).all(|i| (a[i] <= x[i] && x[i] <= b[i]) || (b[i] <= x[i] && x[i] <= a[i]))
}
