//! Intervals of f64 with outward rounding: the middle of the cascade.
//!
//! Each bound is the result of one rounded operation, moved outward to the next float, so the true
//! result lies between the bounds whatever rounding, underflow or overflow did. Where a bound would
//! be NaN the interval is the whole line, which has no sign.

use std::cmp::Ordering;

use dashu_int::IBig;
use dashu_int::ops::BitTest;

use crate::number::{Number, power_of_two};

/// All reals x with lo ≤ x ≤ hi; never NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    lo: f64,
    hi: f64,
}

impl Interval {
    const WHOLE: Self = Self { lo: f64::NEG_INFINITY, hi: f64::INFINITY };

    /// The interval of one finite number.
    pub fn point(x: f64) -> Self {
        Self::ordered(x, x)
    }

    /// An interval about an integer: the number itself when f64 holds it.
    pub fn enclosing(x: &IBig) -> Self {
        let significant = x.bit_len() - x.trailing_zeros().unwrap_or(0);
        let nearest = x.to_f64().value();
        if significant <= 53 { Self::point(nearest) } else { Self::outward(nearest, nearest) }
    }

    /// The lower end.
    pub fn lo(&self) -> f64 {
        self.lo
    }

    /// The upper end.
    pub fn hi(&self) -> f64 {
        self.hi
    }

    fn ordered(lo: f64, hi: f64) -> Self {
        if lo <= hi { Self { lo, hi } } else { Self::WHOLE }
    }

    fn outward(lo: f64, hi: f64) -> Self {
        Self::ordered(lo.next_down(), hi.next_up())
    }
}

impl Number for Interval {
    fn lift(x: f64, _unit: i32) -> Self {
        Self::point(x)
    }

    fn integer(n: i32) -> Self {
        Self::point(f64::from(n))
    }

    fn lift_integer(x: &IBig, x_unit: i32, _unit: i32) -> Self {
        // A power of two of an f32's size: the product is exact.
        let Self { lo, hi } = Self::enclosing(x);
        Self::ordered(lo * power_of_two(x_unit), hi * power_of_two(x_unit))
    }

    fn plus(&self, other: &Self) -> Self {
        Self::outward(self.lo + other.lo, self.hi + other.hi)
    }

    fn minus(&self, other: &Self) -> Self {
        Self::outward(self.lo - other.hi, self.hi - other.lo)
    }

    fn times(&self, other: &Self) -> Self {
        let [a, b, c, d] =
            [self.lo * other.lo, self.lo * other.hi, self.hi * other.lo, self.hi * other.hi];
        // 0·∞ is a NaN, which min and max drop: the products that remain hold its 0, or none does
        // and all is unknown.
        Self::outward(a.min(b).min(c.min(d)), a.max(b).max(c.max(d)))
    }

    fn larger(&self, other: &Self) -> Self {
        Self { lo: self.lo.max(other.lo), hi: self.hi.max(other.hi) }
    }

    fn smaller(&self, other: &Self) -> Self {
        Self { lo: self.lo.min(other.lo), hi: self.hi.min(other.hi) }
    }

    fn sign(&self) -> Option<Ordering> {
        match (self.lo, self.hi) {
            (lo, _) if lo > 0.0 => Some(Ordering::Greater),
            (_, hi) if hi < 0.0 => Some(Ordering::Less),
            (lo, hi) if lo == 0.0 && hi == 0.0 => Some(Ordering::Equal),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::number::{dyadic, unit_of};

    #[test]
    fn indeterminate_products_are_unknown() {
        let huge = Interval::point(1e300);
        let infinite = huge.times(&huge);
        assert_eq!(infinite.sign(), Some(Ordering::Greater));
        assert_eq!(infinite.minus(&infinite).sign(), None);
        assert_eq!(infinite.minus(&infinite).times(&Interval::point(0.0)).sign(), None);
        assert_eq!(Interval::point(1e-300).times(&Interval::point(1e-300)).sign(), None);
        assert_eq!(Interval::point(0.0).sign(), Some(Ordering::Equal));
    }

    fn holds(interval: Interval, exact: &IBig, unit: i32) -> bool {
        let below = |x: f64, than: &IBig| {
            let (mantissa, exponent) = dyadic(x);
            match usize::try_from(exponent - unit) {
                Ok(shift) => (IBig::from(mantissa) << shift) <= *than,
                Err(_) => {
                    IBig::from(mantissa) <= than << usize::try_from(unit - exponent).unwrap_or(0)
                }
            }
        };
        below(interval.lo, exact) && below(-interval.hi, &-exact)
    }

    /// An interval, and of its members the two finite ends and one between.
    fn intervals() -> impl Strategy<Value = (Interval, [f64; 3])> {
        let end =
            prop_oneof![1 => Just(0.0), 9 => -2.0..2.0f64, 1 => Just(-1e300), 1 => Just(1e300)];
        let open = prop_oneof![9 => Just(0.0), 1 => Just(f64::INFINITY)];
        (end.clone(), end, open.clone(), open, 0.0..1.0f64).prop_map(
            |(x, y, below, above, share)| {
                let (lo, hi) = (x.min(y) - below, x.max(y) + above);
                let (from, to) = (lo.clamp(-1e307, 1e307), hi.clamp(-1e307, 1e307));
                let between = (from + share * (to - from)).clamp(from, to);
                (Interval { lo, hi }, [from, between, to])
            },
        )
    }

    proptest! {
        #[test]
        fn results_hold_every_member((a, xs) in intervals(), (b, ys) in intervals()) {
            let within = |i: Interval, z: f64| i.lo <= z && z <= i.hi;
            for (x, y) in xs.into_iter().flat_map(|x| ys.map(|y| (x, y))) {
                prop_assert!(within(a.times(&b), x * y), "{:?} {:?} {} {}", a, b, x, y);
                prop_assert!(within(a.minus(&b), x - y) && within(a.plus(&b), x + y));
                prop_assert!(within(a.larger(&b), x.max(y)) && within(a.smaller(&b), x.min(y)));
            }
        }

        #[test]
        fn the_exact_value_is_inside(x in prop::array::uniform4(-1e9f32..1e9f32), scale in -60i32..60) {
            let x = x.map(|x| f64::from(x) * 2f64.powi(scale));
            let unit = unit_of(x);
            fn formula<N: Number>(x: &[N; 4]) -> N {
                x[0].times(&x[1]).minus(&x[2].times(&x[3])).plus(&x[1].times(&x[2])).times(&x[0])
            }
            let interval = formula(&x.map(Interval::point));
            let exact = formula(&x.map(|x| IBig::lift(x, unit)));
            prop_assert!(holds(interval, &exact, 3 * unit), "{:?} {}", interval, exact);
        }
    }
}
