//! The AVX2 tier: 8 lanes, masks as vectors, compress by a permutation table.

mod transpose;

use std::arch::x86_64::*;

use self::transpose::{transpose, transpose_quads, turn_in_halves};
use super::lanes::{
    Lanes, Sealed, clamp_codes, double_operators, ends_of_sixes, float_operators, last_code,
    quad_of,
};
use super::{Kernel, ROW};

/// Proof that the CPU has AVX2.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Avx2(());

#[derive(Clone, Copy)]
pub struct F8(__m256);
#[derive(Clone, Copy)]
pub struct D8([__m256d; 2]);
#[derive(Clone, Copy)]
pub struct I8(__m256i);
#[derive(Clone, Copy)]
pub struct M8(__m256);

float_operators!(F8, _mm256_add_ps, _mm256_sub_ps, _mm256_mul_ps);
double_operators!(D8, _mm256_add_pd, _mm256_sub_pd, _mm256_mul_pd, _mm256_div_pd);

impl std::ops::BitAnd for M8 {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        // SAFETY: a mask exists only if its token did, and the token proves AVX.
        Self(unsafe { _mm256_and_ps(self.0, other.0) })
    }
}

impl std::ops::BitOr for M8 {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        // SAFETY: a mask exists only if its token did, and the token proves AVX.
        Self(unsafe { _mm256_or_ps(self.0, other.0) })
    }
}

/// For each set of lanes, the permutation that moves them to the front.
static PACK: [[u32; 8]; 256] = pack_table();

const fn pack_table() -> [[u32; 8]; 256] {
    let mut table = [[0; 8]; 256];
    let mut set = 0;
    while set < 256 {
        let (mut lane, mut kept) = (0, 0);
        while lane < 8 {
            if set >> lane & 1 == 1 {
                table[set][kept] = lane;
                kept += 1;
            }
            lane += 1;
        }
        set += 1;
    }
    table
}

impl Avx2 {
    pub(super) fn new() -> Option<Self> {
        (is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("popcnt"))
        .then_some(Self(()))
    }

    /// Indices of entries of a non-empty table of this length: those past its end become its last
    /// one's, which is below 2³¹ as the gather's signed indices must be.
    #[inline(always)]
    fn clamped(self, index: I8, len: usize) -> I8 {
        assert!(len > 0, "the table has an entry");
        let last = len.min(1 << 31) as u32 - 1;
        // SAFETY: the token proves AVX2.
        I8(unsafe { _mm256_min_epu32(index.0, _mm256_set1_epi32(last as i32)) })
    }
}

pub(super) fn run<K: Kernel>(token: Avx2, kernel: K) -> K::Output {
    #[target_feature(enable = "avx2,bmi2,popcnt")]
    fn inner<K: Kernel>(token: Avx2, kernel: K) -> K::Output {
        kernel.run(token)
    }
    // SAFETY: the token proves the features that `inner` enables.
    unsafe { inner(token, kernel) }
}

impl Sealed for Avx2 {}

impl Lanes for Avx2 {
    const WIDTH: usize = 8;
    type F = F8;
    type D = D8;
    type I = I8;
    type M = M8;

    #[inline(always)]
    fn splat(self, x: f32) -> F8 {
        // SAFETY: the token proves AVX.
        F8(unsafe { _mm256_set1_ps(x) })
    }
    #[inline(always)]
    fn load(self, from: &[f32]) -> F8 {
        let from = &from[..8];
        // SAFETY: 8 floats are there, and the token proves AVX.
        F8(unsafe { _mm256_loadu_ps(from.as_ptr()) })
    }
    #[inline(always)]
    fn store(self, v: F8, to: &mut [f32]) {
        let to = &mut to[..8];
        // SAFETY: room for 8 floats is there, and the token proves AVX.
        unsafe { _mm256_storeu_ps(to.as_mut_ptr(), v.0) };
    }
    #[inline(always)]
    fn min(self, a: F8, b: F8) -> F8 {
        // SAFETY: the token proves AVX.
        F8(unsafe { _mm256_min_ps(a.0, b.0) })
    }
    #[inline(always)]
    fn max(self, a: F8, b: F8) -> F8 {
        // SAFETY: the token proves AVX.
        F8(unsafe { _mm256_max_ps(a.0, b.0) })
    }
    #[inline(always)]
    fn abs(self, a: F8) -> F8 {
        // SAFETY: the token proves AVX.
        F8(unsafe { _mm256_andnot_ps(_mm256_set1_ps(-0.0), a.0) })
    }
    #[inline(always)]
    fn flip_sign(self, a: F8, sign: F8) -> F8 {
        // SAFETY: the token proves AVX.
        F8(unsafe { _mm256_xor_ps(a.0, _mm256_and_ps(sign.0, _mm256_set1_ps(-0.0))) })
    }
    #[inline(always)]
    fn gt(self, a: F8, b: F8) -> M8 {
        // SAFETY: the token proves AVX.
        M8(unsafe { _mm256_cmp_ps::<_CMP_GT_OQ>(a.0, b.0) })
    }
    #[inline(always)]
    fn negative(self, a: F8) -> M8 {
        // Selections and bits look at a mask's sign alone.
        M8(a.0)
    }
    #[inline(always)]
    fn select(self, m: M8, a: F8, b: F8) -> F8 {
        // SAFETY: the token proves AVX.
        F8(unsafe { _mm256_blendv_ps(b.0, a.0, m.0) })
    }
    #[inline(always)]
    fn first(self, n: usize) -> M8 {
        // SAFETY: the token proves AVX2.
        M8(unsafe {
            let lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
            _mm256_castsi256_ps(_mm256_cmpgt_epi32(_mm256_set1_epi32(n.min(8) as i32), lane))
        })
    }
    #[inline(always)]
    fn bits(self, m: M8) -> u32 {
        // SAFETY: the token proves AVX.
        (unsafe { _mm256_movemask_ps(m.0) }) as u32
    }
    #[inline(always)]
    fn splat_f64(self, x: f64) -> D8 {
        // SAFETY: the token proves AVX.
        D8([unsafe { _mm256_set1_pd(x) }; 2])
    }
    #[inline(always)]
    fn widen(self, a: F8) -> D8 {
        // SAFETY: the token proves AVX.
        D8(unsafe {
            [
                _mm256_cvtps_pd(_mm256_castps256_ps128(a.0)),
                _mm256_cvtps_pd(_mm256_extractf128_ps::<1>(a.0)),
            ]
        })
    }
    #[inline(always)]
    fn narrow(self, a: D8) -> F8 {
        let D8([low, high]) = a;
        // SAFETY: the token proves AVX.
        F8(unsafe { _mm256_set_m128(_mm256_cvtpd_ps(high), _mm256_cvtpd_ps(low)) })
    }
    #[inline(always)]
    fn gather(self, table: &[f32], index: I8) -> F8 {
        let index = self.clamped(index, table.len());
        // SAFETY: every index is that of an entry, and the token proves AVX2.
        F8(unsafe { _mm256_i32gather_ps::<4>(table.as_ptr(), index.0) })
    }
    #[inline(always)]
    fn lookup_16(self, table: &[f32; 16], index: I8) -> F8 {
        // SAFETY: 16 floats are there, and the token proves AVX2.
        F8(unsafe { lookup(table.as_ptr(), index.0) })
    }
    #[inline(always)]
    fn as_u32(self, a: F8) -> I8 {
        // SAFETY: the token proves AVX.
        I8(unsafe { _mm256_castps_si256(a.0) })
    }
    #[inline(always)]
    fn splat_u32(self, x: u32) -> I8 {
        // SAFETY: the token proves AVX.
        I8(unsafe { _mm256_set1_epi32(x as i32) })
    }
    #[inline(always)]
    fn load_u32(self, from: &[u32]) -> I8 {
        let from = &from[..8];
        // SAFETY: 8 integers are there, and the token proves AVX.
        I8(unsafe { _mm256_loadu_si256(from.as_ptr().cast()) })
    }
    #[inline(always)]
    fn add_u32(self, a: I8, b: I8) -> I8 {
        // SAFETY: the token proves AVX2.
        I8(unsafe { _mm256_add_epi32(a.0, b.0) })
    }
    #[inline(always)]
    fn store_u32(self, v: I8, to: &mut [u32]) {
        let to = &mut to[..8];
        // SAFETY: room for 8 integers is there, and the token proves AVX.
        unsafe { _mm256_storeu_si256(to.as_mut_ptr().cast(), v.0) };
    }
    #[inline(always)]
    fn gt_u32(self, a: I8, b: I8) -> M8 {
        // SAFETY: the token proves AVX2, whose comparison is signed: flipped signs put the upper
        // half above the lower.
        M8(unsafe {
            let sign = _mm256_set1_epi32(i32::MIN);
            let [a, b] = [_mm256_xor_si256(a.0, sign), _mm256_xor_si256(b.0, sign)];
            _mm256_castsi256_ps(_mm256_cmpgt_epi32(a, b))
        })
    }
    #[inline(always)]
    fn select_u32(self, m: M8, a: I8, b: I8) -> I8 {
        // SAFETY: the token proves AVX.
        I8(unsafe {
            let [a, b] = [_mm256_castsi256_ps(a.0), _mm256_castsi256_ps(b.0)];
            _mm256_castps_si256(_mm256_blendv_ps(b, a, m.0))
        })
    }
    #[inline(always)]
    fn gather_u32(self, table: &[u32], index: I8) -> I8 {
        let index = self.clamped(index, table.len());
        // SAFETY: every index is that of an entry, and the token proves AVX2.
        I8(unsafe { _mm256_i32gather_epi32::<4>(table.as_ptr().cast(), index.0) })
    }
    #[inline(always)]
    fn lookup_16_u32(self, table: &[u32; 16], index: I8) -> I8 {
        // SAFETY: 16 integers are there, of the size of floats, and the token proves AVX2.
        I8(unsafe { _mm256_castps_si256(lookup(table.as_ptr().cast(), index.0)) })
    }
    #[inline(always)]
    fn split_u32(self, a: I8) -> (I8, I8) {
        // SAFETY: the token proves AVX2.
        unsafe {
            let low = _mm256_and_si256(a.0, _mm256_set1_epi32(15));
            (I8(_mm256_srli_epi32::<4>(a.0)), I8(low))
        }
    }
    #[inline(always)]
    fn compress(self, keep: u32, values: I8, out: &mut [u32]) {
        let out = &mut out[..8];
        let order = &PACK[(keep & 0xff) as usize];
        // SAFETY: the table row has 8 entries, room for 8 integers is there, and the token proves
        // AVX2.
        unsafe {
            let order = _mm256_loadu_si256(order.as_ptr().cast());
            let packed = _mm256_permutevar8x32_epi32(values.0, order);
            _mm256_storeu_si256(out.as_mut_ptr().cast(), packed);
        }
    }
    #[inline(always)]
    fn pack(self, keep: u32, values: F8, out: &mut [f32]) {
        let out = &mut out[..8];
        let order = &PACK[(keep & 0xff) as usize];
        // SAFETY: the table row has 8 entries, room for 8 floats is there, and the token proves
        // AVX2.
        unsafe {
            let order = _mm256_loadu_si256(order.as_ptr().cast());
            let packed = _mm256_permutevar8x32_ps(values.0, order);
            _mm256_storeu_ps(out.as_mut_ptr(), packed);
        }
    }
    #[inline(always)]
    fn load_quads(self, from: &[[f32; 4]]) -> [F8; 4] {
        let from = &from[..8];
        // SAFETY: 8 quads are there, and the token proves AVX.
        unsafe {
            let mut at = [from.as_ptr().cast(); 8];
            for (lane, at) in at.iter_mut().enumerate() {
                *at = from[lane].as_ptr();
            }
            transpose_quads(at)
        }
    }
    #[inline(always)]
    fn gather_quads(self, quads: &[[f32; 4]], codes: &[u32]) -> [F8; 4] {
        let limit = last_code(quads.len());
        let codes = &codes[..8];
        // SAFETY: 8 codes are there, and the token proves AVX2.
        let past_the_end = unsafe {
            let limit = _mm256_set1_epi32(limit as i32);
            // Codes are compared by how far they exceed the limit: the tier has no unsigned
            // comparison.
            let codes = _mm256_loadu_si256(codes.as_ptr().cast());
            let over = _mm256_sub_epi32(_mm256_max_epu32(codes, limit), limit);
            _mm256_testz_si256(over, over) == 0
        };
        let mut clamped = [0; 8];
        let codes = match past_the_end {
            false => codes,
            true => clamp_codes(codes, limit, &mut clamped),
        };
        // SAFETY: no code exceeds that of the last quad, so every pointer leads to a quad; the
        // token proves AVX2.
        unsafe {
            let mut at = [quads.as_ptr().cast(); 8];
            for (lane, at) in at.iter_mut().enumerate() {
                *at = quad_of(quads, codes[lane]);
            }
            transpose_quads(at)
        }
    }
    #[inline(always)]
    fn store_quads(self, columns: [F8; 4], to: &mut [[f32; 4]]) {
        let to = &mut to[..8];
        // SAFETY: room for 8 quads is there, and the token proves AVX.
        unsafe {
            for (i, pair) in turn_in_halves(columns.map(|column| column.0)).into_iter().enumerate()
            {
                let [near, far] = [i, i + 4].map(|quad| to.as_mut_ptr().add(quad).cast());
                _mm256_storeu2_m128(far, near, pair);
            }
        }
    }
    #[inline(always)]
    fn gather_sixes(self, sixes: &[[f32; 6]], pick: &[u32]) -> [F8; 6] {
        let pick = &pick[..8];
        assert!(!sixes.is_empty());
        let last = sixes.len() as u32 - 1;
        // SAFETY: 8 integers are there, every index is clamped to the last six; the token proves
        // AVX2.
        unsafe {
            let [fronts, backs] = ends_of_sixes(sixes.as_ptr(), clamped(pick.as_ptr(), last));
            let ([x, y, z, a], [_, _, b, c]) = (transpose_quads(fronts), transpose_quads(backs));
            [x, y, z, a, b, c]
        }
    }
    #[inline(always)]
    fn load_transposed(self, rows: &[[f32; ROW]], pick: &[u32]) -> [F8; ROW] {
        let pick = &pick[..8];
        assert!(!rows.is_empty());
        let last = rows.len() as u32 - 1;
        let mut out = [self.splat(0.0); ROW];
        // SAFETY: 8 integers are there, every index is clamped to the last row; the token proves
        // AVX2.
        unsafe {
            let lanes = clamped(pick.as_ptr(), last);
            for half in [0, 8] {
                let mut picked = [out[0].0; 8];
                for (row, lane) in picked.iter_mut().zip(lanes) {
                    let from: *const f32 = rows.as_ptr().add(lane as usize).cast();
                    *row = _mm256_loadu_ps(from.add(half));
                }
                out[half..half + 8].copy_from_slice(&transpose(picked));
            }
        }
        out
    }
}

/// Entries of a table of sixteen, whatever its bits mean: the permutations read the low three bits
/// of an index, and bit 3, moved into the sign, picks the half.
///
/// # Safety
/// The CPU has AVX2, and the pointer leads to sixteen floats.
#[inline(always)]
unsafe fn lookup(table: *const f32, index: __m256i) -> __m256 {
    // SAFETY: the caller vouches for the feature and the pointer.
    unsafe {
        let low = _mm256_permutevar8x32_ps(_mm256_loadu_ps(table), index);
        let high = _mm256_permutevar8x32_ps(_mm256_loadu_ps(table.add(8)), index);
        let half = _mm256_castsi256_ps(_mm256_slli_epi32::<28>(index));
        _mm256_blendv_ps(low, high, half)
    }
}

/// Eight integers, none of them above `last`.
///
/// # Safety
/// The CPU has AVX2, and the pointer leads to eight integers.
#[inline(always)]
unsafe fn clamped(from: *const u32, last: u32) -> [u32; 8] {
    let mut lanes = [0; 8];
    // SAFETY: the caller vouches for the feature and the pointer.
    unsafe {
        let index =
            _mm256_min_epu32(_mm256_loadu_si256(from.cast()), _mm256_set1_epi32(last as i32));
        _mm256_storeu_si256(lanes.as_mut_ptr().cast(), index);
    }
    lanes
}
