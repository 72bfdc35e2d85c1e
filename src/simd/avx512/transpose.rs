//! Rows and columns of the AVX-512 tier.

use std::arch::x86_64::*;

use super::F16;

/// Sixteen quads as four columns: quads i, i + 4, i + 8 and i + 12 share a register, so a 4 × 4
/// transpose within quarters puts all in place. Some 12 cycles, where four gathers take 80.
///
/// # Safety
/// The CPU has AVX-512 F, and each pointer leads to four floats.
#[inline(always)]
pub(super) unsafe fn transpose_quads(quads: [*const f32; 16]) -> [F16; 4] {
    // SAFETY: the caller vouches for the feature and the pointers.
    unsafe {
        let mut r = [_mm512_setzero_ps(); 4];
        for (i, r) in r.iter_mut().enumerate() {
            let first = _mm512_castps128_ps512(_mm_loadu_ps(quads[i]));
            let second = _mm512_insertf32x4::<1>(first, _mm_loadu_ps(quads[i + 4]));
            let third = _mm512_insertf32x4::<2>(second, _mm_loadu_ps(quads[i + 8]));
            *r = _mm512_insertf32x4::<3>(third, _mm_loadu_ps(quads[i + 12]));
        }
        turn_in_quarters(r).map(F16)
    }
}

/// A 16 × 16 transpose: 4 × 4 blocks within 128-bit quarters, then the quarters themselves.
///
/// # Safety
/// The CPU has AVX-512 F.
#[inline(always)]
pub(super) unsafe fn transpose(r: [__m512; 16]) -> [F16; 16] {
    let mut quad = [r[0]; 16];
    for i in (0..16).step_by(4) {
        // SAFETY: the caller vouches for the feature.
        let turned = unsafe { turn_in_quarters([r[i], r[i + 1], r[i + 2], r[i + 3]]) };
        quad[i..i + 4].copy_from_slice(&turned);
    }
    // Now quad[4i + j], quarter q, holds column 4q + j of rows 4i … 4i + 3.
    let mut out = [F16(r[0]); 16];
    for j in 0..4 {
        // SAFETY: the caller vouches for the feature.
        let columns = unsafe { turn_quarters([quad[j], quad[4 + j], quad[8 + j], quad[12 + j]]) };
        for (q, column) in columns.into_iter().enumerate() {
            out[4 * q + j] = F16(column);
        }
    }
    out
}

/// A 4 × 4 transpose within each quarter; its own reverse.
///
/// # Safety
/// The CPU has AVX-512 F.
#[inline(always)]
pub(super) unsafe fn turn_in_quarters([a, b, c, d]: [__m512; 4]) -> [__m512; 4] {
    // SAFETY: the caller vouches for the feature.
    unsafe {
        let [ab_lo, ab_hi] = [_mm512_unpacklo_ps(a, b), _mm512_unpackhi_ps(a, b)];
        let [cd_lo, cd_hi] = [_mm512_unpacklo_ps(c, d), _mm512_unpackhi_ps(c, d)];
        [
            _mm512_shuffle_ps::<0x44>(ab_lo, cd_lo),
            _mm512_shuffle_ps::<0xee>(ab_lo, cd_lo),
            _mm512_shuffle_ps::<0x44>(ab_hi, cd_hi),
            _mm512_shuffle_ps::<0xee>(ab_hi, cd_hi),
        ]
    }
}

/// A 4 × 4 transpose of whole quarters; its own reverse.
///
/// # Safety
/// The CPU has AVX-512 F.
#[inline(always)]
pub(super) unsafe fn turn_quarters([a, b, c, d]: [__m512; 4]) -> [__m512; 4] {
    // SAFETY: the caller vouches for the feature.
    unsafe {
        let [ab_even, ab_odd] =
            [_mm512_shuffle_f32x4::<0x88>(a, b), _mm512_shuffle_f32x4::<0xdd>(a, b)];
        let [cd_even, cd_odd] =
            [_mm512_shuffle_f32x4::<0x88>(c, d), _mm512_shuffle_f32x4::<0xdd>(c, d)];
        [
            _mm512_shuffle_f32x4::<0x88>(ab_even, cd_even),
            _mm512_shuffle_f32x4::<0x88>(ab_odd, cd_odd),
            _mm512_shuffle_f32x4::<0xdd>(ab_even, cd_even),
            _mm512_shuffle_f32x4::<0xdd>(ab_odd, cd_odd),
        ]
    }
}
