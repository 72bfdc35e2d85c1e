//! Rotations in f64, rounded to f32.
//!
//! A quaternion in f64 names an exact rotation. All volumes and tests have poses in f32, so it is
//! rounded, and the body is grown by the distance that its points may move. Theorem Z of
//! `paper/proofs/LEMMAS.md`. (Boxes in f64 are rounded outward, which takes no bound.)

use super::compose::TURN_ERROR;
use super::exp2;

/// The sizes of the largest component between which a quaternion is rounded as it is. Others are
/// divided by it first, so that no component is lost that turns anything.
const UNSCALED: std::ops::RangeInclusive<f64> = exp2(-60)..=exp2(60);

/// A quaternion (x, y, z, w) in f32, and whether it was rounded: its points are then off by up to
/// [`turn_error`]. It is zero or not finite if and only if the one in f64 is.
#[must_use]
pub fn narrow(q: [f64; 4]) -> ([f32; 4], bool) {
    let narrow = q.map(|x| x as f32);
    if narrow.map(f64::from) == q {
        return (narrow, false);
    }
    let largest = q.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    if UNSCALED.contains(&largest) || !largest.is_finite() {
        return (narrow, true);
    }
    (q.map(|x| (x / largest) as f32), true)
}

/// By how much the rotation of [`narrow`] moves a point at this distance, at most.
#[inline]
#[must_use]
pub fn turn_error(is_rounded: bool, distance: f64) -> f64 {
    if is_rounded { TURN_ERROR * distance } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::*;

    /// How far a point at the distance 1 may move, as a share of the bound.
    fn share(q: [f64; 4]) -> f64 {
        let (narrow, is_rounded) = narrow(q);
        let narrow = narrow.map(f64::from);
        let largest = q.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let q = q.map(|x| x / largest);
        let dot = |a: [f64; 4], b: [f64; 4]| (0..4).map(|i| a[i] * b[i]).sum::<f64>();
        let along = dot(q, narrow) / dot(q, q);
        let across = [0, 1, 2, 3].map(|i| narrow[i] - along * q[i]);
        2.0 * (dot(across, across) / dot(narrow, narrow)).sqrt() / turn_error(is_rounded, 1.0)
    }

    #[test]
    fn turn_error_covers_rounding() {
        let mut words = ChaCha8Rng::seed_from_u64(4);
        let mut random = move || (words.next_u64() >> 11) as f64 * exp2(-52) - 1.0;
        let mut worst = 0.0_f64;
        for step in 0..400_000 {
            let scale = exp2([0, 0, 0, 59, -60, -149, 300, -900][step % 8]);
            worst = worst.max(share([(); 4].map(|()| random() * scale)));
            // Just above a power of two, where f32 is coarsest, and halfway between two.
            let halfway =
                [1.0, 3.0, 1.0, 3.0].map(|odd| 1.0 + odd * exp2(-24) + exp2(-50) * random());
            worst = worst.max(share(halfway.map(|x| x * scale)));
        }
        assert!((0.88..=1.0).contains(&worst), "{worst}");
    }

    #[test]
    fn exact_and_invalid_quaternions_stay() {
        for q in [[0.0, -0.0, 0.5, 1.5], [0.0; 4], [exp2(-149), 0.0, 0.0, exp2(127)]] {
            let (narrow, is_rounded) = narrow(q);
            assert_eq!((narrow.map(f64::from), is_rounded), (q, false));
        }
        for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY] {
            let (narrow, _) = narrow([0.1, bad, 0.0, 1.0]);
            assert_eq!(narrow[1].to_bits() & !(1 << 31), (bad as f32).to_bits() & !(1 << 31));
        }
        let (far, _) = narrow([1.0e300, -1.0e300, 0.0, 1.0]);
        assert_eq!(far, [1.0, -1.0, 0.0, 0.0]);
    }
}
