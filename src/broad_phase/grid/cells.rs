//! Cells: which cell a ball's centre is in, and where the cells around it are in the table.
//!
//! A coordinate x is in the cell k = round((x − o)/c), in f64. If the first test can report two
//! balls, their centres differ by less than the cell size c, and therefore by at most one cell per
//! coordinate: with c ≥ 2R(1 + 2⁻¹⁶), where R is the largest radius,
//! [widened](crate::rounding::widen), quotients differ by less than 1 − 2⁻¹⁷, and below 2³⁰ the
//! three roundings of a quotient take 2⁻²² each.
//!
//! The table has cells in rows along x, and rows in layers: index = k_x + A·k_y + B·k_z. If the
//! bodies' box has few cells, A and B leave one empty cell after each row and one empty row after
//! each layer, so that neighbours across the border exist and are empty. If the box is mostly empty
//! (a diagonal line, clusters far apart), indices are taken modulo a power of two instead, with A
//! and B spread evenly over it. Different cells may then share a table entry, which adds false
//! candidates but loses none.

use crate::broad_phase::{BLOCK_BODIES, BallBounds};
use crate::rounding::widen;
use crate::simd::{Lanes, quads_in_columns};

/// Adding this to an f64 below 2³¹ rounds it to an integer in the low 32 bits.
const TO_INTEGER: f64 = 1.5 * (1u64 << 52) as f64;

/// Cells along the longest side: quotients stay below, see above.
const MOST_CELLS: f64 = (1u32 << 29) as f64;

/// The most cells per body in a table, apart from a constant for small scenes.
const CELLS_PER_BODY: f64 = 6.0;
const SPARE_CELLS: f64 = 512.0;

/// The rows that a body searches in addition to its own: (0, +1, 0) and (0, −1…+1, +1). Bodies in
/// the other neighbouring rows search this one's row instead.
const FORWARD_ROWS: [[i32; 2]; 4] = [[1, 0], [-1, 1], [0, 1], [1, 1]];

/// The most cells per axis that one search in a wrapped table may span. With three, all rows are
/// disjoint in a table of any length; with four, rows would overlap in short tables and return some
/// bodies twice.
pub const WRAPPED_SPAN: u32 = 3;

/// How cells are mapped to table entries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableLayout {
    /// Every cell of the bodies' box has its own entry.
    Box,
    /// Table entries are cells modulo the table's length.
    Wrapped,
}

/// Cells of one size. This is the only code that computes the cell of a coordinate, whether to
/// place a body, to count cells or to search from another level. Each step rounds, but none
/// reverses an order: a coordinate between two others is in a cell between theirs, and no
/// coordinate is in a cell beyond that of the farthest one.
#[derive(Clone, Copy, Debug)]
struct CellRule {
    origin: [f64; 3],
    inverse: f64,
}

impl CellRule {
    /// The number of a coordinate's cell along an axis, plus [`TO_INTEGER`]: an exact f64, ordered
    /// as the numbers are, whose low 32 bits are the number.
    #[inline(always)]
    fn cell(&self, axis: usize, x: f64) -> f64 {
        (x - self.origin[axis]) * self.inverse + TO_INTEGER
    }

    /// How many cells there are up to that of `hi`, the largest centre coordinates.
    fn count(&self, hi: [f64; 3]) -> [u32; 3] {
        std::array::from_fn(|axis| number(self.cell(axis, hi[axis]).max(TO_INTEGER)) + 1)
    }
}

/// The number of a cell.
#[inline(always)]
fn number(cell: f64) -> u32 {
    cell.to_bits() as u32
}

/// The cells of one level.
#[derive(Clone, Debug)]
pub struct Cells {
    rule: CellRule,
    size: f64,
    count: [u32; 3],
    row: u32,
    layer: u32,
    mask: u32,
    table: usize,
    forward: [u32; 4],
    forward_len: usize,
}

impl Cells {
    /// Cells for `bodies` balls within the bounds, as large as the largest radius requires; in the
    /// layout of a box they are larger if the table would be too long.
    pub fn fit(bounds: &BallBounds, bodies: usize, layout: TableLayout) -> Self {
        // Bounds that aren't finite come from bodies that break the contract. They get some cells,
        // so that this ends.
        let [lo, hi] = [bounds.lo, bounds.hi].map(|end| end.map(finite));
        let longest = (0..3).map(|i| hi[i] - lo[i]).fold(0.0, f64::max);
        let needed = 2.0 * f64::from(widen(bounds.widest)) * (1.0 + 1.0 / 65536.0);
        let mut size = needed.max(longest / MOST_CELLS);
        let rule = |size: f64| CellRule { origin: lo, inverse: 1.0 / size };
        if layout == TableLayout::Box {
            let most = CELLS_PER_BODY * bodies as f64 + SPARE_CELLS;
            let fits = |size: f64| {
                let count = rule(size).count(hi);
                count.map(|n| f64::from(n) + 1.0).iter().product::<f64>() <= most
            };
            while !fits(2.0 * size) {
                size *= 2.0;
            }
            while !fits(size) {
                size *= 1.0625;
            }
        }
        let rule = rule(size);
        let count = rule.count(hi);
        let mut cells = Self {
            rule,
            size,
            count,
            row: 0,
            layer: 0,
            mask: u32::MAX,
            table: 0,
            forward: [0; 4],
            forward_len: 0,
        };
        match layout {
            TableLayout::Box => cells.lay_out_box(),
            TableLayout::Wrapped => cells.wrap(bodies),
        }
        cells
    }

    fn lay_out_box(&mut self) {
        let [nx, ny, nz] = self.count;
        self.row = nx + 1;
        self.layer = self.row * (ny + u32::from(ny > 1));
        self.take_forward(|[y, z]| (y == 0 || ny > 1) && (z == 0 || nz > 1));
        let last = self.index([nx - 1, ny - 1, nz - 1]);
        let reach = self.forward().last().copied().unwrap_or(0);
        self.table = (last + reach) as usize + 2;
    }

    /// The two-dimensional analogue of the golden ratio spreads the multiples of A and B most
    /// evenly.
    fn wrap(&mut self, bodies: usize) {
        let table = (4 * bodies).next_power_of_two().max(64);
        self.row = (table as f64 * 0.754_877_666_246_693) as u32 | 1;
        self.layer = (table as f64 * 0.569_840_290_998_053) as u32 | 1;
        self.mask = table as u32 - 1;
        self.table = table;
        self.take_forward(|_| true);
    }

    fn take_forward(&mut self, has: impl Fn([i32; 2]) -> bool) {
        for step in FORWARD_ROWS.into_iter().filter(|&step| has(step)) {
            let [y, z] = step.map(|k| k as u32);
            let offset = y.wrapping_mul(self.row).wrapping_add(z.wrapping_mul(self.layer));
            self.forward[self.forward_len] = offset & self.mask;
            self.forward_len += 1;
        }
    }

    /// Cells in the table.
    pub fn table_len(&self) -> usize {
        self.table
    }

    /// The cell size.
    pub fn size(&self) -> f64 {
        self.size
    }

    /// Cells along each side of the bodies' box.
    pub fn count(&self) -> [u32; 3] {
        self.count
    }

    /// The table index's mask: all ones for a box.
    pub fn mask(&self) -> u32 {
        self.mask
    }

    /// Index offsets of the rows that a body searches in addition to its own, ascending for a box.
    #[inline(always)]
    pub fn forward(&self) -> &[u32] {
        &self.forward[..self.forward_len]
    }

    /// The layout.
    pub fn layout(&self) -> TableLayout {
        if self.mask == u32::MAX { TableLayout::Box } else { TableLayout::Wrapped }
    }

    /// How many cells per axis a search may span.
    #[inline(always)]
    pub fn most_span(&self) -> u32 {
        match self.layout() {
            TableLayout::Box => u32::MAX,
            TableLayout::Wrapped => WRAPPED_SPAN,
        }
    }

    /// The highest table index of a centre. In the layout of a box, all cells after it are empty.
    pub fn last(&self) -> u32 {
        match self.layout() {
            TableLayout::Box => self.index(self.count.map(|n| n - 1)),
            TableLayout::Wrapped => self.mask,
        }
    }

    /// Table index of a cell.
    #[inline(always)]
    pub fn index(&self, [x, y, z]: [u32; 3]) -> u32 {
        let (row, layer) = (y.wrapping_mul(self.row), z.wrapping_mul(self.layer));
        x.wrapping_add(row).wrapping_add(layer) & self.mask
    }

    /// Computes the table index of each ball's cell.
    #[inline(always)]
    pub fn assign<L: Lanes>(&self, l: L, balls: &[[f32; 4]], cells: &mut [u32]) {
        let (chunks, rest) = balls.as_chunks::<BLOCK_BODIES>();
        let (cell_chunks, cell_rest) = cells.as_chunks_mut::<BLOCK_BODIES>();
        for (chunk, cells) in chunks.iter().zip(cell_chunks) {
            *cells = self.assign_block(l, chunk);
        }
        let mut last = [[0.0; 4]; BLOCK_BODIES];
        last[..rest.len()].copy_from_slice(rest);
        cell_rest.copy_from_slice(&self.assign_block(l, &last)[..rest.len()]);
    }

    /// Plain loops over sixteen numbers, which the compiler turns into vectors of the tier.
    #[inline(always)]
    fn assign_block<L: Lanes>(
        &self,
        l: L,
        balls: &[[f32; 4]; BLOCK_BODIES],
    ) -> [u32; BLOCK_BODIES] {
        let columns = quads_in_columns(l, balls);
        let mut cells = [0u32; BLOCK_BODIES];
        for (axis, stride) in [1, self.row, self.layer].into_iter().enumerate() {
            for (cell, &x) in cells.iter_mut().zip(&columns[axis]) {
                let k = number(self.rule.cell(axis, f64::from(x)));
                *cell = cell.wrapping_add(k.wrapping_mul(stride));
            }
        }
        for cell in &mut cells {
            *cell &= self.mask;
        }
        cells
    }

    /// The lowest and highest cell per axis that may contain a centre within `reach` of the ball's
    /// along that axis; `None` if all centres are farther away.
    #[inline(always)]
    pub fn around(&self, ball: &[f32; 4], reach: f64) -> Option<[[u32; 3]; 2]> {
        let (mut lowest, mut highest) = ([0; 3], [0; 3]);
        for axis in 0..3 {
            let x = f64::from(ball[axis]);
            let last = TO_INTEGER + f64::from(self.count[axis] - 1);
            let (lo, hi) = (self.rule.cell(axis, x - reach), self.rule.cell(axis, x + reach));
            if lo > last || hi < TO_INTEGER {
                return None;
            }
            // In this order of operations a NaN, from a body that breaks the contract, becomes a
            // valid cell.
            lowest[axis] = number(lo.max(TO_INTEGER).min(last));
            highest[axis] = number(hi.max(TO_INTEGER).min(last));
        }
        Some([lowest, highest])
    }
}

/// The number itself, or the nearest finite one.
#[allow(clippy::manual_clamp, reason = "clamp keeps NaN, which these make a number")]
fn finite(x: f32) -> f64 {
    f64::from(x.max(f32::MIN).min(f32::MAX))
}

#[cfg(test)]
mod tests;
