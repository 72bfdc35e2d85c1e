//! Outward rounding, and every error bound that the culler relies on, as a named constant.
//!
//! Deciding arithmetic is f32 without FMA in one written order, so a computed quantity differs from
//! its exact value by a known multiple of the unit roundoff u = 2⁻²⁴. Each volume is inflated
//! *once*, when it is built or updated, by more than that, and the tests then compare without any
//! margin: `cull ⇔ d² > s·s` and `cull ⇔ τ > h_A + h_B` never separate two bodies that meet in
//! exact real arithmetic. A margin in the volume costs nothing in the pair loop, and one bound per
//! volume can be proved; an epsilon in each comparison can't.
//!
//! Every bound here follows from one model of a machine operation: the result is x(1+ε)+φ with
//! |ε| ≤ u and |φ| ≤ [`FLUSH`]. It holds with denormals on, with results flushed to zero, and with
//! operands read as zero.
//!
//! Each constant states its derivation, the Gappa script in `paper/proofs/` that checks it (the
//! control next to it is one notch tighter and must fail), and the largest error that hill climbing
//! has found in 10⁷ steps (`benches/criterion/worst_case.rs`; a shorter search is in the tests).

pub mod border;
pub mod compose;
pub mod cube;
pub mod narrow;
pub mod period;
pub mod pose;
pub mod query;
pub mod skin;
pub mod slab;
pub mod sphere;

use crate::simd::Aabb;

/// 2ᵉ for a normal exponent.
pub const fn exp2(e: i32) -> f64 {
    assert!(-1022 <= e && e <= 1023);
    f64::from_bits(((1023 + e) as u64) << 52)
}

/// u = 2⁻²⁴, the unit roundoff of f32: |fl(x) − x| ≤ u|x| in the normal range.
pub const U: f64 = exp2(-24);

/// 2⁻¹²⁶, the smallest normal f32: what flush-to-zero or denormals-are-zero may change at most in
/// one operand or result. Gradual underflow changes at most 2⁻¹⁵⁰.
pub const FLUSH: f64 = exp2(-126);

/// 2⁶⁰, the contract's limit on |t|∞ and on sizes. Squares of sums stay below 2¹²⁷, so no deciding
/// product overflows.
pub const LIMIT: f32 = exp2(60) as f32;

/// 1 + 2⁻²⁰ = 1 + 16u, by which pair finders widen radii so that they lose no pair which the sphere
/// test reports (|Δ| ≤ (R_A + R_B)(1 + 4u)); the rest is for their own f32 arithmetic on radii.
/// Proof: `finder.g`.
pub const FINDER_FACTOR: f64 = 1.0 + exp2(-20);

/// 2⁻⁷⁸: the same where squares underflow, R being 2⁻⁷⁰ at least. Proof: `finder.g`.
pub const FINDER_FLOOR: f64 = exp2(-78);

/// a + b = sum + lost exactly, in any order of magnitude (Knuth's two-sum).
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

/// The smallest f32 that certainly exceeds the exact value that `x`, a result of f64 arithmetic,
/// approximates.
///
/// Always one step above the nearest f32, exact or not: the f64 operation may itself have rounded
/// down. The step is at least 2⁻²⁵|x| and at least 2⁻¹⁵⁰, so it also covers an f64 error of up to
/// 2⁻²⁶|x|. Infinity stays; NaN stays NaN.
pub const fn up(x: f64) -> f32 {
    (x as f32).next_up()
}

/// The mirror of [`up`]: an f32 certainly below the exact value that `x` approximates.
pub const fn down(x: f64) -> f32 {
    (x as f32).next_down()
}

/// The f32 box about an f64 box: each end is that of [`down`] and [`up`], except that next to a
/// zero it may be a zero.
#[inline]
#[must_use]
pub fn outward_box(min: &[f64; 3], max: &[f64; 3]) -> Aabb {
    // The bits of an f32 in the order of the numbers, and back. No branch, of every box that is
    // set.
    let ranked = |bits: i32| bits ^ ((bits >> 31) & i32::MAX);
    let stepped = |x: f64, by: i32| {
        let rank = ranked((x as f32).to_bits() as i32) + by;
        f32::from_bits(ranked(rank) as u32)
    };
    Aabb { min: min.map(|x| stepped(x, -1)), max: max.map(|x| stepped(x, 1)) }
}

/// The smallest f32 that is at least `x`, itself if it is an f32.
#[must_use]
pub const fn ceil_f32(x: f64) -> f32 {
    let nearest = x as f32;
    if (nearest as f64) < x { nearest.next_up() } else { nearest }
}

/// The largest f32 that is at most `x`, itself if it is an f32.
#[must_use]
pub const fn floor_f32(x: f64) -> f32 {
    -ceil_f32(-x)
}

/// The radius by which a pair finder sorts, bins or sizes its cells, for a radius that the volume
/// test uses.
pub const fn widen(radius: f32) -> f32 {
    up(radius as f64 * FINDER_FACTOR + FINDER_FLOOR)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_keep_what_is_lost() {
        assert_eq!(two_sum(1.0e16, 1.0), (1.0e16, 1.0));
        assert_eq!(two_sum(0.5, -0.25), (0.25, 0.0));
    }

    #[test]
    fn outward_means_strictly_past_the_nearest() {
        for x in [
            0.0,
            -0.0,
            1.0,
            -1.0,
            1.0 + exp2(-40),
            1.0 - exp2(-40),
            exp2(-149),
            -exp2(-160),
            3.5e38,
            -3.5e38,
        ] {
            assert!(f64::from(up(x)) > x && f64::from(down(x)) < x, "{x:e}");
        }
        assert_eq!(up(1.0), 1.0 + f32::EPSILON);
        assert_eq!(down(1.0), 1.0 - f32::EPSILON / 2.0);
    }

    /// The box has the ends that one-sided rounding gives, but for the sign and the side of a zero,
    /// and contains the f64 box always.
    #[test]
    fn outward_boxes_contain() {
        let least = f64::from(f32::from_bits(1));
        let sizes = [0.0, 0.4 * least, 0.6 * least, least, 1.0, 1.0 + exp2(-40), exp2(60)];
        for x in sizes.into_iter().flat_map(|size| [size, -size]) {
            let Aabb { min, max } = outward_box(&[x, 1.0, x], &[x, 1.0, x]);
            assert!(f64::from(min[0]) <= x && x <= f64::from(max[2]), "{x:e}");
            if x.abs() > least {
                assert_eq!(([min[0], min[2]], [max[0], max[2]]), ([down(x); 2], [up(x); 2]));
            }
            assert_eq!((min[1], max[1]), (down(1.0), up(1.0)));
        }
    }

    #[test]
    fn infinities_stay_outward_and_nan_stays() {
        assert_eq!(up(f64::INFINITY), f32::INFINITY);
        assert_eq!(down(f64::NEG_INFINITY), f32::NEG_INFINITY);
        assert_eq!(down(f64::INFINITY), f32::MAX);
        assert_eq!(up(f64::MAX), f32::INFINITY);
        assert!(up(f64::NAN).is_nan() && down(f64::NAN).is_nan());
    }

    /// Contract limit leaves room for every square.
    #[test]
    fn squares_at_the_limit_are_finite() {
        // d² of centres at opposite corners, and (R + R)² of the largest radii after every
        // inflation.
        let (d, s) = (2.0 * LIMIT, 2.0 * widen(sphere::inflate_radius(2.0 * LIMIT)));
        assert!((3.0 * d * d).is_finite() && (s * s).is_finite());
    }

    /// Widening exceeds the factor and moves zero.
    #[test]
    fn widening_exceeds_its_factor() {
        assert!(widen(0.0) > 0.0);
        assert!(f64::from(widen(1.0)) >= FINDER_FACTOR);
        assert!(widen(0.0) < 1e-20 && widen(1.0) < 1.0 + 1e-5, "and little else");
    }
}
