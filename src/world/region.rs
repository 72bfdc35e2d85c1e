//! The f32 coordinates of a region, and the bound of their error.
//!
//! A translation is subtracted twice in f64 and rounded to f32. The error is bounded, and the bound
//! is added to the body's margin, so that volumes at the rounded place contain the exact mesh
//! (theorem T).

use crate::rounding::query::largest;
use crate::rounding::{exp2, two_sum};

/// √3·2⁻²⁴ < 2⁻²³: the largest distance by which rounding the local translation to f64 and then to
/// f32 moves a body, as a multiple of its largest coordinate.
const MOVED: f64 = exp2(-23);

/// √3·2⁻¹⁵⁰ < 2⁻¹⁴⁹: the same for f32 that underflows.
const MOVED_LEAST: f64 = exp2(-149);

/// √3·2⁻⁵³ < 2⁻⁵²: the largest distance by which rounding the difference from the origin to f64
/// moves a body, as a multiple of its largest coordinate.
const MOVED_BEFORE: f64 = exp2(-52);

/// The origin of the f32 coordinates of a region's bodies: `origin` in the world becomes −`corner`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Region {
    pub origin: [f64; 3],
    pub corner: [f64; 3],
}

/// A body's slot, its translation, and the reach of the mesh with its margin from there.
pub(super) type PlacedBody = (usize, [f64; 3], f64);

impl Region {
    /// The local translation, and the bound of its error: 0 if no step is rounded.
    #[inline]
    pub fn place(&self, t: [f64; 3]) -> ([f32; 3], f64) {
        let (far, near, is_exact) =
            if *self == Self::default() { (t, t, true) } else { self.differences(t) };
        let local = near.map(|x| x as f32);
        if is_exact && local.map(f64::from) == near {
            return (local, 0.0);
        }
        let error = largest(near) * MOVED + largest(far) * MOVED_BEFORE + MOVED_LEAST;
        (local, error)
    }

    /// The differences from the origin, and those from the corner then, and whether all are exact.
    fn differences(&self, t: [f64; 3]) -> ([f64; 3], [f64; 3], bool) {
        let from_origin = [0, 1, 2].map(|i| two_sum(t[i], -self.origin[i]));
        let far = from_origin.map(|(sum, _)| sum);
        let from_corner = [0, 1, 2].map(|i| two_sum(far[i], -self.corner[i]));
        let is_exact = from_origin.iter().chain(&from_corner).all(|(_, lost)| *lost == 0.0);
        (far, from_corner.map(|(sum, _)| sum), is_exact)
    }
}

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::*;

    /// The distance by which rounding moves a body, accurate to 2⁻⁵⁰, as a share of the bound.
    fn share(region: &Region, t: [f64; 3]) -> f64 {
        let (placed, bound) = region.place(t);
        let moved = |i: usize| {
            let (first, lost) = two_sum(t[i], -region.origin[i]);
            let (second, lost_again) = two_sum(first, -region.corner[i]);
            (f64::from(placed[i]) - second) - (lost + lost_again)
        };
        assert!(bound > 0.0);
        let sum: f64 = (0..3).map(|i| (moved(i) / bound).powi(2)).sum();
        sum.sqrt()
    }

    #[test]
    fn exact_places_have_no_bound() {
        let region = Region { origin: [1024.0, -2048.0, 0.0], corner: [-64.0, 128.0, 0.0] };
        let (place, moved) = region.place([1000.5, -2000.0, 0.25]);
        assert_eq!((place, moved), ([40.5, -80.0, 0.25], 0.0));
        assert!(region.place([1000.1, -2000.0, 0.25]).1 > 0.0);
    }

    #[test]
    fn the_bound_is_needed_and_holds() {
        let mut words = ChaCha8Rng::seed_from_u64(1);
        let mut random = move || words.next_u32();
        for least in [false, true] {
            let mut worst = 0.0_f64;
            for _ in 0..50_000 {
                // Sizes of 2⁻⁴⁰ to 2⁴⁰, or the smallest possible; halfway between two f32, and next
                // to halfway.
                let exponent = if least { -149 } else { (random() % 80) as i32 - 40 };
                let relative: [f64; 3] = std::array::from_fn(|_| {
                    let odd = f64::from(2 * (random() % 4) + 1)
                        + [0.0, 1e-9, -1e-9][random() as usize % 3];
                    if least { odd * exp2(-150) } else { (1.0 + odd * exp2(-24)) * exp2(exponent) }
                });
                let origin = std::array::from_fn(|_| f64::from(random() % 64) * exp2(exponent + 1));
                let t = std::array::from_fn(|i| origin[i] + relative[i]);
                let region = Region { origin, ..Region::default() };
                worst = worst.max(share(&region, t));
            }
            // √3/2 of the bound is reached.
            assert!((0.86..=1.0).contains(&worst), "{worst}, of the least: {least}");
        }
    }

    /// A body next to the local origin and far from the region's: there the rounding of f64 counts.
    #[test]
    fn the_bound_covers_both_differences() {
        let region = Region { origin: [0.999 * exp2(-23); 3], corner: [exp2(30); 3] };
        let share = share(&region, [exp2(30) + exp2(-22); 3]);
        assert!((0.86..=1.0).contains(&share), "{share}");
    }
}
