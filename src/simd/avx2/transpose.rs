//! Rows and columns of the AVX2 tier.

use std::arch::x86_64::*;

use super::F8;

/// Eight quads as four columns: quads i and i + 4 share a register, so a 4 × 4 transpose within
/// halves puts all in place.
///
/// # Safety
/// The CPU has AVX, and each pointer leads to four floats.
#[inline(always)]
pub(super) unsafe fn transpose_quads(quads: [*const f32; 8]) -> [F8; 4] {
    // SAFETY: the caller vouches for the feature and the pointers.
    unsafe {
        let mut r = [_mm256_setzero_ps(); 4];
        for (i, r) in r.iter_mut().enumerate() {
            *r = _mm256_loadu2_m128(quads[i + 4], quads[i]);
        }
        turn_in_halves(r).map(F8)
    }
}

/// An 8 × 8 transpose: 4 × 4 blocks within 128-bit halves, then the halves themselves.
///
/// # Safety
/// The CPU has AVX.
#[inline(always)]
pub(super) unsafe fn transpose([a, b, c, d, e, f, g, h]: [__m256; 8]) -> [F8; 8] {
    let mut out = [F8(a); 8];
    // SAFETY: the caller vouches for the feature.
    unsafe {
        let (upper, lower) = (turn_in_halves([a, b, c, d]), turn_in_halves([e, f, g, h]));
        for (j, (upper, lower)) in upper.into_iter().zip(lower).enumerate() {
            out[j] = F8(_mm256_permute2f128_ps::<0x20>(upper, lower));
            out[4 + j] = F8(_mm256_permute2f128_ps::<0x31>(upper, lower));
        }
    }
    out
}

/// A 4 × 4 transpose within each half; its own reverse.
///
/// # Safety
/// The CPU has AVX.
#[inline(always)]
pub(super) unsafe fn turn_in_halves([a, b, c, d]: [__m256; 4]) -> [__m256; 4] {
    // SAFETY: the caller vouches for the feature.
    unsafe {
        let [ab_lo, ab_hi] = [_mm256_unpacklo_ps(a, b), _mm256_unpackhi_ps(a, b)];
        let [cd_lo, cd_hi] = [_mm256_unpacklo_ps(c, d), _mm256_unpackhi_ps(c, d)];
        [
            _mm256_shuffle_ps::<0x44>(ab_lo, cd_lo),
            _mm256_shuffle_ps::<0xee>(ab_lo, cd_lo),
            _mm256_shuffle_ps::<0x44>(ab_hi, cd_hi),
            _mm256_shuffle_ps::<0xee>(ab_hi, cd_hi),
        ]
    }
}
