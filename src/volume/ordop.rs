//! Oriented k-DOPs: slabs `lo ≤ d·x ≤ hi` along directions fixed in the body frame, never
//! re-fitted.
//!
//! Containment is exact. A direction has 24-bit entries, so each product in d·x is exact in f64 and
//! only the two additions round; Knuth's two-sum recovers the lost part. An end that is an f32 (a
//! box's face, a plate's zero) is kept to the bit, any other is rounded outward to the next f32.

use glam::DVec3;

use super::{Basis, DirectionSet};
use crate::mesh::in_f64;
use crate::rounding::{ceil_f32, down, floor_f32, two_sum, up};

/// An oriented k-DOP in the body frame: `lo[i] ≤ d_i·x ≤ hi[i]` for every vertex x in exact
/// arithmetic, with d_i = Σ_j coefficient_ij·column_j.
#[derive(Clone, Debug, PartialEq)]
pub struct OrDop {
    /// Which slab directions.
    pub directions: DirectionSet,
    /// The exact basis that the directions combine.
    pub basis: Basis,
    /// Lower slab ends, one per direction, rounded down.
    pub lo: Vec<f32>,
    /// Upper slab ends, one per direction, rounded up.
    pub hi: Vec<f32>,
}

impl OrDop {
    /// The tightest slabs with f32 ends around the vertices. Without vertices the slabs are empty:
    /// lo = ∞ and hi = −∞.
    #[must_use]
    pub fn build(
        vertices: &[impl Into<[f32; 3]> + Copy],
        basis: Basis,
        directions: DirectionSet,
    ) -> Self {
        let (lo, hi) = directions
            .coefficients()
            .iter()
            .map(|&coefficients| slab(in_f64(&basis.direction(coefficients)), vertices))
            .unzip();
        Self { directions, basis, lo, hi }
    }

    /// The slabs moved outward by `margin`. They contain all points within `margin` of the original
    /// ones.
    #[must_use]
    pub fn grown(&self, margin: f32) -> Self {
        let mut grown = self.clone();
        let ends = grown.lo.iter_mut().zip(&mut grown.hi);
        for ((lo, hi), &coefficients) in ends.zip(self.directions.coefficients()) {
            // Where lo and the margin nearly cancel, the factor exceeds three f64 roundings;
            // elsewhere the step outward does.
            let length = in_f64(&self.basis.direction(coefficients)).length();
            let out = f64::from(margin) * length * (1.0 + 2f64.powi(-40));
            (*lo, *hi) = (down(f64::from(*lo) - out), up(f64::from(*hi) + out));
        }
        grown
    }
}

/// The ends of one slab: min and max of d·x over the vertices, rounded outward.
fn slab(direction: DVec3, vertices: &[impl Into<[f32; 3]> + Copy]) -> (f32, f32) {
    let (mut lo, mut hi) = (f64::INFINITY, f64::NEG_INFINITY);
    for &v in vertices {
        let (below, above) = dot_bounds(direction, in_f64(&v.into()));
        lo = lo.min(below);
        hi = hi.max(above);
    }
    // Zero is added because min and max may return either of −0 and +0, and the bits are hashed.
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
    // sum + lost + lost_too is the exact value; the two remaining additions have a relative error
    // of 2⁻⁵³ each.
    let value = sum + tail;
    let error = f64::EPSILON * 2.0 * (sum.abs() + tail.abs());
    (value - error, value + error)
}

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::*;

    /// Small integers times powers of two, whose products are exact in i128.
    fn holds_exactly(a: [i64; 3], b: [i64; 3]) -> bool {
        let exact: i128 = (0..3).map(|i| i128::from(a[i]) * i128::from(b[i])).sum();
        let [a, b] = [a, b].map(|v| DVec3::from(v.map(|x| x as f64)));
        let (lo, hi) = dot_bounds(a, b);
        lo.ceil() as i128 <= exact && exact <= hi.floor() as i128
    }

    /// The exact sum of products lies within its bounds.
    #[test]
    fn dot_bounds_contain_exact_sum() {
        let big = 1 << 30;
        // Two equal losses; what is lost is all that is left; nothing is lost; losses of other
        // signs.
        assert!(holds_exactly([big, 1, 1], [big, 1, 1]));
        assert!(holds_exactly([big, 1, big], [big, 1, -big]));
        assert!(holds_exactly([big, 0, 3], [big, 7, -5]));
        assert!(holds_exactly([big, 1, -1], [big, 1, 1]));
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let mut next = || {
            // Of 24 bits, and up to 2³¹ times that.
            i64::from(random.next_u32() as i32 >> 8) << (random.next_u32() & 31)
        };
        for _ in 0..20_000 {
            let (a, b) = ([next(), next(), next()], [next(), next(), next()]);
            assert!(holds_exactly(a, b), "{a:?}·{b:?}");
        }
    }

    /// Their bits are hashed.
    #[test]
    fn no_end_is_minus_zero() {
        for vertices in [[-0.0, -1.0, -1.0], [0.0, 1.0, 1.0], [-0.0, 1.0, -1.0]] {
            for direction in [DVec3::X, DVec3::NEG_X] {
                let (lo, hi) = slab(direction, &[vertices]);
                assert_eq!([lo, hi].map(f32::to_bits), [0, 0], "{vertices:?}");
            }
        }
    }
}
