//! Pairs within a level: a body against the rest of its own cell, the next cell, and four rows of three cells.
//!
//! These are half of the 27 cells around it; the other half finds the body in turn. Each row of three is one contiguous
//! run of slots, read off the table by one load of four neighbouring entries.

use std::ops::Range;

use super::Grid;
use super::cells::Layout;
use super::level::Level;
use crate::broad_phase::{BLOCK_BODIES, Block, FirstTest, Pen};
use crate::simd::Lanes;

impl Grid {
    /// Pairs of which one slot is in `range` and the other in the same level.
    #[inline(always)]
    pub(super) fn near<L: Lanes>(
        &self,
        l: L,
        level: &Level,
        range: Range<usize>,
        block: &mut Block,
        test: &mut impl FirstTest,
    ) {
        let mut first = range.start;
        while first < range.end {
            let bodies = first..range.end.min(first + BLOCK_BODIES);
            let pen = block.restart(first);
            let rows = level.cells.forward();
            match (level.cells.layout(), rows.first_chunk::<4>()) {
                (Layout::Box, Some(rows)) => self.in_box(level, bodies, rows, pen),
                (Layout::Box, None) => self.in_box(level, bodies, rows, pen),
                (Layout::Wrapped, _) => self.wrapped(level, bodies, pen),
            }
            hand_over(l, block, test);
            first += BLOCK_BODIES;
        }
    }

    /// `rows` is a slice, or an array whose length the compiler knows.
    #[inline(always)]
    fn in_box<'a>(
        &self,
        level: &Level,
        bodies: Range<usize>,
        rows: impl IntoIterator<Item = &'a u32> + Copy,
        mut pen: Pen<'_>,
    ) {
        let starts = level.starts.as_slice();
        for (i, &cell) in bodies.clone().zip(&self.slot_cells[bodies]) {
            pen.push(i, i as u32 + 1..starts[cell as usize + 2]);
            for &row in rows {
                let at = (cell + row) as usize;
                if let Some(&[start, _, _, end]) = starts.get(at - 1..at + 3) {
                    pen.push(i, start..end);
                }
            }
        }
        pen.done();
    }

    /// As in a box, but a run may cross the table's end and go on at its beginning.
    #[inline(always)]
    fn wrapped(&self, level: &Level, bodies: Range<usize>, mut pen: Pen<'_>) {
        let (starts, mask) = (level.starts.as_slice(), level.cells.mask());
        let table = mask as usize + 1;
        for (i, &cell) in bodies.clone().zip(&self.slot_cells[bodies]) {
            let own_end = cell as usize + 2;
            pen.push(i, i as u32 + 1..starts[own_end.min(table)]);
            if own_end > table {
                pen.push(i, starts[0]..starts[1]);
            }
            for &row in level.cells.forward() {
                let at = (cell.wrapping_add(row).wrapping_sub(1) & mask) as usize;
                let end = at + 3;
                pen.push(i, starts[at]..starts[end.min(table)]);
                if end > table {
                    pen.push(i, starts[0]..starts[end - table]);
                }
            }
        }
        pen.done();
    }
}

/// Hands a block's candidates to the test.
#[inline(always)]
pub(super) fn hand_over<L: Lanes>(l: L, block: &Block, test: &mut impl FirstTest) {
    test.block(l, block);
    for (i, run) in block.long_runs() {
        test.run(l, i, run);
    }
}
