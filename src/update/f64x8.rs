//! [`F64x8`]: eight f64 as a plain array. Inside a [`Kernel`](crate::simd::Kernel), loops over it
//! are compiled to vectors of the tier, and every lane computes what one f64 would, to the bit.

#![allow(
    clippy::needless_range_loop,
    reason = "a lane or axis is an index into several columns at once"
)]

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::rounding::pose::Real;

/// Numbers in an [`F64x8`].
pub const LANES: usize = 8;

/// Eight f64.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub struct F64x8(pub [f64; LANES]);

/// A loop, because closures are compiled without the tier's features.
macro_rules! each_lane {
    ($lane:ident => $value:expr) => {{
        let mut out = [0.0; LANES];
        for $lane in 0..LANES {
            out[$lane] = $value;
        }
        Self(out)
    }};
}

impl F64x8 {
    /// `x` in every lane.
    #[inline(always)]
    pub fn splat(x: f64) -> Self {
        Self([x; LANES])
    }

    /// The smaller number in each lane.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        each_lane!(lane => self.0[lane].min(other.0[lane]))
    }

    /// The larger number in each lane.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        each_lane!(lane => self.0[lane].max(other.0[lane]))
    }
}

macro_rules! lane_by_lane {
    ($($operator:ident, $name:ident, $sign:tt;)+) => {
        $(impl $operator for F64x8 {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                each_lane!(lane => self.0[lane] $sign other.0[lane])
            }
        })+
    };
}
lane_by_lane! { Add, add, +; Sub, sub, -; Mul, mul, *; Div, div, /; }

impl Neg for F64x8 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        each_lane!(lane => -self.0[lane])
    }
}

impl Real for F64x8 {
    #[inline(always)]
    fn like(self, x: f64) -> Self {
        Self::splat(x)
    }
}
