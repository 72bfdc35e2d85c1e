//! Periodic axes: wraps positions into one period, and compares ends of boxes across it, without an
//! error.
//!
//! The remainder of a division is an f64 itself, so [`wrap`] rounds nothing. A sum with a multiple
//! of the period may be rounded, and [`shifted`] returns a bound. A comparison with one
//! ([`is_within`]) needs no bound: both sides are sums of two numbers of which the larger is the
//! rounded sum, and since rounding keeps order, the larger numbers decide unless they are equal.
//! Then the smaller ones do. Theorem I of `paper/proofs/LEMMAS.md`.

use super::{exp2, two_sum};

/// 2⁻⁵⁶ and 2⁵⁶: the shortest and the longest period. Then neither products of whole numbers and a
/// period nor their rounding errors underflow or overflow.
pub const PERIOD_LIMITS: [f64; 2] = [exp2(-56), exp2(56)];

/// 2²⁸: no position is farther from the origin in periods, so that differences of such numbers, and
/// a few periods more, are an `i32`.
pub const MOST_PERIODS: f64 = exp2(28);

/// 2⁻⁵²: the error of [`shifted`], in periods and per period that it shifts by, and one more. With
/// ε = 2⁻⁵³, the product n·p is off by ε|n|p at most, the sum of that and |x| ≤ p/2 by ε(|n| + ½ +
/// ε|n|)p.
pub const SHIFT_ERROR: f64 = exp2(-52);

/// x as rest + n·period, without an error: n is whole, and |rest| is at most half of the period.
/// |x| is at most [`MOST_PERIODS`] periods.
#[must_use]
pub fn wrap(x: f64, period: f64) -> (f64, i32) {
    let half = 0.5 * period;
    if x.abs() <= half {
        return (x, 0);
    }
    let rest = x % period;
    let rest = if rest > half {
        rest - period
    } else if rest < -half {
        rest + period
    } else {
        rest
    };
    (rest, ((x - rest) / period).round() as i32)
}

/// x + n·period, and a bound of its error: 0 if nothing is rounded. |x| is at most half of the
/// period.
#[must_use]
pub fn shifted(x: f64, n: i32, period: f64) -> (f64, f64) {
    if n == 0 {
        return (x, 0.0);
    }
    let n = f64::from(n);
    let way = n * period;
    let sum = x + way;
    if n.mul_add(period, -way) == 0.0 && two_sum(x, way).1 == 0.0 {
        return (sum, 0.0);
    }
    (sum, SHIFT_ERROR * (n.abs() + 1.0) * period)
}

/// Whether lo ≤ hi + n·period, in exact arithmetic.
#[inline]
#[must_use]
pub fn is_within(lo: f64, hi: f64, n: i32, period: f64) -> bool {
    if n == 0 {
        return lo <= hi;
    }
    let n = f64::from(n);
    let (gap, way) = (lo - hi, n * period);
    if gap != way {
        return gap < way;
    }
    two_sum(lo, -hi).1 <= n.mul_add(period, -way)
}

/// Whether hi − lo is less than half of the period, in exact arithmetic.
#[must_use]
pub fn is_below_half(lo: f64, hi: f64, period: f64) -> bool {
    let twice = 2.0 * (hi - lo);
    twice < period || twice == period && two_sum(hi, -lo).1 < 0.0
}

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::*;

    /// A number in [1, 2) with all of its 53 bits.
    fn mantissa(random: &mut ChaCha8Rng) -> f64 {
        f64::from_bits((random.next_u64() >> 12) | 0x3ff0_0000_0000_0001)
    }

    /// x as a whole number of 2⁻⁵².
    fn whole(x: f64) -> i128 {
        let units = x * exp2(52);
        assert_eq!(units, units.trunc());
        units as i128
    }

    #[test]
    fn wrapped_positions_are_exact() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        for step in 0..100_000 {
            let period = mantissa(&mut random);
            let x = (mantissa(&mut random) - 1.5) * exp2(step % 29);
            let (rest, n) = wrap(x, period);
            assert!(rest.abs() <= 0.5 * period, "{x} {period}");
            assert_eq!(whole(x), whole(rest) + i128::from(n) * whole(period), "{x} {period}");
        }
        // The border belongs to both sides, and stays where it is.
        assert_eq!([wrap(1.5, 3.0), wrap(-1.5, 3.0)], [(1.5, 0), (-1.5, 0)]);
        assert_eq!([wrap(4.5, 3.0), wrap(-4.5, 3.0)], [(1.5, 1), (-1.5, -1)]);
        assert_eq!(wrap(MOST_PERIODS * 3.0, 3.0), (0.0, 1 << 28));
    }

    /// The bound holds, comes close, and is 0 exactly where nothing is rounded.
    #[test]
    fn shifts_are_within_their_bound() {
        let mut random = ChaCha8Rng::seed_from_u64(2);
        let (mut worst, mut exact) = (0.0_f64, 0);
        for _ in 0..100_000 {
            let period = mantissa(&mut random);
            let x = (mantissa(&mut random) - 1.5) * period;
            let x = (x * exp2(52)).round() * exp2(-52);
            let n = (random.next_u64() % 9) as i32 - 4;
            let (sum, bound) = shifted(x, n, period);
            let way = whole(f64::from(n) * period);
            // Two errors may cancel each other; then the bound is not 0 although the sum is exact.
            let of_product = way - i128::from(n) * whole(period);
            let of_sum = whole(sum) - whole(x) - way;
            let is_exact = of_product == 0 && of_sum == 0;
            assert_eq!(bound == 0.0, is_exact, "{x} {n} {period}");
            exact += usize::from(is_exact);
            let off = (of_product + of_sum).abs();
            if bound > 0.0 {
                worst = worst.max(off as f64 * exp2(-52) / bound);
            }
        }
        assert!((0.3..=1.0).contains(&worst), "{worst}");
        assert!((10_000..90_000).contains(&exact), "{exact}");
    }

    /// Ends that touch, and ends that are apart by less than an f64 can show.
    #[test]
    fn comparisons_are_exact() {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let (mut equal, mut touching) = (0, 0);
        for _ in 0..200_000 {
            let period = mantissa(&mut random);
            let hi = mantissa(&mut random);
            let n = (random.next_u64() % 99) as i32 - 49;
            let near = hi + f64::from(n) * period;
            let lo = near + (random.next_u64() % 3) as f64 * exp2(-52) - exp2(-52);
            let gap = whole(lo) - whole(hi) - i128::from(n) * whole(period);
            assert_eq!(is_within(lo, hi, n, period), gap <= 0, "{lo} {hi} {n}");
            equal += usize::from(lo - hi == f64::from(n) * period && gap != 0);
            touching += usize::from(gap == 0);
        }
        assert!(equal > 1000 && touching > 1000, "{equal} {touching}");
    }

    #[test]
    fn half_a_period_is_too_much() {
        assert!(
            !is_below_half(-0.75, 0.75, 3.0) && is_below_half(-0.75, 0.75_f64.next_down(), 3.0)
        );
        // One less than ½ by 2⁻⁶⁰, which no f64 near 1 shows.
        assert!(is_below_half(exp2(-60), 0.5, 1.0) && !is_below_half(-exp2(-60), 0.5, 1.0));
    }
}
