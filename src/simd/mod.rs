//! The only room with `unsafe`: vectors of f32 for every tier of the CPU with one sealed trait, and
//! the floating-point mode that they run in.
//!
//! A kernel is written once, generic over [`Lanes`], with plain `+ − ×`, comparisons and table
//! look-ups and never a fused multiply-add, so that every tier computes the same bits. [`Tier`]
//! lists the tiers of this CPU; a value of it proves that the CPU has it. [`dispatch`] compiles the
//! kernel once per tier, inside a function with that tier's target features, and calls the one for
//! the given tier.
//!
//! We use `std::arch` with tokens instead of a portable vector crate because a sphere test takes
//! 0.060 ns this way, 0.106 autovectorised and 0.164 through a crate's dispatch.

#![allow(
    unsafe_code,
    reason = "the intrinsics of std::arch and the floating-point mode are unsafe; this room alone holds them"
)]

mod aabb;
mod columns;
mod fp_mode;
#[cfg_attr(omits, allow(unused, reason = "each tier uses other parts"))]
mod lanes;
mod scalar;
mod tier;

#[cfg(all(target_arch = "x86_64", not(omits = "avx2")))]
mod avx2;
#[cfg(all(target_arch = "x86_64", not(omits = "avx512")))]
mod avx512;
#[cfg(all(target_arch = "aarch64", not(omits = "neon")))]
mod neon;
#[cfg(all(target_arch = "x86_64", not(omits = "sse2")))]
mod sse2;

pub use aabb::{Aabb, BoxQuad, SeekerQuad, TaggedBox, boxes_of, numbers_of};
pub use columns::{quads_in_columns, turn_rows};
pub use fp_mode::{FpMode, in_default_mode};
pub use lanes::Lanes;
pub use tier::{Tier, TierError};

/// The widest tier's lanes: columns are padded by this much so that any tier may load past their
/// end.
pub const MAX_WIDTH: usize = 16;

/// Quads that codes can tell apart: a code is an index of 28 bits over a lane of 4.
pub const MOST_QUADS: usize = 1 << 28;

/// Floats in a row that [`Lanes::load_transposed`] turns into columns: one cache line.
pub const ROW: usize = 16;

/// The number of each lane, in any tier.
pub const LANES: [u32; MAX_WIDTH] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

/// Bytes that come into the caches with any one of them, on any processor that is known of.
pub const CACHE_LINE: usize = 64;

/// Prefetches the cache line in which `element` begins, so that it is in the caches when it is read
/// some hundred cycles later.
#[inline(always)]
pub fn prefetch<T>(element: &T) {
    #[cfg(target_arch = "x86_64")]
    // SAFETY: a hint that reads nothing and never faults; every CPU of this architecture has it.
    unsafe {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        _mm_prefetch::<_MM_HINT_T0>(std::ptr::from_ref(element).cast());
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = element;
}

/// Prefetches the cache lines in which an element begins and ends, which may be two.
#[inline(always)]
pub fn prefetch_ends<const N: usize>(element: &[f32; N]) {
    element.first().map(prefetch);
    element.last().map(prefetch);
}

/// A computation that is compiled once for every tier.
pub trait Kernel {
    /// What it returns.
    type Output;

    /// The computation, to be marked `#[inline(always)]` so that it takes on the tier's target
    /// features.
    fn run<L: Lanes>(self, lanes: L) -> Self::Output;
}

/// Runs `kernel` in one lane. It is not compiled for any other tier.
pub fn in_one_lane<K: Kernel>(kernel: K) -> K::Output {
    kernel.run(scalar::Scalar::<false>::new())
}

/// Runs `kernel` in the tier that `tier` names.
pub fn dispatch<K: Kernel>(tier: Tier, kernel: K) -> K::Output {
    match tier.tier() {
        tier::Isa::Scalar => kernel.run(scalar::Scalar::<false>::new()),
        #[cfg(not(omits = "scalar-flush"))]
        tier::Isa::ScalarFlush => kernel.run(scalar::Scalar::<true>::new()),
        #[cfg(all(target_arch = "x86_64", not(omits = "sse2")))]
        tier::Isa::Sse2(token) => sse2::run(token, kernel),
        #[cfg(all(target_arch = "x86_64", not(omits = "avx2")))]
        tier::Isa::Avx2(token) => avx2::run(token, kernel),
        #[cfg(all(target_arch = "x86_64", not(omits = "avx512")))]
        tier::Isa::Avx512(token) => avx512::run(token, kernel),
        #[cfg(all(target_arch = "aarch64", not(omits = "neon")))]
        tier::Isa::Neon(token) => neon::run(token, kernel),
    }
}

#[cfg(test)]
mod tests;
