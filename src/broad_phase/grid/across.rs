//! Pairs of bodies in two levels: either side may look for the other, whichever is cheaper.

use std::ops::Range;

use super::Grid;
use super::cells::Layout;
use super::level::Level;
use super::near::hand_over;
use crate::broad_phase::{BLOCK_BODIES, Block, FirstTest};
use crate::rounding::widen;
use crate::simd::Lanes;

/// How the bodies of one level find those of another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Search {
    /// Each looks into the cells around it.
    Cells,
    /// Each is tested against all.
    All,
}

/// Bodies that a look at one row costs as much as testing in a long run (10 cycles, and 0.7 a body).
const ROW_COST: f64 = 15.0;

/// The cheapest way to the pairs of two levels: which one seeks (true: `a`), and how. By bodies and sizes alone.
pub fn plan(a: &Level, b: &Level) -> (bool, Search) {
    let all = a.range.len() as f64 * b.range.len() as f64;
    let mut best = (a.range.len() < b.range.len(), Search::All, all);
    for (seeker, target, is_a) in [(a, b, true), (b, a, false)] {
        let across = 2.0 * (seeker.widest + target.widest) / target.cells.size();
        // A wrapped table serves only what spans at most three cells: there all rows are sure to differ.
        if target.cells.layout() == Layout::Wrapped && across >= 2.0 {
            continue;
        }
        let cells = |axis: usize| (across + 1.0).min(f64::from(target.cells.count()[axis]));
        let found = all
            * (0..3)
                .map(|i| cells(i) / f64::from(target.cells.count()[i]))
                .product::<f64>();
        let cost = seeker.range.len() as f64 * cells(1) * cells(2) * ROW_COST + found;
        if cost < best.2 {
            best = (is_a, Search::Cells, cost);
        }
    }
    (best.0, best.1)
}

impl Grid {
    /// Pairs of a slot in `seekers` and one in the level `target`, to which the seekers don't belong.
    #[inline(always)]
    pub(super) fn across<L: Lanes>(
        &self,
        l: L,
        seekers: Range<usize>,
        target: &Level,
        block: &mut Block,
        test: &mut impl FirstTest,
    ) {
        let starts = target.starts.as_slice();
        let table = target.cells.table_len();
        let mut first = seekers.start;
        while first < seekers.end {
            let mut pen = block.restart(first);
            for i in first..seekers.end.min(first + BLOCK_BODIES) {
                let ball = &self.slots.balls[i];
                let reach = f64::from(widen(ball[3])) + target.widest;
                let Some([lo, hi]) = target.cells.around(ball, reach) else {
                    continue;
                };
                for z in lo[2]..=hi[2] {
                    for y in lo[1]..=hi[1] {
                        if pen.is_full(2) {
                            pen.done();
                            hand_over(l, block, test);
                            pen = block.restart(first);
                        }
                        let row = target.cells.index([lo[0], y, z]) as usize;
                        let end = row + (hi[0] - lo[0]) as usize + 1;
                        pen.push(i - first, starts[row]..starts[end.min(table)]);
                        if end > table {
                            pen.push(i - first, starts[0]..starts[end - table]);
                        }
                    }
                }
            }
            pen.done();
            hand_over(l, block, test);
            first += BLOCK_BODIES;
        }
    }
}
