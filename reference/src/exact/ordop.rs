//! or-DOP against or-DOP, exactly, with a certificate either way: a common point or a separating
//! axis.
//!
//! Both are convex polytopes given by slabs, so they have a common point iff no axis separates
//! them. This is the full test, which includes the 15 axes of oriented boxes. A linear program in
//! f64 guesses the point or the axis ([`super::simplex`]), and the cascade only has to verify it:
//! the point against the slabs, the axis against the corners. If neither f64 with an error bound
//! nor intervals can verify it, the program is solved again in integers, starting where f64 ended.

use std::cmp::Ordering;

use dashu_int::IBig;

use super::axes::{Corners, Posed, Rounded, Separation, common_unit};
use super::relative::{Approximate, Relative};
use super::simplex::{Effort, Optimum, Row, maximise};
use super::{Decision, Interval, Path, axes};
use crate::linear::{Vector, add, apply, dot, integers, largest, scale, transpose};
use crate::number::{Number, unit_of};
use crate::overlap::Overlap;
use crate::shape::Body;

/// Whether the posed or-DOPs overlap, as far as the axes of `test` can tell.
pub fn overlap(a: &Body, b: &Body, test: Overlap) -> Decision<bool> {
    let (a, b) = ((&a.pose, &a.shape.polytope), (&b.pose, &b.shape.polytope));
    match test {
        Overlap::OneSided => axes::overlap_one_sided(a, b),
        Overlap::TwoSided => axes::overlap_two_sided(a, b),
        Overlap::Full => meet(a, b).map(|proof| matches!(proof, Certificate::Common { .. })),
    }
}

/// Whether the posed oriented boxes overlap.
pub fn overlap_obb(a: &Body, b: &Body) -> Decision<bool> {
    let proof = meet((&a.pose, &a.shape.obb), (&b.pose, &b.shape.obb));
    proof.map(|proof| matches!(proof, Certificate::Common { .. }))
}

/// Why two polytopes do or do not meet, in A's slab coordinates ξ.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Certificate {
    /// The point ξ = numerators/denominator·2^unit lies in both; the denominator is positive.
    Common {
        /// Coordinates times the denominator.
        numerators: Vector<IBig>,
        /// What they are divided by.
        denominator: IBig,
        /// Their power of two.
        unit: i32,
    },
    /// All of A lies strictly on one side of all of B along this axis. Zero when one of them is
    /// empty.
    Separated(Vector<IBig>),
}

impl Certificate {
    /// Whether the certificate holds in exact arithmetic, however it was found.
    pub fn verify(&self, a: Posed, b: Posed) -> bool {
        match self {
            Self::Separated(axis) => Corners::<IBig>::new(a, b).separates(axis) == Some(true),
            Self::Common { numerators, denominator, unit } => {
                // The point's own unit joins the lengths'.
                let lengths = common_unit(a, b).min(unit - a.1.basis_unit);
                let lift = |x: &IBig| IBig::lift_integer(x, *unit, lengths + a.1.basis_unit);
                inside(a, b, lengths, &numerators.each_ref().map(lift), denominator) == Some(true)
            }
        }
    }
}

/// Do the polytopes meet, and why?
pub fn meet(a: Posed, b: Posed) -> Decision<Certificate> {
    if a.1.corners.is_empty() || b.1.corners.is_empty() {
        let value = Certificate::Separated([IBig::ZERO, IBig::ZERO, IBig::ZERO]);
        return Decision { value, path: Path::Exact };
    }
    let guess = guess(a, b);
    if let Some(guess) = &guess
        && let Some(path) = confirm(a, b, guess)
    {
        return Decision { value: certificate_of_guess(a, guess), path };
    }
    Decision { value: solve(a, b, guess.map_or(START, |guess| guess.basis)), path: Path::Exact }
}

/// Rows −x, x, y, z of A: multipliers (½, ½, 0, 0) start the dual method.
pub(crate) const START: [usize; 4] = [0, 1, 3, 5];
/// Relative violations that rounding explains.
const DIGITS: f64 = 512.0 * f64::EPSILON;
/// Pivots after which a guess in f64 is as good as it will be.
const GUESSES: usize = 48;

/// The slabs of A, then of B, in A's coordinates: lower end, upper end, and so on.
fn rows<N: Number>(
    a: Posed,
    map: &Relative<N>,
    b: Posed,
    [unit_a, unit_b]: [i32; 2],
) -> Vec<Row<N>> {
    let zero = N::integer(0);
    let mut rows = Vec::with_capacity(2 * (a.1.normals.len() + b.1.normals.len()));
    let mut slab = |normal: &Vector<N>, weight: &N, lo: N, hi: N| {
        let [x, y, z] = normal.each_ref().map(|n| zero.minus(n));
        rows.push(Row { normal: [x, y, z, weight.clone()], end: zero.minus(&lo) });
        let [x, y, z] = normal.clone();
        rows.push(Row { normal: [x, y, z, weight.clone()], end: hi });
    };
    for ((c, lo), hi) in a.1.normals.iter().zip(&a.1.lo).zip(&a.1.hi) {
        slab(&integers(*c), &N::integer(1), N::lift(*lo, unit_a), N::lift(*hi, unit_a));
    }
    let columns = transpose(&map.matrix);
    for ((c, lo), hi) in b.1.normals.iter().zip(&b.1.lo).zip(&b.1.hi) {
        let c = integers(*c);
        let shift = dot(&c, &map.offset);
        let end = |x: f64| map.scale.times(&N::lift(x, unit_b)).minus(&shift);
        slab(&apply(&columns, &c), &map.scale, end(*lo), end(*hi));
    }
    rows
}

/// The program in f64, within the precision of f64.
fn guess(a: Posed, b: Posed) -> Option<Optimum<f64>> {
    let Approximate { matrix, offset, .. } = Approximate::over(b, a);
    let map = Relative { matrix, offset, scale: 1.0 };
    let rows = rows(a, &map, b, [0, 0]);
    let size = rows.iter().map(|row| row.end.abs()).fold(0.0, f64::max);
    let effort = Effort { tolerance: DIGITS * size, pivots: GUESSES };
    maximise(&rows, START, &effort)
}

/// Verifies the guess by f64 with an error bound, then by intervals.
fn confirm(a: Posed, b: Posed, guess: &Optimum<f64>) -> Option<Path> {
    if guess.solution[3] < 0.0 {
        let axis = axis_of(a, guess);
        if Rounded::new(a, b).separates(&axis) == Some(true) {
            return Some(Path::Filter);
        }
        let certain = Corners::new(a, b).separates(&axis.map(Interval::point)) == Some(true);
        return certain.then_some(Path::Interval);
    }
    let point = point_of(guess);
    if inside_rounded(a, b, &point) {
        return Some(Path::Filter);
    }
    let certain = inside(a, b, 0, &point.map(Interval::point), &Interval::integer(1)) == Some(true);
    certain.then_some(Path::Interval)
}

/// Is ξ = numerators/denominator in both polytopes?
fn inside<N: Number>(
    a: Posed,
    b: Posed,
    unit: i32,
    numerators: &Vector<N>,
    denominator: &N,
) -> Option<bool> {
    let map = Relative::<N>::between(b.0, a.0, unit).over(b.1, a.1);
    let seen = add(&apply(&map.matrix, numerators), &scale(denominator, &map.offset));
    let in_a = within(a, unit, numerators, denominator)?;
    Some(in_a && within(b, unit, &seen, &denominator.times(&map.scale))?)
}

fn within<N: Number>(
    (_, polytope): Posed,
    unit: i32,
    numerators: &Vector<N>,
    denominator: &N,
) -> Option<bool> {
    for ((c, lo), hi) in polytope.normals.iter().zip(&polytope.lo).zip(&polytope.hi) {
        let height = dot(&integers(*c), numerators);
        let end = |x: f64| denominator.times(&N::lift(x, unit + polytope.basis_unit));
        for room in [height.minus(&end(*lo)), end(*hi).minus(&height)] {
            if room.sign()? == Ordering::Less {
                return Some(false);
            }
        }
    }
    Some(true)
}

/// Is the point certainly in both? A height c·ξ is off by 3δ from B's mapped coordinates and 2u|ξ|₁
/// from its sum.
fn inside_rounded(a: Posed, b: Posed, point: &Vector<f64>) -> bool {
    let map = Approximate::over(b, a);
    let within = |(_, polytope): Posed, xi: &Vector<f64>, error: f64| {
        let mut slabs = polytope.normals.iter().zip(&polytope.lo).zip(&polytope.hi);
        slabs.all(|((c, lo), hi)| {
            let height = dot(&integers(*c), xi);
            let bound =
                4.0 * error + 4.0 * f64::EPSILON * (3.0 * largest(xi) + lo.abs() + hi.abs());
            height - lo > bound && hi - height > bound
        })
    };
    within(a, point, 0.0) && within(b, &map.map(point), map.error(largest(point)))
}

/// Decides by the linear program in integers; what it ends with is its own proof.
pub(crate) fn solve(a: Posed, b: Posed, start: [usize; 4]) -> Certificate {
    let unit = common_unit(a, b);
    let map = Relative::<IBig>::between(b.0, a.0, unit).over(b.1, a.1);
    let rows = rows(a, &map, b, [unit + a.1.basis_unit, unit + b.1.basis_unit]);
    let effort = Effort { tolerance: IBig::ZERO, pivots: usize::MAX };
    let optimum = maximise(&rows, start, &effort).or_else(|| maximise(&rows, START, &effort));
    let optimum =
        optimum.unwrap_or_else(|| unreachable!("integers know every sign and START is a start"));
    if optimum.solution[3] < IBig::ZERO {
        return Certificate::Separated(axis_of(a, &optimum));
    }
    let [x, y, z, _] = optimum.solution;
    let unit = unit + a.1.basis_unit;
    Certificate::Common { numerators: [x, y, z], denominator: optimum.determinant, unit }
}

/// The multipliers' sum of A's own normals: what A and B are separated along.
fn axis_of<N: Number>(a: Posed, optimum: &Optimum<N>) -> Vector<N> {
    let mut axis = [0, 0, 0].map(N::integer);
    for (row, multiplier) in optimum.basis.iter().zip(&optimum.multipliers) {
        if let Some(normal) = a.1.normals.get(row / 2) {
            let end = N::integer(if row % 2 == 0 { -1 } else { 1 });
            axis = add(&axis, &scale(&multiplier.times(&end), &integers(*normal)));
        }
    }
    axis
}

fn point_of(guess: &Optimum<f64>) -> Vector<f64> {
    [0, 1, 2].map(|i| guess.solution[i] / guess.determinant)
}

fn certificate_of_guess(a: Posed, guess: &Optimum<f64>) -> Certificate {
    let separated = guess.solution[3] < 0.0;
    let vector = if separated { axis_of(a, guess) } else { point_of(guess) };
    let unit = unit_of(vector);
    let numerators = vector.map(|x| IBig::lift(x, unit));
    if separated {
        Certificate::Separated(numerators)
    } else {
        Certificate::Common { numerators, denominator: IBig::ONE, unit }
    }
}
