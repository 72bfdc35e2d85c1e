//! A vector of f64 in the formulas of a pose: every lane computes what one f64 would, to the bit.
//!
//! Lanes of a tier and not arrays of numbers: of arrays, the compiler makes vectors of its own
//! choice, and where a formula has sums and differences of the same products it mixes lanes of
//! different bodies.

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::rounding::pose::Real;
use crate::simd::Lanes;

/// As many f64 as the tier has f32.
#[derive(Clone, Copy)]
pub struct Wide<L: Lanes>(pub L, pub L::D);

impl<L: Lanes> Wide<L> {
    /// The same numbers.
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
        $(impl<L: Lanes> $operator for Wide<L> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self(self.0, self.1 $sign other.1)
            }
        })+
    };
}
lane_by_lane! { Add, add, +; Sub, sub, -; Mul, mul, *; Div, div, /; }

impl<L: Lanes> Neg for Wide<L> {
    type Output = Self;
    /// −0 − x, which is −x for zeros too.
    #[inline(always)]
    fn neg(self) -> Self {
        self.like(-0.0) - self
    }
}

impl<L: Lanes> Real for Wide<L> {
    #[inline(always)]
    fn like(self, x: f64) -> Self {
        Self(self.0, self.0.splat_f64(x))
    }
}
