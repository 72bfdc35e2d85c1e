//! Oriented k-DOPs: slabs `lo ≤ d·x ≤ hi` along directions fixed in the body frame, never re-fitted.
//!
//! Containment is exact. A direction has 24-bit entries, so each product of d·x is exact in f64 and only the two
//! additions round; Knuth's two-sum recovers what they lost. An end that is an f32 (a box's face, a plate's zero) is kept
//! to the bit, any other is the next f32 outward.

use glam::{DVec3, Vec3};

use super::{Basis, DirectionSet};
use crate::rounding::{down, up};

/// An oriented k-DOP in the body frame: `lo[i] ≤ d_i·x ≤ hi[i]` for every vertex x in exact arithmetic,
/// with d_i = Σ_j coefficient_ij·column_j.
#[derive(Clone, Debug, PartialEq)]
pub struct OrDop {
    /// Which slab directions.
    pub directions: DirectionSet,
    /// The exact basis that the directions combine.
    pub basis: Basis,
    /// Lower slab ends, one a direction, rounded down.
    pub lo: Vec<f32>,
    /// Upper slab ends, one a direction, rounded up.
    pub hi: Vec<f32>,
}

impl OrDop {
    /// The tightest slabs with f32 ends around the vertices. No vertices: empty slabs, lo = ∞ and hi = −∞.
    #[must_use]
    pub fn build(vertices: &[Vec3], basis: Basis, directions: DirectionSet) -> Self {
        let (lo, hi) = directions
            .coefficients()
            .iter()
            .map(|&coefficients| slab(basis.direction(coefficients).as_dvec3(), vertices))
            .unzip();
        Self {
            directions,
            basis,
            lo,
            hi,
        }
    }

    /// The slabs moved out by `margin`: what they contain with all points up to `margin` away.
    #[must_use]
    pub fn grown(&self, margin: f32) -> Self {
        let mut grown = self.clone();
        let ends = grown.lo.iter_mut().zip(&mut grown.hi);
        for ((lo, hi), &coefficients) in ends.zip(self.directions.coefficients()) {
            // The factor is above what three f64 roundings take where lo and the margin nearly cancel; elsewhere the
            // step outward is.
            let length = self.basis.direction(coefficients).as_dvec3().length();
            let out = f64::from(margin) * length * (1.0 + 2f64.powi(-40));
            (*lo, *hi) = (down(f64::from(*lo) - out), up(f64::from(*hi) + out));
        }
        grown
    }
}

/// The ends of one slab: min and max of d·x over the vertices, rounded outward.
fn slab(direction: DVec3, vertices: &[Vec3]) -> (f32, f32) {
    let (mut lo, mut hi) = (f64::INFINITY, f64::NEG_INFINITY);
    for v in vertices {
        let (below, above) = dot_bounds(direction, v.as_dvec3());
        lo = lo.min(below);
        hi = hi.max(above);
    }
    // Plus zero, because min and max may return either of −0 and +0, and the bits are hashed.
    (floor_f32(lo) + 0.0, ceil_f32(hi) + 0.0)
}

/// An interval that contains a·b, for a and b with 24-bit entries; a point when a·b is an f64.
fn dot_bounds(a: DVec3, b: DVec3) -> (f64, f64) {
    let (partial, lost) = two_sum(a.x * b.x, a.y * b.y);
    let (sum, lost_too) = two_sum(partial, a.z * b.z);
    let tail = lost + lost_too;
    if tail == 0.0 {
        return (sum, sum); // exact: all terms are multiples of 2⁻²⁹⁸, so nothing underflows
    }
    // sum + lost + lost_too is the exact value; two additions of relative error 2⁻⁵³ each are left.
    let value = sum + tail;
    let error = f64::EPSILON * 2.0 * (sum.abs() + tail.abs());
    (value - error, value + error)
}

/// Knuth's two-sum: a + b = sum + error exactly, in any order of magnitude.
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    let of_a = sum - of_b;
    (sum, (a - of_a) + (b - of_b))
}

/// The smallest f32 that is at least `x`.
fn ceil_f32(x: f64) -> f32 {
    let nearest = x as f32;
    if f64::from(nearest) < x {
        nearest.next_up()
    } else {
        nearest
    }
}

/// The largest f32 that is at most `x`.
fn floor_f32(x: f64) -> f32 {
    -ceil_f32(-x)
}
