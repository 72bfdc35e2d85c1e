//! One level of the grid: bodies of like size, counting-sorted by cell into their slots.

use std::ops::Range;

use super::cells::{Cells, Layout};
use crate::broad_phase::{Bounds, Slots};
use crate::rounding::widen;
use crate::simd::{Kernel, Lanes, Level as Tier, dispatch};

/// Bodies whose cells have one size. Their slots are a range, and so are their places: sorting stays within it.
#[derive(Clone, Debug)]
pub struct Level {
    /// Slots, and places.
    pub range: Range<usize>,
    /// The cells of this frame.
    pub cells: Cells,
    /// First slot of each cell, and one more entry: the last cell's end.
    pub starts: Vec<u32>,
    /// Widest ball of this frame, widened.
    pub widest: f64,
    layout: Layout,
}

impl Level {
    /// A level for the bodies in a range of places.
    pub fn new(range: Range<usize>, layout: Layout) -> Self {
        Self {
            cells: Cells::fit(&Bounds::EMPTY, range.len(), layout),
            starts: Vec::new(),
            widest: 0.0,
            range,
            layout,
        }
    }

    /// Sorts the level's bodies into their slots; within a cell they keep the order of places. `place_cells` and
    /// `slot_cells` are columns over all places and all slots.
    pub fn sort(
        &mut self,
        tier: Tier,
        balls: &[[f32; 4]],
        names: &[u32],
        place_cells: &mut [u32],
        slots: &mut Slots,
        slot_cells: &mut [u32],
    ) {
        let range = self.range.clone();
        let balls = &balls[range.clone()];
        let bounds = Bounds::of(balls);
        self.widest = f64::from(widen(bounds.widest));
        self.cells = Cells::fit(&bounds, range.len(), self.layout);
        let place_cells = &mut place_cells[range.clone()];
        dispatch(
            tier,
            Assign {
                cells: &self.cells,
                balls,
                to: place_cells,
            },
        );
        self.count(place_cells);
        // Each cell's entry is moved from its start to its end, the start of the next.
        for ((ball, name), &cell) in balls
            .iter()
            .zip(&names[range.clone()])
            .zip(place_cells.iter())
        {
            let next = &mut self.starts[cell as usize + 1];
            let slot = *next as usize;
            *next += 1;
            slots.balls[slot] = *ball;
            slots.names[slot] = *name;
            slot_cells[slot] = cell;
        }
    }

    /// Leaves in entry c + 1 the first slot of cell c.
    fn count(&mut self, cells: &[u32]) {
        self.starts.clear();
        self.starts.resize(self.cells.table_len() + 1, 0);
        for &cell in cells {
            self.starts[cell as usize + 1] += 1;
        }
        let mut slot = self.range.start as u32;
        self.starts[0] = slot;
        for start in &mut self.starts[1..] {
            let count = *start;
            *start = slot;
            slot += count;
        }
    }
}

/// Compiled once a tier, for wide conversions to f64 and back.
pub(super) struct Assign<'a> {
    pub cells: &'a Cells,
    pub balls: &'a [[f32; 4]],
    pub to: &'a mut [u32],
}

impl Kernel for Assign<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        self.cells.assign(l, self.balls, self.to);
    }
}
