//! Which cell a ball's centre falls in, and where the cells around it stand in the table.
//!
//! A coordinate x falls in cell k = round((x − o)/c), in f64. Centres of balls that the first test
//! can report differ by less than the cell size c, so by at most one cell a coordinate: with c ≥
//! 2R(1 + 2⁻¹⁶), R the widest ball [widened](crate::rounding::widen), quotients differ by less than
//! 1 − 2⁻¹⁷, and below 2³⁰ the three roundings of a quotient take 2⁻²² each.
//!
//! Cells stand in the table in rows along x, rows in layers: index = k_x + A·k_y + B·k_z. Where the
//! bodies' box has few cells, A and B leave one empty cell behind each row and one empty row behind
//! each layer, so that neighbours across the border exist and are empty. Where the box is mostly
//! void (a diagonal line, clusters far apart), indices are taken modulo a power of two instead,
//! with A and B spread evenly over it: other cells may share a place in the table, which costs
//! false candidates and loses nothing.

use crate::broad_phase::{BLOCK_BODIES, Bounds};
use crate::rounding::widen;
use crate::simd::{Lanes, quads_in_columns};

/// Adding it leaves an f64 below 2³¹ rounded to an integer in its low 32 bits.
const TO_INTEGER: f64 = 1.5 * (1u64 << 52) as f64;

/// Cells along the longest side: quotients stay below, see above.
const MOST_CELLS: f64 = (1u32 << 29) as f64;

/// Cells a body that a table may have, and a few more for small scenes.
const CELLS_PER_BODY: f64 = 6.0;
const FEW_CELLS: f64 = 512.0;

/// Rows that a body looks at besides its own: (0, +1, 0) and (0, −1…+1, +1). The other half finds
/// it in turn.
const FORWARD: [[i32; 2]; 4] = [[1, 0], [-1, 1], [0, 1], [1, 1]];

/// Cells each way that one look into a wrapped table may span: there all rows lie apart, in every
/// length of table, and rows of a fourth cell would overlap in short ones and give some bodies
/// twice.
pub const WRAPPED_SPAN: u32 = 3;

/// How cells find their place in the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Every cell of the bodies' box has its own.
    Box,
    /// Modulo the table's length.
    Wrapped,
}

/// Where the cells of one size lie. The one place that tells the cell of a coordinate: which a body
/// falls in, how many there are and where a body of another level looks. Each step rounds, but none
/// of them reverses an order: a coordinate between two others falls in a cell between theirs,
/// whatever the roundings, and none falls beyond the cell of the farthest.
#[derive(Clone, Copy, Debug)]
struct Rule {
    origin: [f64; 3],
    inverse: f64,
}

impl Rule {
    /// The number of a coordinate's cell along an axis, plus [`TO_INTEGER`]: an exact f64 in order,
    /// whose low 32 bits are the number.
    #[inline(always)]
    fn cell(&self, axis: usize, x: f64) -> f64 {
        (x - self.origin[axis]) * self.inverse + TO_INTEGER
    }

    /// How many cells there are up to that of `hi`, the farthest centre's coordinates.
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
    rule: Rule,
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
    /// Cells for `bodies` balls within the bounds, of the size that the widest needs; in a box,
    /// larger ones where the table would grow too long.
    pub fn fit(bounds: &Bounds, bodies: usize, layout: Layout) -> Self {
        // Bounds that aren't finite come of bodies outside the contract. They get some cells, so
        // that nothing here runs on.
        let [lo, hi] = [bounds.lo, bounds.hi].map(|end| end.map(finite));
        let longest = (0..3).map(|i| hi[i] - lo[i]).fold(0.0, f64::max);
        let needed = 2.0 * f64::from(widen(bounds.widest)) * (1.0 + 1.0 / 65536.0);
        let mut size = needed.max(longest / MOST_CELLS);
        let rule = |size: f64| Rule {
            origin: lo,
            inverse: 1.0 / size,
        };
        if layout == Layout::Box {
            let most = CELLS_PER_BODY * bodies as f64 + FEW_CELLS;
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
            Layout::Box => cells.lay_out_box(),
            Layout::Wrapped => cells.wrap(bodies),
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

    /// The golden ratio's kin in two dimensions spreads the multiples of A and B most evenly.
    fn wrap(&mut self, bodies: usize) {
        let table = (4 * bodies).next_power_of_two().max(64);
        self.row = (table as f64 * 0.754_877_666_246_693) as u32 | 1;
        self.layer = (table as f64 * 0.569_840_290_998_053) as u32 | 1;
        self.mask = table as u32 - 1;
        self.table = table;
        self.take_forward(|_| true);
    }

    fn take_forward(&mut self, has: impl Fn([i32; 2]) -> bool) {
        for step in FORWARD.into_iter().filter(|&step| has(step)) {
            let [y, z] = step.map(|k| k as u32);
            let offset = y
                .wrapping_mul(self.row)
                .wrapping_add(z.wrapping_mul(self.layer));
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

    /// Index offsets of the rows that a body looks at besides its own, ascending for a box.
    #[inline(always)]
    pub fn forward(&self) -> &[u32] {
        &self.forward[..self.forward_len]
    }

    /// The layout.
    pub fn layout(&self) -> Layout {
        if self.mask == u32::MAX {
            Layout::Box
        } else {
            Layout::Wrapped
        }
    }

    /// How many cells each way a look may span.
    #[inline(always)]
    pub fn most_span(&self) -> u32 {
        match self.layout() {
            Layout::Box => u32::MAX,
            Layout::Wrapped => WRAPPED_SPAN,
        }
    }

    /// The highest table index that a centre can fall in: beyond it a box has empty cells only.
    pub fn last(&self) -> u32 {
        match self.layout() {
            Layout::Box => self.index(self.count.map(|n| n - 1)),
            Layout::Wrapped => self.mask,
        }
    }

    /// Table index of a cell.
    #[inline(always)]
    pub fn index(&self, [x, y, z]: [u32; 3]) -> u32 {
        let (row, layer) = (y.wrapping_mul(self.row), z.wrapping_mul(self.layer));
        x.wrapping_add(row).wrapping_add(layer) & self.mask
    }

    /// Table index of the cell that each ball's centre falls in.
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

    /// Lowest and highest cell of each axis that may hold a centre within `reach` of the ball's
    /// along that axis; `None` if all centres are farther off.
    #[inline(always)]
    pub fn around(&self, ball: &[f32; 4], reach: f64) -> Option<[[u32; 3]; 2]> {
        let (mut lowest, mut highest) = ([0; 3], [0; 3]);
        for axis in 0..3 {
            let x = f64::from(ball[axis]);
            let last = TO_INTEGER + f64::from(self.count[axis] - 1);
            let (lo, hi) = (
                self.rule.cell(axis, x - reach),
                self.rule.cell(axis, x + reach),
            );
            if lo > last || hi < TO_INTEGER {
                return None;
            }
            // In this order NaN, which a body outside the contract may bring, turns to a cell.
            lowest[axis] = number(lo.max(TO_INTEGER).min(last));
            highest[axis] = number(hi.max(TO_INTEGER).min(last));
        }
        Some([lowest, highest])
    }
}

/// The number itself, or the nearest finite one.
#[allow(
    clippy::manual_clamp,
    reason = "clamp keeps NaN, which these make a number"
)]
fn finite(x: f32) -> f64 {
    f64::from(x.max(f32::MIN).min(f32::MAX))
}

#[cfg(test)]
mod tests;
