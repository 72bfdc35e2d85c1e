//! Large worlds: f64 translations, culled as f32 about a local origin.
//!
//! t − origin rounds twice, to f64 and to f32, so its distance from the exact one is at most √3·|t − origin|∞·2⁻²⁴ and a
//! little; half as much again in the bound covers the little. The bound joins the body's margin, so volumes at the rounded
//! place contain what the exact mesh occupies. A translation that is an f32 from the start is left as it is, without a
//! bound, as long as the origin is the world's own.

use crate::rounding::{LIMIT, exp2};

/// √3·2⁻²⁴ < 2⁻²³: how far a body is moved by rounding, as a multiple of |t − origin|∞.
const MOVED: f64 = exp2(-23);

/// √3·2⁻¹⁵⁰ < 2⁻¹⁴⁹: the same where f32 underflows.
const MOVED_LEAST: f64 = exp2(-149);

/// The origin about which translations are f32.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Local {
    pub origin: [f64; 3],
}

impl Local {
    /// The local translation, and how far from the exact one it may be.
    pub fn place(&self, t: [f64; 3]) -> ([f32; 3], f64) {
        let relative: [f64; 3] = std::array::from_fn(|i| t[i] - self.origin[i]);
        let local = relative.map(|x| x as f32);
        if self.origin == [0.0; 3] && local.map(f64::from) == t {
            return (local, 0.0);
        }
        let farthest = relative.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        (local, farthest * MOVED + MOVED_LEAST)
    }

    /// Whether translations are within the contract here.
    pub fn reaches(&self, t: [f64; 3]) -> bool {
        (0..3).all(|i| (t[i] - self.origin[i]).abs() <= f64::from(LIMIT))
    }

    /// The middle of the bodies when it lies so far out that a move there at least halves their distances and some of them
    /// had to be rounded; otherwise as before.
    pub fn follow(self, translations: impl Iterator<Item = [f64; 3]> + Clone) -> Self {
        if translations.clone().all(|t| self.place(t).1 == 0.0) {
            return self;
        }
        let (mut lo, mut hi) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for t in translations {
            for axis in 0..3 {
                lo[axis] = lo[axis].min(t[axis]);
                hi[axis] = hi[axis].max(t[axis]);
            }
        }
        let middle: [f64; 3] = std::array::from_fn(|i| 0.5 * lo[i] + 0.5 * hi[i]);
        let half = (0..3).fold(0.0, |m: f64, i| m.max(0.5 * hi[i] - 0.5 * lo[i]));
        let away = (0..3).fold(0.0, |m: f64, i| m.max((middle[i] - self.origin[i]).abs()));
        if away > half {
            Self { origin: middle }
        } else {
            self
        }
    }
}

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::*;

    #[test]
    fn f32_translations_stay_as_they_are() {
        let far = [[1.0e9, -3.5, 0.0], [1.0e9 + 64.0, 7.25, 2.0f64.powi(-149)]];
        let local = Local::default().follow(far.into_iter());
        assert_eq!(local, Local::default());
        assert_eq!(local.place(far[0]), ([1.0e9, -3.5, 0.0], 0.0));
    }

    #[test]
    fn the_origin_follows_bodies_that_f32_cannot_place() {
        let far = [[1.0e9 + 0.1, 0.0, 0.0], [1.0e9 + 8.3, 1.0, 0.0]];
        let local = Local::default().follow(far.into_iter());
        assert!((local.origin[0] - 1.0e9).abs() < 8.0);
        // 5 away instead of 10⁹: rounded by less than 2⁻²⁰ instead of by 100.
        assert!(local.place(far[0]).1 < 1.0e-6 && Local::default().place(far[0]).1 > 100.0);
        assert_eq!(local.follow(far.into_iter()), local, "and stays with them");
    }

    /// A translation along one axis.
    fn along(axis: usize, x: f64) -> [f64; 3] {
        std::array::from_fn(|i| if i == axis { x } else { 0.0 })
    }

    #[test]
    fn the_origin_moves_only_where_that_halves_the_distances() {
        // No f32: they step by 128 here.
        let s = f64::from(1 << 30) + 2.0;
        let around = [(0.0, s, false), (-s, 2.0 * s, false), (s, 3.0 * s, true)];
        for (lo, hi, moves) in around {
            for axis in 0..3 {
                let bodies = [lo, hi].map(|x| along(axis, x));
                let local = Local::default().follow(bodies.into_iter());
                let middle = if moves { 0.5 * (lo + hi) } else { 0.0 };
                assert_eq!(local.origin, along(axis, middle), "{lo} to {hi}");
            }
        }
        let local = Local {
            origin: along(1, s),
        };
        let bodies = [s - 3.3, s + 4.1].map(|y| along(1, y));
        assert_eq!(local.follow(bodies.into_iter()), local, "it is near enough");
    }

    #[test]
    fn the_contract_ends_at_its_limit_from_the_origin() {
        let (limit, step) = (f64::from(LIMIT), f64::from(LIMIT) * f64::EPSILON);
        for axis in 0..3 {
            let local = Local {
                origin: along(axis, 2.0 * limit),
            };
            for (x, within) in [(1.0, true), (3.0, true), (0.0, false), (4.0, false)] {
                assert_eq!(local.reaches(along(axis, x * limit)), within, "{x}");
            }
            assert!(!local.reaches(along(axis, limit - step)));
        }
    }

    #[test]
    fn the_bound_covers_the_worst_rounding() {
        let local = Local {
            origin: [0.3, -7.1, 1.0e5],
        };
        // Half an ulp off in every coordinate.
        let t = [0.3, -7.1, 1.0e5].map(|o| o + 1.0 + 2.0f64.powi(-24));
        let (placed, bound) = local.place(t);
        let moved = (0..3)
            .map(|i| (t[i] - local.origin[i] - f64::from(placed[i])).powi(2))
            .sum::<f64>()
            .sqrt();
        assert!(moved > 0.5 * bound && moved <= bound, "{moved:e} {bound:e}");
    }

    /// How far rounding moves a body, exactly but for 2⁻⁵⁰ of it, as a share of the bound.
    fn share(local: &Local, t: [f64; 3]) -> f64 {
        let (placed, bound) = local.place(t);
        let moved = |i: usize| {
            // Knuth's two-sum: t − origin = sum + lost.
            let (a, b) = (t[i], -local.origin[i]);
            let sum = a + b;
            let of_b = sum - a;
            let lost = (a - (sum - of_b)) + (b - of_b);
            (f64::from(placed[i]) - sum) - lost
        };
        assert!(bound > 0.0);
        let sum: f64 = (0..3).map(|i| (moved(i) / bound).powi(2)).sum();
        sum.sqrt()
    }

    #[test]
    fn no_translation_is_moved_farther_than_the_bound_and_some_nearly_as_far() {
        let mut words = ChaCha8Rng::seed_from_u64(1);
        let mut random = move || words.next_u32();
        for least in [false, true] {
            let mut worst = 0.0_f64;
            for _ in 0..50_000 {
                // Sizes of 2⁻⁴⁰ to 2⁴⁰, or the smallest there are; halfway between two f32, and next to halfway.
                let exponent = if least {
                    -149
                } else {
                    (random() % 80) as i32 - 40
                };
                let relative: [f64; 3] = std::array::from_fn(|_| {
                    let odd = f64::from(2 * (random() % 4) + 1)
                        + [0.0, 1e-9, -1e-9][random() as usize % 3];
                    if least {
                        odd * exp2(-150)
                    } else {
                        (1.0 + odd * exp2(-24)) * exp2(exponent)
                    }
                });
                let origin = std::array::from_fn(|_| f64::from(random() % 64) * exp2(exponent + 1));
                let t = std::array::from_fn(|i| origin[i] + relative[i]);
                worst = worst.max(share(&Local { origin }, t));
            }
            // √3/2 of the bound is reached.
            assert!(
                (0.86..=1.0).contains(&worst),
                "{worst}, of the least: {least}"
            );
        }
    }
}
