//! The pose of one body in the frame of another, free of divisions.
//!
//! In A's frame, scaled by s = |qA|²|qB|², a point y of B's frame is M y + w with M = R(p), p =
//! conj(qA)·qB and w = |qB|² R(qA)ᵀ(tB − tA); a point x of A's frame is s x. Everything is a
//! polynomial, so dyadic input gives integers, and A's own points carry no rounding at all. Over
//! slab bases (rows bA, bB of squared norm βA, βB), the same holds of the coordinates ξ = b·x with
//! bA M bBᵀ, βB bA w and βB s for M, w and s.

use super::polytope::Polytope;
use crate::linear::{
    Matrix, Vector, add, apply, conjugate_product, dot, largest, multiply, norm_squared, rotation,
    scale, sub, transpose,
};
use crate::number::{Number, power_of_two, unit_of};
use crate::pose::{Pose, separation};

/// y ↦ M y + w, which is `scale` > 0 times the position in the other frame.
#[derive(Clone, Debug)]
pub struct Relative<N> {
    /// M
    pub matrix: Matrix<N>,
    /// w
    pub offset: Vector<N>,
    /// s
    pub scale: N,
}

impl<N: Number> Relative<N> {
    /// B's frame seen from A's, lengths in multiples of 2^unit.
    pub fn between(a: &Pose, b: &Pose, unit: i32) -> Self {
        let [qa, qb] = [a, b].map(quaternion::<N>);
        let [ta, tb] = [a, b].map(|pose| pose.translation().map(|x| N::lift(x, unit)));
        let norm_b = norm_squared(&qb);
        Self {
            matrix: rotation(&conjugate_product(&qa, &qb)),
            offset: scale(&norm_b, &apply(&transpose(&rotation(&qa)), &sub(&tb, &ta))),
            scale: norm_squared(&qa).times(&norm_b),
        }
    }

    /// The same map between coordinates ξ over the bases of two polytopes. Slab ends are then
    /// lifted by the length unit plus the unit of their own basis.
    pub fn over(&self, a: &Polytope, b: &Polytope) -> Self {
        let [rows_a, rows_b] =
            [a, b].map(|p| p.basis.map(|row| row.map(|x| N::lift(x, p.basis_unit))));
        let norm_b = dot(&rows_b[0], &rows_b[0]);
        Self {
            matrix: multiply(&rows_a, &multiply(&self.matrix, &transpose(&rows_b))),
            offset: scale(&norm_b, &apply(&rows_a, &self.offset)),
            scale: norm_b.times(&self.scale),
        }
    }

    /// M y + w
    pub fn map(&self, y: &Vector<N>) -> Vector<N> {
        add(&apply(&self.matrix, y), &self.offset)
    }

    /// s x for a point of A's own frame.
    pub fn own(&self, x: &Vector<f64>, unit: i32) -> Vector<N> {
        scale(&self.scale, &x.map(|x| N::lift(x, unit)))
    }

    /// M y + w for a point of B's frame.
    pub fn seen(&self, y: &Vector<f64>, unit: i32) -> Vector<N> {
        self.map(&y.map(|y| N::lift(y, unit)))
    }
}

/// The quaternion, scaled by powers of two: the rotation does not notice, and f64 neither overflows
/// nor underflows.
pub(crate) fn quaternion<N: Number>(pose: &Pose) -> [N; 4] {
    let q = pose.quaternion();
    let largest = q.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    // f32 numbers are normal in f64: the exponent field is the binary exponent.
    let exponent = (largest.to_bits() >> 52) as i32 - 1023;
    let scaled = q.map(|x| x * power_of_two(-exponent));
    let unit = unit_of(scaled);
    scaled.map(|x| N::lift(x, unit))
}

/// [`Relative`] divided by its scale in f64, with a bound on what rounding did.
///
/// With u = 2⁻⁵³, exact products of f32 pairs and Cauchy–Schwarz on every sum of products, the hand
/// count is: p within 2.1u|p|, M's entries (norm 1) within 20.3u, w within 42u‖t‖, M y + w within
/// 68u|y| + 44u|t|; and over bases 180uκ|y| + 92u|bA||t| with κ = |bA|/|bB|. The bound takes 256u
/// of all: 2⁻⁴⁵. f32 inputs leave f64's range only in sums whose other terms are 2⁵⁰⁰ times larger.
#[derive(Clone, Debug)]
pub struct Approximate {
    /// M/s
    pub matrix: Matrix<f64>,
    /// w/s
    pub offset: Vector<f64>,
    stretch: f64,
    distance: f64,
}

/// Relative rounding error of a mapped coordinate.
const MAP_ERROR: f64 = 1.0 / (1_u64 << 45) as f64;
/// Sums of magnitudes above this might overflow further on: the filter then stays silent.
const LARGEST: f64 = 1e250;

impl Approximate {
    /// B's frame seen from A's.
    pub fn between(a: &Pose, b: &Pose) -> Self {
        Self::divided(&Relative::between(a, b, 0), 1.0, largest(&separation(a, b)))
    }

    /// B's slab coordinates seen from A's.
    pub fn over(a: (&Pose, &Polytope), b: (&Pose, &Polytope)) -> Self {
        let norm = |p: &Polytope| p.basis_norm_squared().sqrt();
        let relative = Relative::between(a.0, b.0, 0).over(a.1, b.1);
        let distance = norm(a.1) * largest(&separation(a.0, b.0));
        Self::divided(&relative, norm(a.1) / norm(b.1), distance)
    }

    fn divided(relative: &Relative<f64>, stretch: f64, distance: f64) -> Self {
        let divide = |x: f64| x / relative.scale;
        Self {
            matrix: relative.matrix.map(|row| row.map(divide)),
            offset: relative.offset.map(divide),
            stretch,
            distance,
        }
    }

    /// The mapped position, each coordinate within [`Self::error`] of the true one.
    pub fn map(&self, y: &Vector<f64>) -> Vector<f64> {
        add(&apply(&self.matrix, y), &self.offset)
    }

    /// Bound on the rounding error of a mapped coordinate for |y|∞ ≤ reach; NaN when f64's range
    /// might not suffice.
    pub fn error(&self, reach: f64) -> f64 {
        let size = self.stretch * reach + self.distance;
        if size <= LARGEST { MAP_ERROR * size } else { f64::NAN }
    }
}
