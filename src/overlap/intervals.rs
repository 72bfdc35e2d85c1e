//! World-aligned volumes (AABB, k-DOP): cull iff on some direction lo_i > hi_j or lo_j > hi_i.
//!
//! The ends were rounded outward when they were re-fitted, so the comparison itself is exact.

use std::ops::Range;

use crate::pairs::PairList;
use crate::simd::Lanes;

/// World-aligned slabs in the pair finder's slot order: one column a direction, each padded by
/// [`MAX_WIDTH`](crate::simd::MAX_WIDTH) finite entries.
#[derive(Clone, Debug, Default)]
pub struct IntervalSlots {
    /// Lower ends, `lo[direction][slot]`.
    pub lo: Vec<Vec<f32>>,
    /// Upper ends, `hi[direction][slot]`.
    pub hi: Vec<Vec<f32>>,
    /// Which body stands in the slot.
    pub body: Vec<u32>,
}

impl IntervalSlots {
    /// Appends to `out` the pairs of slot `i` and each slot of `run` whose slabs all overlap, as body indices, lower first.
    #[inline(always)]
    pub fn test_run<L: Lanes>(&self, l: L, i: usize, run: Range<usize>, out: &mut PairList) {
        let body_i = l.splat_u32(self.body[i]);
        let mut start = run.start;
        while start < run.end {
            let mut alive = l.bits(l.first(run.end - start));
            for (lo, hi) in self.lo.iter().zip(&self.hi) {
                let above = l.gt(l.load(&lo[start..]), l.splat(hi[i]));
                let below = l.gt(l.splat(lo[i]), l.load(&hi[start..]));
                alive &= !l.bits(above | below);
                if alive == 0 {
                    break;
                }
            }
            if alive != 0 {
                let body_j = l.load_u32(&self.body[start..]);
                let (first, second) = out.room(L::WIDTH);
                l.compress(alive, l.min_u32(body_i, body_j), first);
                l.compress(alive, l.max_u32(body_i, body_j), second);
                out.advance(alive.count_ones() as usize);
            }
            start += L::WIDTH;
        }
    }
}
