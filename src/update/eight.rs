//! Eight f64 at a time, as plain arrays: compiled inside a [`Kernel`](crate::simd::Kernel), loops
//! over them become vectors of its tier, and every lane computes what one f64 would, to the bit.

#![allow(
    clippy::needless_range_loop,
    reason = "a lane or axis is an index into several columns at once"
)]

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::rounding::pose::Real;

/// Numbers in an [`Eight`].
pub const EIGHT: usize = 8;

/// Eight f64.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub struct Eight(pub [f64; EIGHT]);

impl Eight {
    /// `x` in every lane.
    #[inline(always)]
    pub fn splat(x: f64) -> Self {
        Self([x; EIGHT])
    }

    /// Smaller lane by lane.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        let mut out = [0.0; EIGHT];
        for lane in 0..EIGHT {
            out[lane] = self.0[lane].min(other.0[lane]);
        }
        Self(out)
    }

    /// Larger lane by lane.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        let mut out = [0.0; EIGHT];
        for lane in 0..EIGHT {
            out[lane] = self.0[lane].max(other.0[lane]);
        }
        Self(out)
    }
}

// Loops and not closures: a closure is compiled without the tier's features.
macro_rules! lane_by_lane {
    ($($operator:ident, $name:ident, $sign:tt;)+) => {
        $(impl $operator for Eight {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                let mut out = [0.0; EIGHT];
                for lane in 0..EIGHT {
                    out[lane] = self.0[lane] $sign other.0[lane];
                }
                Self(out)
            }
        })+
    };
}
lane_by_lane! { Add, add, +; Sub, sub, -; Mul, mul, *; Div, div, /; }

impl Neg for Eight {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        let mut out = [0.0; EIGHT];
        for lane in 0..EIGHT {
            out[lane] = -self.0[lane];
        }
        Self(out)
    }
}

impl Real for Eight {
    #[inline(always)]
    fn like(self, x: f64) -> Self {
        Self::splat(x)
    }
}
