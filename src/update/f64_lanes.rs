//! [`F64Lanes`]: a vector of f64 in which every lane computes what one f64 would, to the bit.
//!
//! It uses the tier's lanes, not arrays of numbers. The compiler vectorises arrays as it likes and,
//! where a formula has sums and differences of the same products, mixes lanes of different bodies.

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::rounding::pose::Real;
use crate::simd::Lanes;

/// As many f64 as the tier's vectors have f32.
#[derive(Clone, Copy)]
pub struct F64Lanes<L: Lanes>(pub L, pub L::D);

impl<L: Lanes> F64Lanes<L> {
    /// The same numbers in f64.
    #[inline(always)]
    pub fn of(l: L, numbers: L::F) -> Self {
        Self(l, l.widen(numbers))
    }

    /// Rounded to f32.
    #[inline(always)]
    pub fn rounded(self) -> L::F {
        self.0.narrow(self.1)
    }
}

macro_rules! lane_by_lane {
    ($($operator:ident, $name:ident, $sign:tt;)+) => {
        $(impl<L: Lanes> $operator for F64Lanes<L> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self(self.0, self.1 $sign other.1)
            }
        })+
    };
}
lane_by_lane! { Add, add, +; Sub, sub, -; Mul, mul, *; Div, div, /; }

impl<L: Lanes> Neg for F64Lanes<L> {
    type Output = Self;
    /// −0 − x, which is −x for zeros too.
    #[inline(always)]
    fn neg(self) -> Self {
        self.like(-0.0) - self
    }
}

impl<L: Lanes> Real for F64Lanes<L> {
    #[inline(always)]
    fn like(self, x: f64) -> Self {
        Self(self.0, self.0.splat_f64(x))
    }
}
