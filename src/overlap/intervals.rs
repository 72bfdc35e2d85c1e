//! The test of world-aligned volumes (AABB, k-DOP): two are apart iff on some direction lo_i > hi_j
//! or lo_j > hi_i.
//!
//! The ends were rounded outward when they were updated, so the comparison is exact.

use std::ops::Range;

use crate::broad_phase::{Block, SlotTest, list_slots};
use crate::simd::{Lanes, MAX_WIDTH};
use crate::threads::Threads;

/// The fewest bodies for whose columns it pays to wake another thread.
const FEWEST_SHARED_BODIES: usize = 1 << 14;

/// World-aligned slabs in the pair finder's slot order: one column per direction, each padded by
/// [`MAX_WIDTH`] finite entries.
#[derive(Clone, Debug, Default)]
pub struct IntervalSlots {
    /// Lower ends, `lo[direction][slot]`.
    pub lo: Vec<Vec<f32>>,
    /// Upper ends, `hi[direction][slot]`.
    pub hi: Vec<Vec<f32>>,
}

impl IntervalSlots {
    /// Gathers the slabs of all bodies into slot order. `ends[place·slabs + slab]` = [lo, hi], and
    /// `order` has the place in each slot.
    pub fn fill(&mut self, pool: &Threads, order: &[u32], ends: &[[f32; 2]]) {
        let slabs = ends.len().checked_div(order.len()).unwrap_or(0);
        self.lo.resize(slabs, Vec::new());
        self.hi.resize(slabs, Vec::new());
        for (side, columns) in [&mut self.lo, &mut self.hi].into_iter().enumerate() {
            let fill = |slab: usize, column: &mut Vec<f32>| {
                column.clear();
                let end = |&place: &u32| ends[place as usize * slabs + slab][side];
                column.extend(order.iter().map(end));
                column.resize(order.len() + MAX_WIDTH, 0.0);
            };
            if order.len() >= FEWEST_SHARED_BODIES {
                pool.each(columns, fill);
            } else {
                let columns = columns.iter_mut().enumerate();
                columns.for_each(|(slab, column)| fill(slab, column));
            }
        }
    }
}

impl SlotTest for IntervalSlots {
    #[inline(always)]
    fn run<L: Lanes>(&self, l: L, i: usize, run: Range<usize>, hits: &mut [u32]) -> usize {
        let mut found = 0;
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
                found += list_slots(l, alive, start, &mut hits[found..]);
            }
            start += L::WIDTH;
        }
        found
    }

    #[inline(always)]
    fn block<L: Lanes>(&self, l: L, block: &Block<'_>, hits: &mut [u32]) -> usize {
        let (codes, count) = (block.padded_codes(), block.codes().len());
        let (mut start, mut found) = (0, 0);
        while start < count {
            let code = l.load_u32(&codes[start..]);
            let (j, lane) = l.split_u32(code);
            let i = l.add_u32(lane, l.splat_u32(block.first() as u32));
            let mut alive = l.bits(l.first(count - start));
            for (lo, hi) in self.lo.iter().zip(&self.hi) {
                let above = l.gt(l.gather(lo, j), l.gather(hi, i));
                let below = l.gt(l.gather(lo, i), l.gather(hi, j));
                alive &= !l.bits(above | below);
                if alive == 0 {
                    break;
                }
            }
            l.compress(alive, code, &mut hits[found..]);
            found += alive.count_ones() as usize;
            start += L::WIDTH;
        }
        found
    }
}
