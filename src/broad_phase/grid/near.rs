//! Pairs within a level: each body against the rest of its own cell, the next cell, and four rows
//! of three cells.
//!
//! These are half of the 27 cells around it. Bodies in the other half find this body instead. Each
//! row of three cells is one contiguous run of slots, found by one load of four neighbouring table
//! entries.

use std::ops::Range;

use super::cells::TableLayout;
use super::level::GridLevel;
use super::{Grid, GridPart, PartSearch};
use crate::broad_phase::{BlockPage, RunWriter};

impl Grid {
    /// Lists pairs of which one slot is in the search's first block and the other in its level.
    #[inline(always)]
    pub(super) fn near(&self, part: &GridPart, search: &mut PartSearch, page: &mut BlockPage) {
        let (level, bodies) = (&self.levels[part.level], search.block());
        let pen = page.restart(bodies.start);
        match (level.cells.layout(), level.cells.forward().try_into()) {
            (TableLayout::Box, Ok(rows)) => self.in_space(level, bodies, rows, pen),
            (TableLayout::Box, Err(_)) => self.in_box(level, bodies, pen),
            (TableLayout::Wrapped, _) => self.wrapped(level, bodies, pen),
        }
        search.next_block();
    }

    /// In a box of more than one cell per axis. `rows` are those of the cells.
    #[inline(always)]
    fn in_space(
        &self,
        level: &GridLevel,
        bodies: Range<usize>,
        rows: [u32; 4],
        mut pen: RunWriter<'_>,
    ) {
        // The table from each row on, all of one length, so that one bounds check of a cell covers
        // all runs.
        let starts = level.starts.as_slice();
        let length = starts.len() - (rows[3] as usize - 1);
        let own = &starts[..length];
        let tables = rows.map(|row| &starts[row as usize - 1..][..length]);
        for (lane, &cell) in self.slot_cells[bodies.clone()].iter().enumerate() {
            let cell = cell as usize;
            let ends = tables.map(|table| table[cell + 3]);
            pen.push(lane, (bodies.start + lane) as u32 + 1..own[cell + 2]);
            for (table, end) in tables.iter().zip(ends) {
                pen.push(lane, table[cell]..end);
            }
        }
        pen.done();
    }

    /// In a plane or on a line of cells.
    #[inline(always)]
    fn in_box(&self, level: &GridLevel, bodies: Range<usize>, mut pen: RunWriter<'_>) {
        let starts = level.starts.as_slice();
        for (lane, &cell) in self.slot_cells[bodies.clone()].iter().enumerate() {
            pen.push(lane, (bodies.start + lane) as u32 + 1..starts[cell as usize + 2]);
            for &row in level.cells.forward() {
                let at = (cell + row) as usize;
                pen.push(lane, starts[at - 1]..starts[at + 2]);
            }
        }
        pen.done();
    }

    /// As in a box, but a run may continue at the table's beginning after its end.
    #[inline(always)]
    fn wrapped(&self, level: &GridLevel, bodies: Range<usize>, mut pen: RunWriter<'_>) {
        let (starts, mask) = (level.starts.as_slice(), level.cells.mask());
        let table = mask as usize + 1;
        for (lane, &cell) in self.slot_cells[bodies.clone()].iter().enumerate() {
            let own_end = cell as usize + 2;
            let next = (bodies.start + lane) as u32 + 1;
            pen.push(lane, next..starts[own_end.min(table)]);
            if own_end > table {
                pen.push(lane, starts[0]..starts[1]);
            }
            for &row in level.cells.forward() {
                let at = (cell.wrapping_add(row).wrapping_sub(1) & mask) as usize;
                let end = at + 3;
                pen.push(lane, starts[at]..starts[end.min(table)]);
                if end > table {
                    pen.push(lane, starts[0]..starts[end - table]);
                }
            }
        }
        pen.done();
    }
}
