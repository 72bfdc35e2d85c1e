//! The scalar tier, one lane wide, and its flush-to-zero twin.
//!
//! `Scalar<true>` replaces denormal operands and results by zero (of the same sign), as a CPU does
//! with DAZ and FTZ set. Changing the CPU's own mode from Rust is undefined behaviour, so the mode
//! is emulated here for the tests.

use std::ops::{Add, BitAnd, BitOr, Mul, Sub};

use super::ROW;
use super::lanes::{Lanes, Sealed};

#[derive(Clone, Copy)]
pub struct Scalar<const FLUSH: bool>(());

#[derive(Clone, Copy)]
pub struct F1<const FLUSH: bool>(f32);

#[derive(Clone, Copy)]
pub struct M1(bool);

impl<const FLUSH: bool> Scalar<FLUSH> {
    pub(super) fn new() -> Self {
        Self(())
    }
}

impl<const FLUSH: bool> F1<FLUSH> {
    /// The value as an operation reads or leaves it.
    #[inline(always)]
    fn of(x: f32) -> Self {
        if FLUSH && x.is_subnormal() { Self(0.0f32.copysign(x)) } else { Self(x) }
    }
}

impl<const FLUSH: bool> Add for F1<FLUSH> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::of(self.0 + other.0)
    }
}

impl<const FLUSH: bool> Sub for F1<FLUSH> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::of(self.0 - other.0)
    }
}

impl<const FLUSH: bool> Mul for F1<FLUSH> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::of(self.0 * other.0)
    }
}

impl BitAnd for M1 {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

impl BitOr for M1 {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl<const FLUSH: bool> Sealed for Scalar<FLUSH> {}

impl<const FLUSH: bool> Lanes for Scalar<FLUSH> {
    const WIDTH: usize = 1;
    type F = F1<FLUSH>;
    type D = f64;
    type I = u32;
    type M = M1;

    #[inline(always)]
    fn splat(self, x: f32) -> Self::F {
        F1::of(x)
    }
    #[inline(always)]
    fn load(self, from: &[f32]) -> Self::F {
        F1::of(from[0])
    }
    #[inline(always)]
    fn store(self, v: Self::F, to: &mut [f32]) {
        to[0] = v.0;
    }
    #[inline(always)]
    fn min(self, a: Self::F, b: Self::F) -> Self::F {
        if a.0 < b.0 { a } else { b }
    }
    #[inline(always)]
    fn max(self, a: Self::F, b: Self::F) -> Self::F {
        if a.0 > b.0 { a } else { b }
    }
    #[inline(always)]
    fn abs(self, a: Self::F) -> Self::F {
        F1(a.0.abs())
    }
    #[inline(always)]
    fn flip_sign(self, a: Self::F, sign: Self::F) -> Self::F {
        F1(f32::from_bits(a.0.to_bits() ^ (sign.0.to_bits() & 0x8000_0000)))
    }
    #[inline(always)]
    fn gt(self, a: Self::F, b: Self::F) -> Self::M {
        M1(a.0 > b.0)
    }
    #[inline(always)]
    fn negative(self, a: Self::F) -> Self::M {
        M1(a.0.is_sign_negative())
    }
    #[inline(always)]
    fn select(self, m: Self::M, a: Self::F, b: Self::F) -> Self::F {
        if m.0 { a } else { b }
    }
    #[inline(always)]
    fn first(self, n: usize) -> Self::M {
        M1(n > 0)
    }
    #[inline(always)]
    fn bits(self, m: Self::M) -> u32 {
        u32::from(m.0)
    }
    #[inline(always)]
    fn splat_f64(self, x: f64) -> f64 {
        x
    }
    #[inline(always)]
    fn widen(self, a: F1<FLUSH>) -> f64 {
        f64::from(F1::<FLUSH>::of(a.0).0)
    }
    #[inline(always)]
    fn narrow(self, a: f64) -> F1<FLUSH> {
        F1::of(a as f32)
    }
    #[inline(always)]
    fn gather(self, table: &[f32], index: u32) -> Self::F {
        F1::of(table[(index as usize).min(table.len() - 1)])
    }
    #[inline(always)]
    fn lookup_16(self, table: &[f32; 16], index: u32) -> Self::F {
        F1::of(table[(index & 15) as usize])
    }
    #[inline(always)]
    fn as_u32(self, a: Self::F) -> u32 {
        a.0.to_bits()
    }
    #[inline(always)]
    fn splat_u32(self, x: u32) -> u32 {
        x
    }
    #[inline(always)]
    fn load_u32(self, from: &[u32]) -> u32 {
        from[0]
    }
    #[inline(always)]
    fn add_u32(self, a: u32, b: u32) -> u32 {
        a.wrapping_add(b)
    }
    #[inline(always)]
    fn store_u32(self, v: u32, to: &mut [u32]) {
        to[0] = v;
    }
    #[inline(always)]
    fn gt_u32(self, a: u32, b: u32) -> Self::M {
        M1(a > b)
    }
    #[inline(always)]
    fn select_u32(self, m: Self::M, a: u32, b: u32) -> u32 {
        if m.0 { a } else { b }
    }
    #[inline(always)]
    fn gather_u32(self, table: &[u32], index: u32) -> u32 {
        table[(index as usize).min(table.len() - 1)]
    }
    #[inline(always)]
    fn lookup_16_u32(self, table: &[u32; 16], index: u32) -> u32 {
        table[(index & 15) as usize]
    }
    #[inline(always)]
    fn split_u32(self, a: u32) -> (u32, u32) {
        (a >> 4, a & 15)
    }
    #[inline(always)]
    fn compress(self, keep: u32, values: u32, out: &mut [u32]) {
        if keep & 1 != 0 {
            out[0] = values;
        }
    }
    #[inline(always)]
    fn pack(self, keep: u32, values: Self::F, out: &mut [f32]) {
        if keep & 1 != 0 {
            out[0] = values.0;
        }
    }
    #[inline(always)]
    fn load_quads(self, from: &[[f32; 4]]) -> [Self::F; 4] {
        from[0].map(F1::of)
    }
    #[inline(always)]
    fn gather_quads(self, quads: &[[f32; 4]], codes: &[u32]) -> [Self::F; 4] {
        quads[((codes[0] >> 4) as usize).min(quads.len() - 1)].map(F1::of)
    }
    #[inline(always)]
    fn store_quads(self, columns: [Self::F; 4], to: &mut [[f32; 4]]) {
        to[0] = columns.map(|column| column.0);
    }
    #[inline(always)]
    fn gather_sixes(self, sixes: &[[f32; 6]], pick: &[u32]) -> [Self::F; 6] {
        sixes[(pick[0] as usize).min(sixes.len() - 1)].map(F1::of)
    }
    #[inline(always)]
    fn load_transposed(self, rows: &[[f32; ROW]], pick: &[u32]) -> [Self::F; ROW] {
        rows[(pick[0] as usize).min(rows.len() - 1)].map(F1::of)
    }
}
