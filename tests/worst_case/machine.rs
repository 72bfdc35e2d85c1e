//! f32 as a CPU computes it: denormals kept, or read and written as zero (software DAZ and FTZ).
//! Written apart from the culler's own emulation, so that each checks the other.

use std::ops::{Add, Mul, Neg, Sub};

#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct F<const FLUSH: bool>(f32);

impl<const FLUSH: bool> F<FLUSH> {
    pub const ZERO: Self = Self(0.0);

    pub fn new(x: f32) -> Self {
        if FLUSH && x.abs() < f32::MIN_POSITIVE { Self(0.0f32.copysign(x)) } else { Self(x) }
    }
    pub fn get(self) -> f32 {
        self.0
    }
    pub fn real(self) -> f64 {
        f64::from(self.0)
    }
    pub fn abs(self) -> Self {
        Self(self.0.abs())
    }
    pub fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    pub fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    /// Sign bit flipped where that of `sign` is set.
    pub fn flip(self, sign: Self) -> Self {
        if sign.0.is_sign_negative() { -self } else { self }
    }
}

macro_rules! operator {
    ($($trait:ident $method:ident $sign:tt)*) => {$(
        impl<const FLUSH: bool> $trait for F<FLUSH> {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Self::new(self.0 $sign other.0)
            }
        }
    )*};
}
operator!(Add add + Sub sub - Mul mul *);

impl<const FLUSH: bool> Neg for F<FLUSH> {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}
