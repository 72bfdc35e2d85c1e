//! The NEON tier of AArch64: 4 lanes. Operations for which NEON has no instruction go through
//! memory.
//!
//! `vminq`/`vmaxq` propagate NaN and order −0 below +0, so `min` and `max` are a comparison and a
//! selection instead.

use std::arch::aarch64::*;

use super::lanes::{Lanes, Sealed, double_operators, entries, float_operators, halves, pack_lanes};
use super::{Kernel, ROW};

/// Proof that the CPU has NEON.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Neon(());

#[derive(Clone, Copy)]
pub struct F4(float32x4_t);
#[derive(Clone, Copy)]
pub struct D4([float64x2_t; 2]);
#[derive(Clone, Copy)]
pub struct I4(uint32x4_t);
#[derive(Clone, Copy)]
pub struct M4(uint32x4_t);

float_operators!(F4, vaddq_f32, vsubq_f32, vmulq_f32);
double_operators!(D4, vaddq_f64, vsubq_f64, vmulq_f64, vdivq_f64);

impl std::ops::BitAnd for M4 {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        // SAFETY: a mask exists only if its token did, and the token proves NEON.
        Self(unsafe { vandq_u32(self.0, other.0) })
    }
}

impl std::ops::BitOr for M4 {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        // SAFETY: a mask exists only if its token did, and the token proves NEON.
        Self(unsafe { vorrq_u32(self.0, other.0) })
    }
}

impl Neon {
    pub(super) fn new() -> Option<Self> {
        std::arch::is_aarch64_feature_detected!("neon").then_some(Self(()))
    }

    #[inline(always)]
    fn array(self, v: I4) -> [u32; 4] {
        let mut out = [0u32; 4];
        // SAFETY: room for 4 integers is there, and the token proves NEON.
        unsafe { vst1q_u32(out.as_mut_ptr(), v.0) };
        out
    }
}

pub(super) fn run<K: Kernel>(token: Neon, kernel: K) -> K::Output {
    #[target_feature(enable = "neon")]
    fn inner<K: Kernel>(token: Neon, kernel: K) -> K::Output {
        kernel.run(token)
    }
    // SAFETY: the token proves the feature that `inner` enables.
    unsafe { inner(token, kernel) }
}

impl Sealed for Neon {}

impl Lanes for Neon {
    const WIDTH: usize = 4;
    type F = F4;
    type D = D4;
    type I = I4;
    type M = M4;

    #[inline(always)]
    fn splat(self, x: f32) -> F4 {
        // SAFETY: the token proves NEON.
        F4(unsafe { vdupq_n_f32(x) })
    }
    #[inline(always)]
    fn load(self, from: &[f32]) -> F4 {
        let from = &from[..4];
        // SAFETY: 4 floats are there, and the token proves NEON.
        F4(unsafe { vld1q_f32(from.as_ptr()) })
    }
    #[inline(always)]
    fn store(self, v: F4, to: &mut [f32]) {
        let to = &mut to[..4];
        // SAFETY: room for 4 floats is there, and the token proves NEON.
        unsafe { vst1q_f32(to.as_mut_ptr(), v.0) };
    }
    #[inline(always)]
    fn min(self, a: F4, b: F4) -> F4 {
        // SAFETY: the token proves NEON.
        F4(unsafe { vbslq_f32(vcltq_f32(a.0, b.0), a.0, b.0) })
    }
    #[inline(always)]
    fn max(self, a: F4, b: F4) -> F4 {
        // SAFETY: the token proves NEON.
        F4(unsafe { vbslq_f32(vcgtq_f32(a.0, b.0), a.0, b.0) })
    }
    #[inline(always)]
    fn abs(self, a: F4) -> F4 {
        // SAFETY: the token proves NEON.
        F4(unsafe { vabsq_f32(a.0) })
    }
    #[inline(always)]
    fn flip_sign(self, a: F4, sign: F4) -> F4 {
        // SAFETY: the token proves NEON.
        F4(unsafe {
            let bit = vandq_u32(vreinterpretq_u32_f32(sign.0), vdupq_n_u32(0x8000_0000));
            vreinterpretq_f32_u32(veorq_u32(vreinterpretq_u32_f32(a.0), bit))
        })
    }
    #[inline(always)]
    fn gt(self, a: F4, b: F4) -> M4 {
        // SAFETY: the token proves NEON.
        M4(unsafe { vcgtq_f32(a.0, b.0) })
    }
    #[inline(always)]
    fn negative(self, a: F4) -> M4 {
        // SAFETY: the token proves NEON.
        M4(unsafe { vcltzq_s32(vreinterpretq_s32_f32(a.0)) })
    }
    #[inline(always)]
    fn select(self, m: M4, a: F4, b: F4) -> F4 {
        // SAFETY: the token proves NEON.
        F4(unsafe { vbslq_f32(m.0, a.0, b.0) })
    }
    #[inline(always)]
    fn first(self, n: usize) -> M4 {
        let lane = self.load_u32(&[0, 1, 2, 3]);
        // SAFETY: the token proves NEON.
        M4(unsafe { vcltq_u32(lane.0, vdupq_n_u32(n.min(4) as u32)) })
    }
    #[inline(always)]
    fn bits(self, m: M4) -> u32 {
        let weight = self.load_u32(&[1, 2, 4, 8]);
        // SAFETY: the token proves NEON.
        unsafe { vaddvq_u32(vandq_u32(m.0, weight.0)) }
    }
    #[inline(always)]
    fn splat_f64(self, x: f64) -> D4 {
        // SAFETY: the token proves NEON.
        D4([unsafe { vdupq_n_f64(x) }; 2])
    }
    #[inline(always)]
    fn widen(self, a: F4) -> D4 {
        // SAFETY: the token proves NEON.
        D4(unsafe { [vcvt_f64_f32(vget_low_f32(a.0)), vcvt_high_f64_f32(a.0)] })
    }
    #[inline(always)]
    fn narrow(self, a: D4) -> F4 {
        let D4([low, high]) = a;
        // SAFETY: the token proves NEON.
        F4(unsafe { vcvt_high_f32_f64(vcvt_f32_f64(low), high) })
    }
    #[inline(always)]
    fn gather(self, table: &[f32], index: I4) -> F4 {
        self.load(&entries(table, self.array(index)))
    }
    #[inline(always)]
    fn lookup_16(self, table: &[f32; 16], index: I4) -> F4 {
        self.load(&self.array(index).map(|entry| table[(entry & 15) as usize]))
    }
    #[inline(always)]
    fn as_u32(self, a: F4) -> I4 {
        // SAFETY: the token proves NEON.
        I4(unsafe { vreinterpretq_u32_f32(a.0) })
    }
    #[inline(always)]
    fn splat_u32(self, x: u32) -> I4 {
        // SAFETY: the token proves NEON.
        I4(unsafe { vdupq_n_u32(x) })
    }
    #[inline(always)]
    fn load_u32(self, from: &[u32]) -> I4 {
        let from = &from[..4];
        // SAFETY: 4 integers are there, and the token proves NEON.
        I4(unsafe { vld1q_u32(from.as_ptr()) })
    }
    #[inline(always)]
    fn add_u32(self, a: I4, b: I4) -> I4 {
        // SAFETY: the token proves NEON.
        I4(unsafe { vaddq_u32(a.0, b.0) })
    }
    #[inline(always)]
    fn store_u32(self, v: I4, to: &mut [u32]) {
        to[..4].copy_from_slice(&self.array(v));
    }
    #[inline(always)]
    fn gt_u32(self, a: I4, b: I4) -> M4 {
        // SAFETY: the token proves NEON.
        M4(unsafe { vcgtq_u32(a.0, b.0) })
    }
    #[inline(always)]
    fn select_u32(self, m: M4, a: I4, b: I4) -> I4 {
        // SAFETY: the token proves NEON.
        I4(unsafe { vbslq_u32(m.0, a.0, b.0) })
    }
    #[inline(always)]
    fn gather_u32(self, table: &[u32], index: I4) -> I4 {
        self.load_u32(&entries(table, self.array(index)))
    }
    #[inline(always)]
    fn lookup_16_u32(self, table: &[u32; 16], index: I4) -> I4 {
        self.load_u32(&self.array(index).map(|entry| table[(entry & 15) as usize]))
    }
    #[inline(always)]
    fn split_u32(self, a: I4) -> (I4, I4) {
        // SAFETY: the token proves NEON.
        unsafe {
            let low = vandq_u32(a.0, vdupq_n_u32(15));
            (I4(vshrq_n_u32::<4>(a.0)), I4(low))
        }
    }
    #[inline(always)]
    fn compress(self, keep: u32, values: I4, out: &mut [u32]) {
        pack_lanes(keep, self.array(values), out);
    }
    #[inline(always)]
    fn pack(self, keep: u32, values: F4, out: &mut [f32]) {
        let mut lanes = [0.0; 4];
        self.store(values, &mut lanes);
        pack_lanes(keep, lanes, out);
    }
    #[inline(always)]
    fn load_quads(self, from: &[[f32; 4]]) -> [F4; 4] {
        let from = from[..4].as_flattened();
        // SAFETY: 16 floats are there, and the token proves NEON. The load itself takes every
        // fourth float to one vector.
        let float32x4x4_t(a, b, c, d) = unsafe { vld4q_f32(from.as_ptr()) };
        [F4(a), F4(b), F4(c), F4(d)]
    }
    #[inline(always)]
    fn gather_quads(self, quads: &[[f32; 4]], codes: &[u32]) -> [F4; 4] {
        let (codes, last) = (&codes[..4], quads.len() - 1);
        let quad = |lane: usize| quads[((codes[lane] >> 4) as usize).min(last)];
        self.load_quads(&[quad(0), quad(1), quad(2), quad(3)])
    }
    #[inline(always)]
    fn store_quads(self, [a, b, c, d]: [F4; 4], to: &mut [[f32; 4]]) {
        let to = to[..4].as_flattened_mut();
        // SAFETY: room for 16 floats is there, and the token proves NEON. The store itself takes
        // one of each vector in turn.
        unsafe { vst4q_f32(to.as_mut_ptr(), float32x4x4_t(a.0, b.0, c.0, d.0)) };
    }
    #[inline(always)]
    fn gather_sixes(self, sixes: &[[f32; 6]], pick: &[u32]) -> [F4; 6] {
        let [fronts, backs] = halves(sixes, pick).map(|half| half.map(|quad| *quad));
        let ([x, y, z, a], [_, _, b, c]) = (self.load_quads(&fronts), self.load_quads(&backs));
        [x, y, z, a, b, c]
    }
    #[inline(always)]
    fn load_transposed(self, rows: &[[f32; ROW]], pick: &[u32]) -> [F4; ROW] {
        let (pick, last) = (&pick[..4], rows.len() - 1);
        let mut out = [self.splat(0.0); ROW];
        for (column, lanes) in out.iter_mut().enumerate() {
            let mut gathered = [0.0; 4];
            for (lane, number) in gathered.iter_mut().enumerate() {
                *number = rows[(pick[lane] as usize).min(last)][column];
            }
            *lanes = self.load(&gathered);
        }
        out
    }
}
