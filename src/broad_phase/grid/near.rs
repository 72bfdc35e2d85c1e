//! Pairs within a level: a body against the rest of its own cell, the next cell, and four rows of three cells.
//!
//! These are half of the 27 cells around it; the other half finds the body in turn. Each row of three is one contiguous
//! run of slots, read off the table by one load of four neighbouring entries.

use std::ops::Range;

use super::Grid;
use super::cells::Layout;
use super::level::Level;
use crate::broad_phase::{BLOCK_BODIES, Block, FirstTest};
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
            block.restart(first);
            match level.cells.layout() {
                Layout::Box => self.near_in_box(l, level, bodies, block, test),
                Layout::Wrapped => self.near_wrapped(l, level, bodies, block, test),
            }
            test.block(l, block);
            first += BLOCK_BODIES;
        }
    }

    #[inline(always)]
    fn near_in_box<L: Lanes>(
        &self,
        l: L,
        level: &Level,
        bodies: Range<usize>,
        block: &mut Block,
        test: &mut impl FirstTest,
    ) {
        let starts = level.starts.as_slice();
        for (i, &cell) in bodies.clone().zip(&self.slot_cells[bodies.clone()]) {
            make_room(l, block, test);
            candidates(l, i, i as u32 + 1..starts[cell as usize + 2], block, test);
            for &row in level.cells.forward() {
                if let Some(&[start, _, _, end]) = starts[(cell + row) as usize - 1..].first_chunk()
                {
                    candidates(l, i, start..end, block, test);
                }
            }
        }
    }

    /// As in a box, but a run may cross the table's end and go on at its beginning.
    #[inline(always)]
    fn near_wrapped<L: Lanes>(
        &self,
        l: L,
        level: &Level,
        bodies: Range<usize>,
        block: &mut Block,
        test: &mut impl FirstTest,
    ) {
        let (starts, mask) = (level.starts.as_slice(), level.cells.mask());
        let table = mask as usize + 1;
        for (i, &cell) in bodies.clone().zip(&self.slot_cells[bodies.clone()]) {
            make_room(l, block, test);
            let own_end = cell as usize + 2;
            candidates(l, i, i as u32 + 1..starts[own_end.min(table)], block, test);
            if own_end > table {
                candidates(l, i, starts[0]..starts[1], block, test);
            }
            for &row in level.cells.forward() {
                let at = (cell.wrapping_add(row).wrapping_sub(1) & mask) as usize;
                let end = (at + 3).min(table);
                candidates(l, i, starts[at]..starts[end], block, test);
                if at + 3 > table {
                    candidates(l, i, starts[0]..starts[at + 3 - table], block, test);
                }
            }
        }
    }
}

/// Empties the block if one more body's runs might not find room in it.
#[inline(always)]
pub(super) fn make_room<L: Lanes>(l: L, block: &mut Block, test: &mut impl FirstTest) {
    /// Own row, four others, and as many again where runs are cut in two.
    const RUNS: usize = 10;
    if block.is_full(RUNS) {
        test.block(l, block);
        block.restart(block.first());
    }
}

/// Slot `i` against a run: into the block, or at once when it is long.
#[inline(always)]
pub(super) fn candidates<L: Lanes>(
    l: L,
    i: usize,
    run: Range<u32>,
    block: &mut Block,
    test: &mut impl FirstTest,
) {
    let length = run.len();
    if length <= Block::LONGEST_RUN {
        block.push(i - block.first(), run.start, length);
    } else {
        test.run(l, i, run.start as usize..run.end as usize);
    }
}
