//! Skins: how far a ball may drift before a list of neighbours must be built again.
//!
//! A list holds the pairs that come within reach while each ball's drift, the distance that its
//! centre has moved plus what its radius has grown since, is at most its budget B. The drift is
//! measured in f32 and compared with the skin s = max(fl(Rσ), a): a share σ of the radius, or the
//! same length a ≥ 2⁻⁶⁰ for all balls. Rounding may hide a little more drift than s, so the budget
//! is B = s(1 + 32u) + 2⁻⁶⁰. The bound holds for the order of operations in [`stays`]. A list is
//! made of balls grown by [`Reach`].

use super::{U, exp2};
use crate::simd::Lanes;

/// 1 + 32u ≥ 1 + 17u + …: what a measured drift below the skin may be in truth, at most. Proof:
/// `skin.g`.
pub const SKIN_FACTOR: f64 = 1.0 + 32.0 * U;

/// 2⁻⁶⁰: the least skin, whose square underflow cannot take, and as much again for the squares that
/// it can. Proof: `skin.g`.
pub const SKIN_FLOOR: f64 = exp2(-60);

/// 1 + 64u, by which grown radii exceed (1 + σ)R: the finder's widening, the budget and the sphere
/// test's own margin together need 47u. Proof: `skin_reach.g`.
pub const REACH_FACTOR: f64 = 1.0 + 64.0 * U;

/// 2⁻⁵⁶: the same for the floors. Proof: `skin_reach.g`.
pub const REACH_FLOOR: f64 = exp2(-56);

/// How far a ball may drift: a share of its radius, but no less than a length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Skin {
    share: f32,
    least: f32,
}

impl Skin {
    /// A share of each ball's radius.
    #[must_use]
    pub fn share(share: f32) -> Self {
        let least = SKIN_FLOOR as f32;
        Self { share, least }
    }

    /// The same length for all balls.
    #[must_use]
    pub fn length(length: f32) -> Self {
        let least = length.max(SKIN_FLOOR as f32);
        Self { share: 0.0, least }
    }

    /// The skin of a ball.
    #[inline(always)]
    #[must_use]
    pub fn of(self, radius: f32) -> f32 {
        (radius * self.share).max(self.least)
    }

    /// The skins of balls.
    #[inline(always)]
    fn of_lanes<L: Lanes>(self, l: L, radii: L::F) -> L::F {
        l.max(radii * l.splat(self.share), l.splat(self.least))
    }
}

/// Whether each ball (x, y, z, R) has drifted by less than its skin since it was `then`: the sum of
/// squares of the coordinates' differences is below the square of what growth has left of the skin.
/// NaN has drifted.
#[inline(always)]
pub fn stays<L: Lanes>(l: L, skin: Skin, now: [L::F; 4], then: [L::F; 4]) -> L::M {
    let skin = skin.of_lanes(l, then[3]);
    let grown = l.max(now[3] - then[3], l.splat(0.0));
    let left = l.max(skin - grown, l.splat(0.0));
    let [dx, dy, dz] = [now[0] - then[0], now[1] - then[1], now[2] - then[2]];
    l.gt(left * left, (dx * dx + dy * dy) + dz * dz)
}

/// How radii grow before neighbours are looked for: fl(fl(R·factor) + floor).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    factor: f32,
    floor: f32,
}

impl Reach {
    /// Radii as they are.
    pub const NONE: Self = Self { factor: 1.0, floor: 0.0 };

    /// By a skin: the sphere test of balls so grown loses no pair of balls that may be reported
    /// within their budgets.
    #[must_use]
    pub fn with_skin(skin: Skin) -> Self {
        let [share, least] = [skin.share, skin.least].map(f64::from);
        Self {
            factor: ((1.0 + share) * REACH_FACTOR) as f32,
            floor: (least * REACH_FACTOR + REACH_FLOOR) as f32,
        }
    }

    /// The grown radius.
    #[inline(always)]
    #[must_use]
    pub fn of(self, radius: f32) -> f32 {
        radius * self.factor + self.floor
    }

    /// The grown radii.
    #[inline(always)]
    pub fn of_lanes<L: Lanes>(self, l: L, radii: L::F) -> L::F {
        radii * l.splat(self.factor) + l.splat(self.floor)
    }
}

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::*;
    use crate::simd::{Kernel, Tier, dispatch};

    struct CompareDrift {
        skin: Skin,
        now: [f32; 4],
        then: [f32; 4],
    }

    impl Kernel for CompareDrift {
        type Output = bool;
        #[inline(always)]
        fn run<L: Lanes>(self, l: L) -> bool {
            let [now, then] = [self.now, self.then].map(|ball| ball.map(|x| l.splat(x)));
            l.bits(stays(l, self.skin, now, then)) & 1 == 1
        }
    }

    fn stays_in(tier: Tier, skin: Skin, now: [f32; 4], then: [f32; 4]) -> bool {
        dispatch(tier, CompareDrift { skin, now, then })
    }

    /// Numbers in [0, 1), the same ones each time.
    fn numbers() -> impl Iterator<Item = f64> {
        let mut random = ChaCha8Rng::seed_from_u64(7);
        std::iter::repeat_with(move || (random.next_u64() >> 11) as f64 * exp2(-53))
    }

    /// Radii grow by the skin and what rounding needs.
    #[test]
    fn radii_grow_by_skin_and_rounding() {
        let shares = [0.0, 0.0625, 0.25, 0.375].map(|share| (Skin::share(share), share, 0.0));
        let lengths = [1e-9, 0.5, 40.0].map(|length| (Skin::length(length), 0.0, length));
        for (skin, share, length) in shares.into_iter().chain(lengths) {
            let grown = Reach::with_skin(skin);
            let [share, length] = [share, length].map(f64::from);
            for radius in [0.0, exp2(-40) as f32, 0.3, 1.7, 2.5e9] {
                let skin_of_zero = length.max(SKIN_FLOOR);
                let exact = (f64::from(radius) * (1.0 + share) + skin_of_zero) * REACH_FACTOR;
                let off = f64::from(grown.of(radius)) / (exact + REACH_FLOOR) - 1.0;
                // Three roundings of f32.
                assert!(off.abs() <= 3.1 * U, "{skin:?}, {radius}: {off}");
            }
        }
        assert_eq!(Reach::NONE.of(0.3), 0.3);
    }

    /// Drifts about as long as the skin, in any direction, with or without growth: whatever passes
    /// is within the budget, and some of it is beyond the skin.
    #[test]
    fn what_passes_is_within_the_budget() {
        let mut numbers = numbers();
        let mut next = || numbers.next().unwrap_or(0.0);
        for tier in Tier::available() {
            let mut beyond = 0;
            for n in 0..40_000 {
                let (share, radius) = (0.25, (0.5 + next()) as f32 * exp2(n % 61 - 30) as f32);
                let skin = (radius * share).max(SKIN_FLOOR as f32);
                let grown = match n % 3 {
                    0 => 0.0,
                    1 => next(),
                    _ => -next(),
                };
                let left = f64::from(skin) * (1.0 - f64::max(grown, 0.0));
                let direction = [next() - 0.5, next() - 0.5, next() - 0.5];
                let length = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
                let drift = left * (1.0 + 24.0 * U * (next() - 0.5)) / length;
                let then = [0.0, radius, -radius, radius];
                let moved = [0, 1, 2].map(|k| (f64::from(then[k]) + drift * direction[k]) as f32);
                let now_radius = (f64::from(radius) + f64::from(skin) * grown) as f32;
                let now = [moved[0], moved[1], moved[2], now_radius];
                // The same skin as a share and as a length.
                let skin_is = [Skin::share(share), Skin::length(skin)][n as usize / 3 % 2];
                if stays_in(tier, skin_is, now, then) {
                    let d = [0, 1, 2].map(|k| f64::from(now[k]) - f64::from(then[k]));
                    let drift = d.iter().map(|x| x * x).sum::<f64>().sqrt();
                    let growth = f64::from(now_radius) - f64::from(radius);
                    let widened = growth.max(0.0) * (1.0 + 16.0 * U);
                    let budget = f64::from(skin) * SKIN_FACTOR + SKIN_FLOOR;
                    assert!(drift + widened <= budget, "{tier}: {then:?} to {now:?}");
                    beyond += u32::from(drift + widened > f64::from(skin));
                }
            }
            assert!(beyond > 0, "{tier}: no drift beyond the skin passes");
        }
    }

    /// A drift of the skin is too long and one unit less is not.
    #[test]
    fn skin_drift_limit_is_exact() {
        let then = [3.0, -2.0, 5.0, 1.0];
        for tier in Tier::available() {
            for skin in [Skin::share(0.25), Skin::length(0.25)] {
                let to = |x: f32, radius: f32| stays_in(tier, skin, [x, -2.0, 5.0, radius], then);
                let below = 3.25f32.next_down();
                assert!(to(3.0, 1.0) && to(below, 1.0) && to(below, 0.1));
                assert!(!to(3.25, 1.0) && !to(3.25f32.next_up(), 1.0) && !to(2.75, 0.1));
                assert!(to(3.125f32.next_down(), 1.125) && !to(3.125, 1.125) && !to(3.0, 1.25));
                assert!(!to(3.0, 7.0), "growth beyond the skin leaves nothing of it");
                assert!(!to(f32::NAN, 1.0) && !to(f32::INFINITY, 1.0) && !to(1e30, 1.0));
            }
        }
    }

    /// Tiny balls have a skin that underflow cannot take.
    #[test]
    fn tiny_balls_keep_a_skin() {
        let then = [0.0, 0.0, 0.0, exp2(-70) as f32];
        for tier in Tier::available() {
            for skin in [Skin::share(0.25), Skin::length(0.0), Skin::length(f32::NAN)] {
                let to = |x: f64| stays_in(tier, skin, [0.0, x as f32, 0.0, then[3]], then);
                assert!(to(0.0) && to(exp2(-126)) && to(exp2(-61)) && !to(exp2(-60)));
            }
        }
    }
}
