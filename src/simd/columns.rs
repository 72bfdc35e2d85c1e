//! Sixteen records as columns, whatever the tier's width: records are read one body at a time, and
//! computed with a vector at a time.

use super::{LANES, Lanes, MAX_WIDTH, ROW};

/// Sixteen quads, the first ones of a slice that has as many: column c holds number c of each.
#[inline(always)]
#[must_use]
pub fn quads_in_columns<L: Lanes>(l: L, quads: &[[f32; 4]]) -> [[f32; MAX_WIDTH]; 4] {
    let mut columns = [[0.0; MAX_WIDTH]; 4];
    for start in (0..MAX_WIDTH).step_by(L::WIDTH) {
        for (column, lanes) in columns.iter_mut().zip(l.load_quads(&quads[start..])) {
            l.store(lanes, &mut column[start..]);
        }
    }
    columns
}

/// Writes sixteen rows as columns; sixteen columns become rows the same way.
#[inline(always)]
pub fn turn_rows<L: Lanes>(l: L, rows: &[[f32; ROW]; MAX_WIDTH], to: &mut [[f32; MAX_WIDTH]; ROW]) {
    for start in (0..MAX_WIDTH).step_by(L::WIDTH) {
        let parts = l.load_transposed(rows, &LANES[start..]);
        for (column, part) in to.iter_mut().zip(parts) {
            l.store(part, &mut column[start..]);
        }
    }
}
