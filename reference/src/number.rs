//! [`Number`]: the kinds of numbers over which formulas are written.
//!
//! A decision is the sign of a polynomial in the input. Written once over [`Number`], the same
//! polynomial is guessed in f64, bounded in intervals ([`crate::exact::interval`]) and computed
//! exactly in integers, so that the stages of the exact cascade cannot differ in the formula, only
//! in what they can decide.
//!
//! Every f32 and f64 is a dyadic rational m·2^e. [`Number::lift`] divides it by a unit 2^u that all
//! quantities of one kind (the lengths of a pair; the components of one quaternion) share. A
//! polynomial homogeneous in each kind changes by a positive factor only, so floating-point numbers
//! ignore the unit and integers stay integers.

use std::cmp::Ordering;

use dashu_int::{IBig, Sign};

/// A ring element whose sign may be known.
pub trait Number: Clone {
    /// The number x·2^(−unit), or x where a common unit does not matter.
    fn lift(x: f64, unit: i32) -> Self;
    /// A small integer, free of units.
    fn integer(n: i32) -> Self;
    /// The number x·2^(x_unit − unit), or x·2^x_unit where a common unit does not matter.
    fn lift_integer(x: &IBig, x_unit: i32, unit: i32) -> Self;
    /// Sum.
    fn plus(&self, other: &Self) -> Self;
    /// Difference.
    fn minus(&self, other: &Self) -> Self;
    /// Product.
    fn times(&self, other: &Self) -> Self;
    /// The larger of two.
    fn larger(&self, other: &Self) -> Self;
    /// The smaller of two.
    fn smaller(&self, other: &Self) -> Self;
    /// The sign against zero, `None` when this kind of number cannot tell.
    fn sign(&self) -> Option<Ordering>;
}

/// Unguarded: the sign is a guess, which the caller checks by a bound or by another kind of number.
impl Number for f64 {
    fn lift(x: f64, _unit: i32) -> Self {
        x
    }
    fn integer(n: i32) -> Self {
        Self::from(n)
    }
    fn lift_integer(x: &IBig, x_unit: i32, _unit: i32) -> Self {
        x.to_f64().value() * power_of_two(x_unit)
    }
    fn plus(&self, other: &Self) -> Self {
        self + other
    }
    fn minus(&self, other: &Self) -> Self {
        self - other
    }
    fn times(&self, other: &Self) -> Self {
        self * other
    }
    fn larger(&self, other: &Self) -> Self {
        self.max(*other)
    }
    fn smaller(&self, other: &Self) -> Self {
        self.min(*other)
    }
    fn sign(&self) -> Option<Ordering> {
        self.partial_cmp(&0.0)
    }
}

impl Number for IBig {
    fn lift(x: f64, unit: i32) -> Self {
        let (mantissa, exponent) = dyadic(x);
        if mantissa == 0 {
            return Self::ZERO;
        }
        Self::lift_integer(&Self::from(mantissa), exponent, unit)
    }
    fn integer(n: i32) -> Self {
        Self::from(n)
    }
    fn lift_integer(x: &IBig, x_unit: i32, unit: i32) -> Self {
        // A unit above the number's own would drop bits: a bug here, never a property of the data.
        let shift = usize::try_from(x_unit - unit);
        x << shift
            .unwrap_or_else(|_| unreachable!("2^{unit} does not divide a multiple of 2^{x_unit}"))
    }
    fn plus(&self, other: &Self) -> Self {
        self + other
    }
    fn minus(&self, other: &Self) -> Self {
        self - other
    }
    fn times(&self, other: &Self) -> Self {
        self * other
    }
    fn larger(&self, other: &Self) -> Self {
        self.max(other).clone()
    }
    fn smaller(&self, other: &Self) -> Self {
        self.min(other).clone()
    }
    fn sign(&self) -> Option<Ordering> {
        Some(match (self.is_zero(), self.sign()) {
            (true, _) => Ordering::Equal,
            (false, Sign::Positive) => Ordering::Greater,
            (false, Sign::Negative) => Ordering::Less,
        })
    }
}

/// A finite x as m·2^e with odd m, or (0, 0).
pub fn dyadic(x: f64) -> (i64, i32) {
    debug_assert!(x.is_finite(), "{x} is no dyadic rational");
    if x == 0.0 {
        return (0, 0);
    }
    let bits = x.to_bits();
    // 11 bits of exponent always fit an i32.
    let field = (bits >> 52 & 0x7ff) as i32;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let (mantissa, exponent) =
        if field == 0 { (fraction, -1074) } else { (fraction | 1 << 52, field - 1075) };
    let zeros = mantissa.trailing_zeros();
    let odd = mantissa >> zeros;
    (if x < 0.0 { -odd } else { odd }, exponent + zeros as i32)
}

/// The largest u such that every number is a multiple of 2^u; 0 when all are zero.
pub fn unit_of(numbers: impl IntoIterator<Item = f64>) -> i32 {
    let units = numbers.into_iter().filter(|x| *x != 0.0).map(|x| dyadic(x).1);
    units.min().unwrap_or(0)
}

/// 2^e for an exponent in f64's normal range.
pub fn power_of_two(e: i32) -> f64 {
    debug_assert!((-1022..=1023).contains(&e), "2^{e} is not a normal f64");
    f64::from_bits(((e + 1023) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_float_is_its_dyadic_parts() {
        for x in
            [1.0, -0.75, 5e-324, f64::MIN_POSITIVE, f64::MAX, f64::from(f32::MIN_POSITIVE) / 3.0]
        {
            let (m, e) = dyadic(x);
            assert_ne!(m % 2, 0, "{x}");
            // Two steps, as 2^e alone may leave the range.
            let half = power_of_two(e / 2);
            assert_eq!(m as f64 * half * power_of_two(e - e / 2), x);
        }
        assert_eq!(dyadic(-0.0), (0, 0));
    }

    #[test]
    fn integers_share_the_unit() {
        let numbers = [0.375, -6.0, 0.0, 1.0];
        let unit = unit_of(numbers);
        assert_eq!(unit, -3);
        let lifted = numbers.map(|x| IBig::lift(x, unit));
        assert_eq!(lifted, [3, -48, 0, 8].map(IBig::from));
    }
}
