//! [`WidePose`]: exact intersection of meshes and volumes for poses of f64.
//!
//! [`Pose`] takes f32, and the error bounds of volumes assume that. Whether two meshes meet depends
//! on the poses through [`Relative`](crate::exact::relative::Relative) alone. Intervals and
//! integers take any f64. Its first stage, [`Approximate`](crate::exact::relative::Approximate),
//! allows for a mapped coordinate M y + w the error 256u(|y|∞ + |Δ|∞), with u = 2⁻⁵³ and Δ = tB −
//! tA; that is enough for f64 too, where products are rounded as well:
//!
//! - p = conj(qA)·qB: four rounded products, three sums, by Cauchy–Schwarz within 4u|p|.
//! - M = R(p): four products of those, each entry within 4u·2|p|·Σ|pᵢ|/|p| ≤ 16u|p|², and its own
//!   rounding 4u|p|²: 20u. The scale |qA|²|qB|² is within 9u, the division within u: 30u in all.
//! - w = |qB|² R(qA)ᵀΔ: Δ within u of each coordinate, entries of R within 4u|qA|², a row of three
//!   products and two sums within 3u, |qB|² and its product within 5u, scale and division within
//!   10u: at most (u + 3u + 5u + 10u)√3|Δ|∞ + 4u·3|Δ|∞, below 46u|Δ|∞.
//! - M y + w: 30u·3|y|∞, the row's own 3u√3|y|∞, and the last sum: below 100u|y|∞ + 50u|Δ|∞ with
//!   all terms of second order.
//!
//! Numbers too small for a relative bound don't matter: quaternions are scaled to 1 ≤ |q|∞ < 2 and
//! |Δ| underflows only where it is 0, so what a product loses is below 2⁻¹⁰⁷⁰, far below u times
//! the f32 vertices of any mesh that has an extent. Sums too large make the bound NaN, and
//! integers decide.
//!
//! Volumes have no such bound for f64 here, and intervals decide them first.

use dashu_int::IBig;
use dashu_ratio::RBig;

use crate::exact::common::{self, Point, lifted};
use crate::exact::meeting::{self, Meeting};
use crate::exact::{Decision, Interval, axes, cascade, sphere};
use crate::linear::{Vector, add, apply, conjugate_product, largest, norm_squared, rotation};
use crate::number::{Number, power_of_two};
use crate::{Body, InvalidInput, Pose, Shape};

/// Components that are smaller than the largest by more than this power of two are refused.
const SPREAD: i32 = 900;

/// The pose of a mesh in f64: x ↦ R(q)x/|q|² + t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WidePose(pub(crate) Pose);

impl WidePose {
    /// A pose of the quaternion q = (x, y, z, w), of any non-zero norm, and the translation t.
    ///
    /// # Errors
    /// When a number is not finite, the quaternion is zero, or the magnitudes of its non-zero
    /// components differ by more than 2⁹⁰⁰.
    pub fn new(q: [f64; 4], t: [f64; 3]) -> Result<Self, InvalidInput> {
        if !q.iter().all(|x| x.is_finite()) {
            return Err(InvalidInput::NotFinite("the quaternion"));
        }
        if !t.iter().all(|x| x.is_finite()) {
            return Err(InvalidInput::NotFinite("the translation"));
        }
        if q == [0.0; 4] {
            return Err(InvalidInput::ZeroQuaternion);
        }
        let scaled = scaled(q);
        let least = power_of_two(-SPREAD);
        let is_lost = |(given, scaled): (f64, f64)| given != 0.0 && scaled.abs() < least;
        if q.into_iter().zip(scaled).any(is_lost) {
            return Err(InvalidInput::QuaternionSpread);
        }
        Ok(Self(Pose::of_f64(scaled, t)))
    }

    /// The pose of a part: its local pose, then the pose of its body. `None` if f64 doesn't hold
    /// the exact product of the quaternions or the exact translation.
    #[must_use]
    pub fn composed(body: ([f32; 4], Vector<f64>), part: ([f32; 4], Vector<f64>)) -> Option<Self> {
        let [outer, inner] = [body.0, part.0].map(|q| q.map(|x| RBig::lift(f64::from(x), 0)));
        let norm = norm_squared(&outer);
        if norm == RBig::ZERO {
            return None;
        }
        let turned = apply(&rotation(&outer), &lifted(part.1)).map(|x| x / &norm);
        let [x, y, z] = add(&lifted(body.1), &turned).map(held);
        let [i, j, k, w] = outer;
        let [i, j, k, w] = conjugate_product(&[-i, -j, -k, w], &inner).map(held);
        Self::new([i?, j?, k?, w?], [x?, y?, z?]).ok()
    }

    /// The quaternion (x, y, z, w), whose largest magnitude is 1 or more and below 2.
    #[must_use]
    pub fn quaternion(&self) -> [f64; 4] {
        self.0.quaternion()
    }

    /// The translation.
    #[must_use]
    pub fn translation(&self) -> Vector<f64> {
        self.0.translation()
    }

    /// Where the pose takes a point, rounded.
    #[must_use]
    pub fn point(&self, x: &Vector<f64>) -> Vector<f64> {
        add(&self.0.turn(x), &self.translation())
    }
}

/// The fraction, if it is an f64.
fn held(exact: RBig) -> Option<f64> {
    let rounded = exact.to_f64_fast();
    (RBig::lift(rounded, 0) == exact).then_some(rounded)
}

/// The quaternion times the power of two that takes its largest magnitude to 1 or more, below 2:
/// the same rotation. Only what ends below 2⁻¹⁰⁰⁰ is rounded.
fn scaled(q: [f64; 4]) -> [f64; 4] {
    let exponent = |q: [f64; 4]| (largest_of(q).to_bits() >> 52) as i32 - 1023;
    // First out of the subnormal numbers, which have no exponent of their own.
    let q = if exponent(q) < 0 { q.map(|x| x * power_of_two(600)) } else { q };
    // Two steps: one alone may leave the normal numbers.
    let down = -exponent(q);
    q.map(|x| x * power_of_two(down / 2) * power_of_two(down - down / 2))
}

fn largest_of([x, y, z, w]: [f64; 4]) -> f64 {
    largest(&[x, y, z]).max(w.abs())
}

/// Whether two posed meshes intersect, and which stages decided it.
pub fn meet(a: (&Shape, &WidePose), b: (&Shape, &WidePose)) -> Meeting {
    meeting::meet((a.0.mesh(), &a.1.0), (b.0.mesh(), &b.1.0))
}

/// A point that two posed meshes share; `None` when they don't meet.
pub fn common_point(a: (&Shape, &WidePose), b: (&Shape, &WidePose)) -> Option<Point> {
    let [a, b] = [a, b].map(|(shape, pose)| Body { shape, pose: pose.0, dynamic: true });
    common::of_meshes(&a, &b)
}

/// Whether the balls of two posed shapes overlap.
pub fn balls_overlap(a: (&Shape, &WidePose), b: (&Shape, &WidePose)) -> Decision<bool> {
    let (a, b) = ((&a.0.ball, &a.1.0), (&b.0.ball, &b.1.0));
    cascade(
        || None,
        || sphere::judge::<Interval>(a, b, 0),
        || sphere::judge::<IBig>(a, b, sphere::common_unit(a, b)),
    )
}

/// Whether no face normal of the first or-DOP separates it from the second: the one-sided test.
pub fn slabs_overlap(a: (&Shape, &WidePose), b: (&Shape, &WidePose)) -> Decision<bool> {
    let (a, b) = ((&a.1.0, &a.0.polytope), (&b.1.0, &b.0.polytope));
    cascade(|| None, || axes::one_sided::<Interval>(a, b), || axes::one_sided::<IBig>(a, b))
        .map(|separated| !separated)
}
