//! Support of an or-DOP in any direction, bounded from its slabs alone by weak duality (design, section 4.5).
//!
//! If e = Σ λᵢdᵢ with λ ≥ 0, then h(e) ≤ Σ λᵢhᵢ, the dual of the linear program that maximises e·x over the slabs. The
//! multipliers below are the optimal ones for a DOP whose slabs are all tight against a centrally placed ball, written in
//! |e| = (a, b, c) and without sorting, so that lanes never diverge; a slab whose turn it is not gets λ = 0.
//! No vertices are needed, rounding keeps λ ≥ 0, and the bound reports .9 % more pairs than the vertices would.

use super::table::{DIAGONALS, PAIRS};
use crate::simd::Lanes;

/// Slab ends by group and octant, one shape a lane or one for all.
pub trait SlabEnds<L: Lanes>: Copy {
    /// The end of `group` that each lane's octant faces.
    fn facing(&self, l: L, group: usize, octant: L::I) -> L::F;
    /// The end of `group` at a fixed octant: `plus` where `sign` is not negative, else `minus`.
    fn own(&self, l: L, group: usize, plus: usize, minus: usize, sign: L::F) -> L::F;
}

/// Upper bound of the support in direction e, in the coordinates of the DOP's own basis.
#[inline(always)]
pub fn support<L: Lanes, const K: usize>(l: L, slabs: &impl SlabEnds<L>, e: [L::F; 3]) -> L::F {
    let octant = l.octant(e[0], e[1], e[2]);
    let size = [l.abs(e[0]), l.abs(e[1]), l.abs(e[2])];
    match K {
        6 => {
            (size[0] * slabs.facing(l, 0, octant) + size[1] * slabs.facing(l, 1, octant))
                + size[2] * slabs.facing(l, 2, octant)
        }
        14 => support_14(l, slabs, e, octant, size),
        18 => support_18(l, slabs, octant, size),
        _ => support_26(l, slabs, octant, size),
    }
}

/// Axes and cube diagonals: ½(median + low) on the octant's own diagonal, the rest of the lower two on the diagonal that
/// is bent over the lowest coordinate, and the lead of the largest on its axis.
#[inline(always)]
fn support_14<L: Lanes>(
    l: L,
    slabs: &impl SlabEnds<L>,
    e: [L::F; 3],
    octant: L::I,
    size: [L::F; 3],
) -> L::F {
    let (low, [ab, ac, bc]) = minima(l, size);
    let (half, minus) = (l.splat(0.5), l.splat(-0.0));
    // The median is the largest of the pairwise minima.
    let median = l.max(l.max(ab, ac), bc);
    let over_a = l.octant(l.flip_sign(e[0], minus), e[1], e[2]);
    let over_b = l.octant(e[0], l.flip_sign(e[1], minus), e[2]);
    let over_c = l.octant(e[0], e[1], l.flip_sign(e[2], minus));
    let base = (half * (median + low)) * slabs.facing(l, DIAGONALS, octant);
    let bent = ((half * (ab - low)) * slabs.facing(l, DIAGONALS, over_c)
        + (half * (ac - low)) * slabs.facing(l, DIAGONALS, over_b))
        + (half * (bc - low)) * slabs.facing(l, DIAGONALS, over_a);
    (base + bent) + leads(l, slabs, octant, size)
}

/// Axes and face diagonals: where no coordinate exceeds the sum of the others, face diagonals alone; else two of them
/// and the excess on its axis.
#[inline(always)]
fn support_18<L: Lanes>(
    l: L,
    slabs: &impl SlabEnds<L>,
    octant: L::I,
    [a, b, c]: [L::F; 3],
) -> L::F {
    let (half, zero) = (l.splat(0.5), l.splat(0.0));
    let (ca, cb, cc) = (l.min(a, b + c), l.min(b, a + c), l.min(c, a + b));
    let ab = l.max(half * ((ca + cb) - cc), zero) * slabs.facing(l, PAIRS, octant);
    let ac = l.max(half * ((ca + cc) - cb), zero) * slabs.facing(l, PAIRS + 1, octant);
    let bc = l.max(half * ((cb + cc) - ca), zero) * slabs.facing(l, PAIRS + 2, octant);
    let axes = ((a - ca) * slabs.facing(l, 0, octant) + (b - cb) * slabs.facing(l, 1, octant))
        + (c - cc) * slabs.facing(l, 2, octant);
    ((ab + ac) + bc) + axes
}

/// All groups: the lowest coordinate on the cube diagonal, the median's lead over it on a face diagonal, and the
/// largest's lead on its axis.
#[inline(always)]
fn support_26<L: Lanes>(l: L, slabs: &impl SlabEnds<L>, octant: L::I, size: [L::F; 3]) -> L::F {
    let (low, [ab, ac, bc]) = minima(l, size);
    let pairs = ((ab - low) * slabs.facing(l, PAIRS, octant)
        + (ac - low) * slabs.facing(l, PAIRS + 1, octant))
        + (bc - low) * slabs.facing(l, PAIRS + 2, octant);
    (low * slabs.facing(l, DIAGONALS, octant) + pairs) + leads(l, slabs, octant, size)
}

/// The lowest coordinate, and the lower of each pair.
#[inline(always)]
fn minima<L: Lanes>(l: L, [a, b, c]: [L::F; 3]) -> (L::F, [L::F; 3]) {
    let ab = l.min(a, b);
    (l.min(ab, c), [ab, l.min(a, c), l.min(b, c)])
}

/// The axes' part where diagonals take the rest: the lead of the largest coordinate over the second.
#[inline(always)]
fn leads<L: Lanes>(l: L, slabs: &impl SlabEnds<L>, octant: L::I, [a, b, c]: [L::F; 3]) -> L::F {
    let zero = l.splat(0.0);
    let (lead_a, lead_b) = (l.max(a - l.max(b, c), zero), l.max(b - l.max(a, c), zero));
    let lead_c = l.max(c - l.max(a, b), zero);
    (lead_a * slabs.facing(l, 0, octant) + lead_b * slabs.facing(l, 1, octant))
        + lead_c * slabs.facing(l, 2, octant)
}
