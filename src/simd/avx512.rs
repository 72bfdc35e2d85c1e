//! The AVX-512 tier: 16 lanes, compares into mask registers, in-register compress.

mod transpose;

use std::arch::x86_64::*;

use self::transpose::{transpose, transpose_quads, turn_in_quarters, turn_quarters};
use super::lanes::{
    Lanes, Sealed, clamp_codes, double_operators, ends_of_sixes, float_operators, last_code,
    quad_of,
};
use super::{Kernel, ROW};

/// Proof that the CPU has AVX-512 F, BW, DQ and VL.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Avx512(());

#[derive(Clone, Copy)]
pub struct F16(__m512);
#[derive(Clone, Copy)]
pub struct D16([__m512d; 2]);
#[derive(Clone, Copy)]
pub struct I16(__m512i);
#[derive(Clone, Copy)]
pub struct M16(__mmask16);

float_operators!(F16, _mm512_add_ps, _mm512_sub_ps, _mm512_mul_ps);
double_operators!(D16, _mm512_add_pd, _mm512_sub_pd, _mm512_mul_pd, _mm512_div_pd);

impl std::ops::BitAnd for M16 {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

impl std::ops::BitOr for M16 {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl Avx512 {
    pub(super) fn new() -> Option<Self> {
        (is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512bw")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512vl")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("popcnt"))
        .then_some(Self(()))
    }

    /// Indices of entries of a non-empty table of this length: those past its end become its last
    /// one's, which is below 2³¹ as the gather's signed indices must be.
    #[inline(always)]
    fn clamped(self, index: I16, len: usize) -> I16 {
        assert!(len > 0, "the table has an entry");
        let last = len.min(1 << 31) as u32 - 1;
        // SAFETY: the token proves AVX-512 F.
        I16(unsafe { _mm512_min_epu32(index.0, _mm512_set1_epi32(last as i32)) })
    }
}

pub(super) fn run<K: Kernel>(token: Avx512, kernel: K) -> K::Output {
    #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,bmi2,popcnt")]
    fn inner<K: Kernel>(token: Avx512, kernel: K) -> K::Output {
        kernel.run(token)
    }
    // SAFETY: the token proves the features that `inner` enables.
    unsafe { inner(token, kernel) }
}

impl Sealed for Avx512 {}

impl Lanes for Avx512 {
    const WIDTH: usize = 16;
    type F = F16;
    type D = D16;
    type I = I16;
    type M = M16;

    #[inline(always)]
    fn splat(self, x: f32) -> F16 {
        // SAFETY: the token proves AVX-512 F.
        F16(unsafe { _mm512_set1_ps(x) })
    }
    #[inline(always)]
    fn load(self, from: &[f32]) -> F16 {
        let from = &from[..16];
        // SAFETY: 16 floats are there, and the token proves AVX-512 F.
        F16(unsafe { _mm512_loadu_ps(from.as_ptr()) })
    }
    #[inline(always)]
    fn store(self, v: F16, to: &mut [f32]) {
        let to = &mut to[..16];
        // SAFETY: room for 16 floats is there, and the token proves AVX-512 F.
        unsafe { _mm512_storeu_ps(to.as_mut_ptr(), v.0) };
    }
    #[inline(always)]
    fn min(self, a: F16, b: F16) -> F16 {
        // SAFETY: the token proves AVX-512 F.
        F16(unsafe { _mm512_min_ps(a.0, b.0) })
    }
    #[inline(always)]
    fn max(self, a: F16, b: F16) -> F16 {
        // SAFETY: the token proves AVX-512 F.
        F16(unsafe { _mm512_max_ps(a.0, b.0) })
    }
    #[inline(always)]
    fn abs(self, a: F16) -> F16 {
        // SAFETY: the token proves AVX-512 F.
        F16(unsafe { _mm512_abs_ps(a.0) })
    }
    #[inline(always)]
    fn flip_sign(self, a: F16, sign: F16) -> F16 {
        // SAFETY: the token proves AVX-512 F and DQ.
        F16(unsafe { _mm512_xor_ps(a.0, _mm512_and_ps(sign.0, _mm512_set1_ps(-0.0))) })
    }
    #[inline(always)]
    fn gt(self, a: F16, b: F16) -> M16 {
        // SAFETY: the token proves AVX-512 F.
        M16(unsafe { _mm512_cmp_ps_mask::<_CMP_GT_OQ>(a.0, b.0) })
    }
    #[inline(always)]
    fn negative(self, a: F16) -> M16 {
        // SAFETY: the token proves AVX-512 DQ.
        M16(unsafe { _mm512_movepi32_mask(_mm512_castps_si512(a.0)) })
    }
    #[inline(always)]
    fn select(self, m: M16, a: F16, b: F16) -> F16 {
        // SAFETY: the token proves AVX-512 F.
        F16(unsafe { _mm512_mask_blend_ps(m.0, b.0, a.0) })
    }
    #[inline(always)]
    fn first(self, n: usize) -> M16 {
        M16(if n >= 16 { u16::MAX } else { (1u16 << n) - 1 })
    }
    #[inline(always)]
    fn bits(self, m: M16) -> u32 {
        u32::from(m.0)
    }
    #[inline(always)]
    fn splat_f64(self, x: f64) -> D16 {
        // SAFETY: the token proves AVX-512 F and DQ.
        D16([unsafe { _mm512_set1_pd(x) }; 2])
    }
    #[inline(always)]
    fn widen(self, a: F16) -> D16 {
        // SAFETY: the token proves AVX-512 F and DQ.
        D16(unsafe {
            [
                _mm512_cvtps_pd(_mm512_castps512_ps256(a.0)),
                _mm512_cvtps_pd(_mm512_extractf32x8_ps::<1>(a.0)),
            ]
        })
    }
    #[inline(always)]
    fn narrow(self, a: D16) -> F16 {
        let D16([low, high]) = a;
        // SAFETY: the token proves AVX-512 F and DQ.
        F16(unsafe {
            let low = _mm512_castps256_ps512(_mm512_cvtpd_ps(low));
            _mm512_insertf32x8::<1>(low, _mm512_cvtpd_ps(high))
        })
    }
    #[inline(always)]
    fn gather(self, table: &[f32], index: I16) -> F16 {
        let index = self.clamped(index, table.len());
        // SAFETY: every index is that of an entry, and the token proves AVX-512 F.
        F16(unsafe { _mm512_i32gather_ps::<4>(index.0, table.as_ptr()) })
    }
    #[inline(always)]
    fn lookup_16(self, table: &[f32; 16], index: I16) -> F16 {
        // SAFETY: 16 floats are there, and the token proves AVX-512 F; the permutation reads the
        // low four bits.
        F16(unsafe { _mm512_permutexvar_ps(index.0, _mm512_loadu_ps(table.as_ptr())) })
    }
    #[inline(always)]
    fn as_u32(self, a: F16) -> I16 {
        // SAFETY: the token proves AVX-512 F.
        I16(unsafe { _mm512_castps_si512(a.0) })
    }
    #[inline(always)]
    fn splat_u32(self, x: u32) -> I16 {
        // SAFETY: the token proves AVX-512 F.
        I16(unsafe { _mm512_set1_epi32(x as i32) })
    }
    #[inline(always)]
    fn load_u32(self, from: &[u32]) -> I16 {
        let from = &from[..16];
        // SAFETY: 16 integers are there, and the token proves AVX-512 F.
        I16(unsafe { _mm512_loadu_epi32(from.as_ptr().cast()) })
    }
    #[inline(always)]
    fn add_u32(self, a: I16, b: I16) -> I16 {
        // SAFETY: the token proves AVX-512 F.
        I16(unsafe { _mm512_add_epi32(a.0, b.0) })
    }
    #[inline(always)]
    fn store_u32(self, v: I16, to: &mut [u32]) {
        let to = &mut to[..16];
        // SAFETY: room for 16 integers is there, and the token proves AVX-512 F.
        unsafe { _mm512_storeu_epi32(to.as_mut_ptr().cast(), v.0) };
    }
    #[inline(always)]
    fn gt_u32(self, a: I16, b: I16) -> M16 {
        // SAFETY: the token proves AVX-512 F.
        M16(unsafe { _mm512_cmpgt_epu32_mask(a.0, b.0) })
    }
    #[inline(always)]
    fn select_u32(self, m: M16, a: I16, b: I16) -> I16 {
        // SAFETY: the token proves AVX-512 F.
        I16(unsafe { _mm512_mask_blend_epi32(m.0, b.0, a.0) })
    }
    #[inline(always)]
    fn gather_u32(self, table: &[u32], index: I16) -> I16 {
        let index = self.clamped(index, table.len());
        // SAFETY: every index is that of an entry, and the token proves AVX-512 F.
        I16(unsafe { _mm512_i32gather_epi32::<4>(index.0, table.as_ptr().cast()) })
    }
    #[inline(always)]
    fn lookup_16_u32(self, table: &[u32; 16], index: I16) -> I16 {
        // SAFETY: 16 integers are there, and the token proves AVX-512 F; the permutation reads the
        // low four bits.
        I16(unsafe { _mm512_permutexvar_epi32(index.0, _mm512_loadu_epi32(table.as_ptr().cast())) })
    }
    #[inline(always)]
    fn split_u32(self, a: I16) -> (I16, I16) {
        // SAFETY: the token proves AVX-512 F.
        unsafe {
            let low = _mm512_and_si512(a.0, _mm512_set1_epi32(15));
            (I16(_mm512_srli_epi32::<4>(a.0)), I16(low))
        }
    }
    #[inline(always)]
    fn compress(self, keep: u32, values: I16, out: &mut [u32]) {
        let out = &mut out[..16];
        // SAFETY: room for 16 integers is there, and the token proves AVX-512 F. Compressing in a
        // register and storing the whole is many times faster than the compressing store on some
        // CPUs.
        unsafe {
            let packed = _mm512_maskz_compress_epi32(keep as u16, values.0);
            _mm512_storeu_epi32(out.as_mut_ptr().cast(), packed);
        }
    }
    #[inline(always)]
    fn pack(self, keep: u32, values: F16, out: &mut [f32]) {
        let out = &mut out[..16];
        // SAFETY: room for 16 floats is there, and the token proves AVX-512 F.
        unsafe {
            let packed = _mm512_maskz_compress_ps(keep as u16, values.0);
            _mm512_storeu_ps(out.as_mut_ptr(), packed);
        }
    }
    #[inline(always)]
    fn load_quads(self, from: &[[f32; 4]]) -> [F16; 4] {
        let from = &from[..16];
        // SAFETY: 16 quads are there, and the token proves AVX-512 F.
        unsafe {
            let mut at = [from.as_ptr().cast(); 16];
            for (lane, at) in at.iter_mut().enumerate() {
                *at = from[lane].as_ptr();
            }
            transpose_quads(at)
        }
    }
    #[inline(always)]
    fn gather_quads(self, quads: &[[f32; 4]], codes: &[u32]) -> [F16; 4] {
        let limit = last_code(quads.len());
        let codes = &codes[..16];
        // SAFETY: 16 codes are there, and the token proves AVX-512 F.
        let past_the_end = unsafe {
            let limit = _mm512_set1_epi32(limit as i32);
            let codes = _mm512_loadu_epi32(codes.as_ptr().cast());
            _mm512_cmpgt_epu32_mask(codes, limit) != 0
        };
        let mut clamped = [0; 16];
        let codes = match past_the_end {
            false => codes,
            true => clamp_codes(codes, limit, &mut clamped),
        };
        // SAFETY: no code exceeds that of the last quad, so every pointer leads to a quad; the
        // token proves AVX-512 F.
        unsafe {
            let mut at = [quads.as_ptr().cast(); 16];
            for (lane, at) in at.iter_mut().enumerate() {
                *at = quad_of(quads, codes[lane]);
            }
            transpose_quads(at)
        }
    }
    #[inline(always)]
    fn store_quads(self, columns: [F16; 4], to: &mut [[f32; 4]]) {
        let to = to[..16].as_flattened_mut();
        // SAFETY: room for 64 floats is there, and the token proves AVX-512 F.
        unsafe {
            let quarters = turn_in_quarters(columns.map(|column| column.0));
            for (i, quads) in turn_quarters(quarters).into_iter().enumerate() {
                _mm512_storeu_ps(to.as_mut_ptr().add(16 * i), quads);
            }
        }
    }
    #[inline(always)]
    fn gather_sixes(self, sixes: &[[f32; 6]], pick: &[u32]) -> [F16; 6] {
        let pick = &pick[..16];
        assert!(!sixes.is_empty());
        let last = sixes.len() as u32 - 1;
        // SAFETY: 16 integers are there, every index is clamped to the last six; the token proves
        // AVX-512 F.
        unsafe {
            let [fronts, backs] = ends_of_sixes(sixes.as_ptr(), clamped(pick.as_ptr(), last));
            let ([x, y, z, a], [_, _, b, c]) = (transpose_quads(fronts), transpose_quads(backs));
            [x, y, z, a, b, c]
        }
    }
    #[inline(always)]
    fn load_transposed(self, rows: &[[f32; ROW]], pick: &[u32]) -> [F16; ROW] {
        let pick = &pick[..16];
        assert!(!rows.is_empty());
        let last = rows.len() as u32 - 1;
        let mut picked = [self.splat(0.0).0; 16];
        // SAFETY: 16 integers are there, every index is clamped to the last row; the token proves
        // AVX-512 F.
        unsafe {
            let lanes = clamped(pick.as_ptr(), last);
            for (row, lane) in picked.iter_mut().zip(lanes) {
                *row = _mm512_loadu_ps(rows.as_ptr().add(lane as usize).cast());
            }
            transpose(picked)
        }
    }
}

/// Sixteen integers, none of them above `last`.
///
/// # Safety
/// The CPU has AVX-512 F, and the pointer leads to sixteen integers.
#[inline(always)]
unsafe fn clamped(from: *const u32, last: u32) -> [u32; 16] {
    let mut lanes = [0; 16];
    // SAFETY: the caller vouches for the feature and the pointer.
    unsafe {
        let index =
            _mm512_min_epu32(_mm512_loadu_epi32(from.cast()), _mm512_set1_epi32(last as i32));
        _mm512_storeu_epi32(lanes.as_mut_ptr().cast(), index);
    }
    lanes
}
