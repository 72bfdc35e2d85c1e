//! The SSE2 tier: 4 lanes, available on every x86-64 CPU. Operations for which SSE2 has no
//! instruction go through memory.

use std::arch::x86_64::*;

use super::lanes::{Lanes, Sealed, double_operators, entries, float_operators, halves, pack_lanes};
use super::{Kernel, ROW};

/// Proof that the CPU has SSE2, which is part of x86-64 itself.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Sse2(());

#[derive(Clone, Copy)]
pub struct F4(__m128);
#[derive(Clone, Copy)]
pub struct D4([__m128d; 2]);
#[derive(Clone, Copy)]
pub struct I4(__m128i);
#[derive(Clone, Copy)]
pub struct M4(__m128);

float_operators!(F4, _mm_add_ps, _mm_sub_ps, _mm_mul_ps);
double_operators!(D4, _mm_add_pd, _mm_sub_pd, _mm_mul_pd, _mm_div_pd);

impl std::ops::BitAnd for M4 {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        // SAFETY: SSE2 is part of x86-64.
        Self(unsafe { _mm_and_ps(self.0, other.0) })
    }
}

impl std::ops::BitOr for M4 {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        // SAFETY: SSE2 is part of x86-64.
        Self(unsafe { _mm_or_ps(self.0, other.0) })
    }
}

impl Sse2 {
    pub(super) fn new() -> Option<Self> {
        is_x86_feature_detected!("sse2").then_some(Self(()))
    }

    #[inline(always)]
    fn array(self, v: I4) -> [u32; 4] {
        let mut out = [0u32; 4];
        // SAFETY: room for 4 integers is there, and the token proves SSE2.
        unsafe { _mm_storeu_si128(out.as_mut_ptr().cast(), v.0) };
        out
    }

    #[inline(always)]
    fn transposed(self, rows: [&[f32; 4]; 4]) -> [F4; 4] {
        self.turned(rows.map(|row| self.load(row)))
    }

    /// A 4 × 4 transpose; its own reverse.
    #[inline(always)]
    fn turned(self, rows: [F4; 4]) -> [F4; 4] {
        let [mut a, mut b, mut c, mut d] = rows.map(|row| row.0);
        // SAFETY: the token proves SSE2.
        unsafe { _MM_TRANSPOSE4_PS(&mut a, &mut b, &mut c, &mut d) };
        [F4(a), F4(b), F4(c), F4(d)]
    }
}

pub(super) fn run<K: Kernel>(token: Sse2, kernel: K) -> K::Output {
    kernel.run(token)
}

impl Sealed for Sse2 {}

impl Lanes for Sse2 {
    const WIDTH: usize = 4;
    type F = F4;
    type D = D4;
    type I = I4;
    type M = M4;

    #[inline(always)]
    fn splat(self, x: f32) -> F4 {
        // SAFETY: the token proves SSE2.
        F4(unsafe { _mm_set1_ps(x) })
    }
    #[inline(always)]
    fn load(self, from: &[f32]) -> F4 {
        let from = &from[..4];
        // SAFETY: 4 floats are there, and the token proves SSE2.
        F4(unsafe { _mm_loadu_ps(from.as_ptr()) })
    }
    #[inline(always)]
    fn store(self, v: F4, to: &mut [f32]) {
        let to = &mut to[..4];
        // SAFETY: room for 4 floats is there, and the token proves SSE2.
        unsafe { _mm_storeu_ps(to.as_mut_ptr(), v.0) };
    }
    #[inline(always)]
    fn min(self, a: F4, b: F4) -> F4 {
        // SAFETY: the token proves SSE2.
        F4(unsafe { _mm_min_ps(a.0, b.0) })
    }
    #[inline(always)]
    fn max(self, a: F4, b: F4) -> F4 {
        // SAFETY: the token proves SSE2.
        F4(unsafe { _mm_max_ps(a.0, b.0) })
    }
    #[inline(always)]
    fn abs(self, a: F4) -> F4 {
        // SAFETY: the token proves SSE2.
        F4(unsafe { _mm_andnot_ps(_mm_set1_ps(-0.0), a.0) })
    }
    #[inline(always)]
    fn flip_sign(self, a: F4, sign: F4) -> F4 {
        // SAFETY: the token proves SSE2.
        F4(unsafe { _mm_xor_ps(a.0, _mm_and_ps(sign.0, _mm_set1_ps(-0.0))) })
    }
    #[inline(always)]
    fn gt(self, a: F4, b: F4) -> M4 {
        // SAFETY: the token proves SSE2.
        M4(unsafe { _mm_cmpgt_ps(a.0, b.0) })
    }
    #[inline(always)]
    fn negative(self, a: F4) -> M4 {
        // SAFETY: the token proves SSE2.
        M4(unsafe { _mm_castsi128_ps(_mm_srai_epi32::<31>(_mm_castps_si128(a.0))) })
    }
    #[inline(always)]
    fn select(self, m: M4, a: F4, b: F4) -> F4 {
        // SAFETY: the token proves SSE2.
        F4(unsafe { _mm_or_ps(_mm_and_ps(m.0, a.0), _mm_andnot_ps(m.0, b.0)) })
    }
    #[inline(always)]
    fn first(self, n: usize) -> M4 {
        // SAFETY: the token proves SSE2.
        M4(unsafe {
            let lane = _mm_setr_epi32(0, 1, 2, 3);
            _mm_castsi128_ps(_mm_cmpgt_epi32(_mm_set1_epi32(n.min(4) as i32), lane))
        })
    }
    #[inline(always)]
    fn bits(self, m: M4) -> u32 {
        // SAFETY: the token proves SSE2.
        (unsafe { _mm_movemask_ps(m.0) }) as u32
    }
    #[inline(always)]
    fn splat_f64(self, x: f64) -> D4 {
        // SAFETY: the token proves SSE2.
        D4([unsafe { _mm_set1_pd(x) }; 2])
    }
    #[inline(always)]
    fn widen(self, a: F4) -> D4 {
        // SAFETY: the token proves SSE2.
        D4(unsafe { [_mm_cvtps_pd(a.0), _mm_cvtps_pd(_mm_movehl_ps(a.0, a.0))] })
    }
    #[inline(always)]
    fn narrow(self, a: D4) -> F4 {
        let D4([low, high]) = a;
        // SAFETY: the token proves SSE2.
        F4(unsafe { _mm_movelh_ps(_mm_cvtpd_ps(low), _mm_cvtpd_ps(high)) })
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
        // SAFETY: the token proves SSE2.
        I4(unsafe { _mm_castps_si128(a.0) })
    }
    #[inline(always)]
    fn splat_u32(self, x: u32) -> I4 {
        // SAFETY: the token proves SSE2.
        I4(unsafe { _mm_set1_epi32(x as i32) })
    }
    #[inline(always)]
    fn load_u32(self, from: &[u32]) -> I4 {
        let from = &from[..4];
        // SAFETY: 4 integers are there, and the token proves SSE2.
        I4(unsafe { _mm_loadu_si128(from.as_ptr().cast()) })
    }
    #[inline(always)]
    fn add_u32(self, a: I4, b: I4) -> I4 {
        // SAFETY: the token proves SSE2.
        I4(unsafe { _mm_add_epi32(a.0, b.0) })
    }
    #[inline(always)]
    fn store_u32(self, v: I4, to: &mut [u32]) {
        to[..4].copy_from_slice(&self.array(v));
    }
    #[inline(always)]
    fn gt_u32(self, a: I4, b: I4) -> M4 {
        // SAFETY: the token proves SSE2, whose comparison is signed: flipped signs put the upper
        // half above the lower.
        M4(unsafe {
            let sign = _mm_set1_epi32(i32::MIN);
            let [a, b] = [_mm_xor_si128(a.0, sign), _mm_xor_si128(b.0, sign)];
            _mm_castsi128_ps(_mm_cmpgt_epi32(a, b))
        })
    }
    #[inline(always)]
    fn select_u32(self, m: M4, a: I4, b: I4) -> I4 {
        // SAFETY: the token proves SSE2.
        I4(unsafe {
            let m = _mm_castps_si128(m.0);
            _mm_or_si128(_mm_and_si128(m, a.0), _mm_andnot_si128(m, b.0))
        })
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
        // SAFETY: the token proves SSE2.
        unsafe {
            let low = _mm_and_si128(a.0, _mm_set1_epi32(15));
            (I4(_mm_srli_epi32::<4>(a.0)), I4(low))
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
        let from = &from[..4];
        self.transposed([&from[0], &from[1], &from[2], &from[3]])
    }
    #[inline(always)]
    fn gather_quads(self, quads: &[[f32; 4]], codes: &[u32]) -> [F4; 4] {
        let (codes, last) = (&codes[..4], quads.len() - 1);
        let quad = |lane: usize| &quads[((codes[lane] >> 4) as usize).min(last)];
        self.transposed([quad(0), quad(1), quad(2), quad(3)])
    }
    #[inline(always)]
    fn store_quads(self, columns: [F4; 4], to: &mut [[f32; 4]]) {
        for (quad, to) in self.turned(columns).into_iter().zip(&mut to[..4]) {
            self.store(quad, to);
        }
    }
    #[inline(always)]
    fn gather_sixes(self, sixes: &[[f32; 6]], pick: &[u32]) -> [F4; 6] {
        let [fronts, backs] = halves(sixes, pick);
        let ([x, y, z, a], [_, _, b, c]) = (self.transposed(fronts), self.transposed(backs));
        [x, y, z, a, b, c]
    }
    #[inline(always)]
    fn load_transposed(self, rows: &[[f32; ROW]], pick: &[u32]) -> [F4; ROW] {
        let (pick, last) = (&pick[..4], rows.len() - 1);
        let mut out = [self.splat(0.0); ROW];
        for start in [0, 4, 8, 12] {
            let part = |lane: usize| rows[(pick[lane] as usize).min(last)][start..].first_chunk();
            if let (Some(a), Some(b), Some(c), Some(d)) = (part(0), part(1), part(2), part(3)) {
                out[start..start + 4].copy_from_slice(&self.transposed([a, b, c, d]));
            }
        }
        out
    }
}
