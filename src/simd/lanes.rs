//! The sealed trait of a tier: what a kernel may do with a vector of f32.

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Sub};

use super::ROW;

/// Only this crate's tiers implement [`Lanes`]; a kernel may rely on their bit-identical results.
pub trait Sealed {}

/// A tier of the CPU. Values of this type are tokens: holding one means having checked that the CPU
/// has the tier, and vectors come from tokens alone, so their operators need no further check.
///
/// Semantics are those of IEEE 754 binary32, round to nearest even, with these choices where CPUs
/// differ: `min(a, b)` is `if a < b { a } else { b }` and `max(a, b)` is `if a > b { a } else { b
/// }` (so a NaN yields `b`).
pub trait Lanes: Copy + Send + Sync + Sealed + 'static {
    /// Lanes in a vector: 1, 4, 8 or 16.
    const WIDTH: usize;
    /// A vector of f32.
    type F: Copy + Add<Output = Self::F> + Sub<Output = Self::F> + Mul<Output = Self::F>;
    /// As many f64 as [`Self::F`] has f32.
    type D: Copy
        + Add<Output = Self::D>
        + Sub<Output = Self::D>
        + Mul<Output = Self::D>
        + Div<Output = Self::D>;
    /// A vector of u32.
    type I: Copy;
    /// A truth value a lane.
    type M: Copy + BitAnd<Output = Self::M> + BitOr<Output = Self::M>;

    /// `x` in every lane.
    fn splat(self, x: f32) -> Self::F;
    /// The first `WIDTH` elements of `from`, which must have that many.
    fn load(self, from: &[f32]) -> Self::F;
    /// Writes all lanes to the front of `to`, which must have `WIDTH` elements.
    fn store(self, v: Self::F, to: &mut [f32]);
    /// Smaller lane by lane.
    fn min(self, a: Self::F, b: Self::F) -> Self::F;
    /// Larger lane by lane.
    fn max(self, a: Self::F, b: Self::F) -> Self::F;
    /// Sign bit cleared.
    fn abs(self, a: Self::F) -> Self::F;
    /// `a` with its sign bit flipped where that of `sign` is set.
    fn flip_sign(self, a: Self::F, sign: Self::F) -> Self::F;
    /// `a > b`, false for NaN.
    fn gt(self, a: Self::F, b: Self::F) -> Self::M;
    /// Lanes whose sign bit is set, that of −0 too.
    fn negative(self, a: Self::F) -> Self::M;
    /// `if m { a } else { b }`.
    fn select(self, m: Self::M, a: Self::F, b: Self::F) -> Self::F;
    /// Lanes below `n` true, the rest false.
    fn first(self, n: usize) -> Self::M;
    /// Lane i as bit i.
    fn bits(self, m: Self::M) -> u32;

    /// `x` in every lane.
    fn splat_f64(self, x: f64) -> Self::D;
    /// The same numbers as f64.
    fn widen(self, a: Self::F) -> Self::D;
    /// Rounded to f32.
    fn narrow(self, a: Self::D) -> Self::F;

    /// Entry `index` of a non-empty table, lane by lane; an index past the end reads the last
    /// entry.
    fn gather(self, table: &[f32], index: Self::I) -> Self::F;
    /// Entry `index` (0 to 15) of a table, lane by lane.
    fn lookup_16(self, table: &[f32; 16], index: Self::I) -> Self::F;

    /// The bits of each lane.
    fn as_u32(self, a: Self::F) -> Self::I;
    /// `x` in every lane.
    fn splat_u32(self, x: u32) -> Self::I;
    /// The first `WIDTH` elements of `from`, which must have that many.
    fn load_u32(self, from: &[u32]) -> Self::I;
    /// Wrapping sum.
    fn add_u32(self, a: Self::I, b: Self::I) -> Self::I;
    /// Writes all lanes to the front of `to`, which must have `WIDTH` elements.
    fn store_u32(self, v: Self::I, to: &mut [u32]);
    /// `a > b`.
    fn gt_u32(self, a: Self::I, b: Self::I) -> Self::M;
    /// `if m { a } else { b }`.
    fn select_u32(self, m: Self::M, a: Self::I, b: Self::I) -> Self::I;
    /// Entry `index` of a non-empty table, lane by lane; an index past the end reads the last
    /// entry.
    fn gather_u32(self, table: &[u32], index: Self::I) -> Self::I;
    /// Entry `index` (0 to 15) of a table, lane by lane.
    fn lookup_16_u32(self, table: &[u32; 16], index: Self::I) -> Self::I;
    /// The upper 28 bits and the lower 4 bits.
    fn split_u32(self, a: Self::I) -> (Self::I, Self::I);
    /// Writes the lanes whose bit in `keep` is set to the front of `out`, in lane order; `out` has
    /// at least `WIDTH` elements and those after the kept ones are left in an unspecified state:
    /// vectors may be stored whole.
    fn compress(self, keep: u32, values: Self::I, out: &mut [u32]);
    /// As [`Self::compress`].
    fn pack(self, keep: u32, values: Self::F, out: &mut [f32]);

    /// The first `WIDTH` quads of `from`, which must have that many, as columns: element c of the
    /// result holds number c of every quad.
    fn load_quads(self, from: &[[f32; 4]]) -> [Self::F; 4];
    /// Quads of a non-empty table as columns: of each of the first `WIDTH` codes, of which there
    /// must be that many, the upper 28 bits are the index (see [`Self::split_u32`]). An index past
    /// the end reads the last quad.
    fn gather_quads(self, quads: &[[f32; 4]], codes: &[u32]) -> [Self::F; 4];
    /// Writes columns as the first `WIDTH` quads of `to`, which has that many: the reverse of
    /// [`Self::load_quads`].
    fn store_quads(self, columns: [Self::F; 4], to: &mut [[f32; 4]]);
    /// Sixes `sixes[pick[lane]]` of a non-empty table as columns; an index past the end reads the
    /// last one. `pick` has at least `WIDTH` elements.
    fn gather_sixes(self, sixes: &[[f32; 6]], pick: &[u32]) -> [Self::F; 6];
    /// Rows `rows[pick[lane]]` of a non-empty table as columns: element c of the result holds
    /// number c of every picked row; an index past the end reads the last row. `pick` has at least
    /// `WIDTH` elements.
    fn load_transposed(self, rows: &[[f32; ROW]], pick: &[u32]) -> [Self::F; ROW];
}

/// [`Lanes::compress`] and [`Lanes::pack`] lane by lane, where the CPU has no instruction for them.
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
#[inline(always)]
pub(super) fn pack_lanes<T: Copy, const N: usize>(keep: u32, lanes: [T; N], out: &mut [T]) {
    let out = &mut out[..N];
    // Four lanes seldom have one to keep, and packing them one by one takes longer than a test that
    // fills them.
    if keep == 0 {
        return;
    }
    let mut kept = 0;
    for (lane, value) in lanes.into_iter().enumerate() {
        // `kept` ≤ lane, so a value that isn't kept is overwritten or lies after the kept ones.
        out[kept] = value;
        kept += (keep >> lane & 1) as usize;
    }
}

/// [`Lanes::gather`] and [`Lanes::gather_u32`] lane by lane, where the CPU has no instruction for
/// them.
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
#[inline(always)]
pub(super) fn entries<T: Copy, const N: usize>(table: &[T], index: [u32; N]) -> [T; N] {
    let last = table.len() - 1;
    index.map(|entry| table[(entry as usize).min(last)])
}

/// The first and the last four numbers of sixes, lane by lane, for [`Lanes::gather_sixes`].
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
#[inline(always)]
pub(super) fn halves<'a>(sixes: &'a [[f32; 6]], pick: &[u32]) -> [[&'a [f32; 4]; 4]; 2] {
    let (pick, last) = (&pick[..4], sixes.len() - 1);
    let pairs = [0, 1, 2, 3].map(|lane: usize| {
        let six = &sixes[(pick[lane] as usize).min(last)];
        let ([front @ .., _, _], [_, _, back @ ..]) = (six, six);
        [front, back]
    });
    [pairs.map(|[front, _]| front), pairs.map(|[_, back]| back)]
}

/// The same by indices that a vector has clamped: doing it one by one would cost a tenth of a frame
/// of boxes.
///
/// # Safety
/// Each index is less than the number of sixes at the pointer.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(super) unsafe fn ends_of_sixes<const N: usize>(
    sixes: *const [f32; 6],
    index: [u32; N],
) -> [[*const f32; N]; 2] {
    let mut ends = [[sixes.cast(); N]; 2];
    for (lane, index) in index.into_iter().enumerate() {
        // SAFETY: the caller vouches for the index, and four of six numbers follow the first and
        // the third of them.
        unsafe {
            let six: *const f32 = sixes.add(index as usize).cast();
            (ends[0][lane], ends[1][lane]) = (six, six.add(2));
        }
    }
    ends
}

/// The greatest code that leads to a quad of a table with `len` quads, of which there is one at
/// least.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(super) fn last_code(len: usize) -> u32 {
    assert!(len > 0, "the table has a quad");
    (len.min(super::MOST_QUADS) as u32 - 1) << 4 | 15
}

/// Copies codes to `to`, none of them above `limit`.
#[cfg(target_arch = "x86_64")]
#[cold]
pub(super) fn clamp_codes<'a>(codes: &[u32], limit: u32, to: &'a mut [u32]) -> &'a [u32] {
    for (to, &code) in to.iter_mut().zip(codes) {
        *to = code.min(limit);
    }
    to
}

/// The quad that a code leads to: a quad of sixteen bytes has sixteen codes, so no shift is needed.
///
/// # Safety
/// The code is not above [`last_code`].
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(super) unsafe fn quad_of(quads: &[[f32; 4]], code: u32) -> *const f32 {
    // SAFETY: the caller vouches that the index is below the number of quads.
    unsafe { quads.as_ptr().byte_add((code & !15) as usize) }.cast()
}

/// Implements the arithmetic operators of a tier's vector by its intrinsics.
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
macro_rules! float_operators {
    ($vector:ident, $add:ident, $sub:ident, $mul:ident) => {
        float_operators!(@one $vector, Add, add, $add);
        float_operators!(@one $vector, Sub, sub, $sub);
        float_operators!(@one $vector, Mul, mul, $mul);
    };
    (@one $vector:ident, $trait:ident, $method:ident, $intrinsic:ident) => {
        impl std::ops::$trait for $vector {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: a vector exists only if its token did, and the token proves the CPU
                // feature.
                Self(unsafe { $intrinsic(self.0, other.0) })
            }
        }
    };
}
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
pub(super) use float_operators;

/// Implements the arithmetic operators of a tier's f64, of which two vectors have as many as one of
/// f32 has, by its intrinsics.
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
macro_rules! double_operators {
    ($vector:ident, $add:ident, $sub:ident, $mul:ident, $div:ident) => {
        double_operators!(@one $vector, Add, add, $add);
        double_operators!(@one $vector, Sub, sub, $sub);
        double_operators!(@one $vector, Mul, mul, $mul);
        double_operators!(@one $vector, Div, div, $div);
    };
    (@one $vector:ident, $trait:ident, $method:ident, $intrinsic:ident) => {
        impl std::ops::$trait for $vector {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let (Self([low, high]), Self([other_low, other_high])) = (self, other);
                // SAFETY: a vector exists only if its token did, and the token proves the CPU
                // feature.
                Self(unsafe { [$intrinsic(low, other_low), $intrinsic(high, other_high)] })
            }
        }
    };
}
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
pub(super) use double_operators;
