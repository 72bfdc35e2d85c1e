//! One level of the grid: bodies of similar size, counting-sorted by cell into slots.
//!
//! Threads divide a sort by ranges of cells, not of places. Each thread reads the cells of all
//! bodies, four bytes each in sequence, and counts and places the bodies in its own range of cells.
//! Tables and slots are then split without overlap, a thread needs only one sum from the others,
//! and the order within a cell is that of one thread.

use std::ops::Range;

use super::cells::{Cells, TableLayout};
use crate::broad_phase::{BallBounds, Slots};
use crate::rounding::skin::Reach;
use crate::rounding::widen;
use crate::simd::{Kernel, Lanes, Tier, dispatch};
use crate::threads::{Executor, Threads};

/// Bodies in cells of one size. Their slots are a range and their places the same range, within
/// which they are sorted.
#[derive(Clone, Debug)]
pub struct GridLevel {
    /// The range of slots and of places.
    pub range: Range<usize>,
    /// The cells of this frame.
    pub cells: Cells,
    /// The first slot of each cell, and the end of the last cell.
    pub starts: Vec<u32>,
    /// The largest radius of this frame, grown and widened.
    pub widest: f64,
    /// How balls are grown for the search.
    pub reach: Reach,
    /// Whether its bodies came after the levels were planned.
    pub is_late: bool,
    layout: TableLayout,
}

impl GridLevel {
    /// A level for the bodies in a range of places.
    pub fn new(range: Range<usize>, layout: TableLayout) -> Self {
        Self {
            cells: Cells::fit(&BallBounds::EMPTY, range.len(), layout),
            starts: Vec::new(),
            widest: 0.0,
            reach: Reach::NONE,
            range,
            is_late: false,
            layout,
        }
    }

    /// A level for bodies that came after the levels were planned.
    pub fn late(range: Range<usize>) -> Self {
        Self { is_late: true, ..Self::new(range, TableLayout::Box) }
    }

    /// The level with another range of places.
    pub fn holding(self, range: Range<usize>) -> Self {
        Self { range, ..self }
    }

    /// Its slots.
    pub fn slots(&self) -> Range<u32> {
        self.range.start as u32..self.range.end as u32
    }

    /// Sorts the level's bodies into their slots; within a cell they keep the order of places.
    /// `place_cells` and `slot_cells` are columns over all places and all slots.
    pub fn sort(
        &mut self,
        executor: Executor<'_>,
        balls: &[[f32; 4]],
        names: &[u32],
        place_cells: &mut [u32],
        slots: &mut Slots,
        slot_cells: &mut [u32],
    ) {
        let Executor { tier, pool } = executor;
        let range = self.range.clone();
        let (balls, names) = (&balls[range.clone()], &names[range.clone()]);
        let mut bounds = bounds(tier, pool, balls);
        bounds.widest = self.reach.of(bounds.widest);
        self.widest = f64::from(widen(bounds.widest));
        self.cells = Cells::fit(&bounds, range.len(), self.layout);
        let (cells, place_cells) = (&self.cells, &mut place_cells[range.clone()]);
        pool.pieces(place_cells, BODIES_PER_TASK, |start, to| {
            let balls = &balls[start..start + to.len()];
            dispatch(tier, AssignCells { cells, balls, to });
        });
        let entries = self.cells.table_len() + 1;
        if entries > self.starts.capacity() {
            // With an eighth to spare, so that a box that varies in size does not allocate in every
            // frame.
            let spare = entries + entries / 8 - self.starts.len();
            self.starts.reserve_exact(spare);
        }
        self.starts.resize(entries, 0);
        self.starts[0] = range.start as u32;
        let last = self.cells.last();
        loop {
            let from = BodiesByPlace { balls, names, cells: place_cells };
            let to = CellShare {
                first_cell: 0,
                ends: &mut self.starts[1..],
                first_slot: range.start as u32,
                balls: &mut slots.balls[range.clone()],
                names: &mut slots.names[range.clone()],
                cells: &mut slot_cells[range.clone()],
            };
            // All bodies are in cells up to the last one that a centre can be in.
            if to.sort(pool, &from) && self.starts[last as usize + 1] == range.end as u32 {
                break;
            }
            debug_assert!(
                balls.as_flattened().iter().any(|x| x.is_nan()),
                "a body's cell lies beyond the table"
            );
            // A NaN centre, of a body that breaks the contract, may get any number as its cell.
            for cell in &mut *place_cells {
                *cell = (*cell).min(last);
            }
        }
        self.check(slots, balls, names);
    }

    /// Checks every sort in debug builds, and therefore in tests.
    fn check(&self, slots: &Slots, balls: &[[f32; 4]], names: &[u32]) {
        if !cfg!(debug_assertions) {
            return;
        }
        let range = self.range.clone();
        // Checksums of the names, because sorting them would allocate.
        let sums = |names: &[u32]| {
            let sums = names.iter().map(|&name| u64::from(name)).map(|x| (x, x * x));
            sums.fold((0u64, 0u64), |a, b| (a.0 + b.0, a.1.wrapping_add(b.1)))
        };
        let slotted = &slots.names[range.clone()];
        debug_assert_eq!(sums(slotted), sums(names), "each body has one slot");
        let ends = [self.starts.first(), self.starts.last()];
        let [start, end] = [range.start as u32, range.end as u32];
        debug_assert_eq!(ends, [Some(&start), Some(&end)], "cells hold all slots");
        debug_assert!(self.starts.is_sorted(), "cells follow each other");
        let wider = |ball: &[f32; 4]| f64::from(widen(self.reach.of(ball[3]))) > self.widest;
        debug_assert!(!balls.iter().any(wider), "the widest ball is the widest");
        debug_assert!(self.cells.size() >= 2.0 * self.widest, "cells hold a ball");
    }
}

/// Bodies whose cells one thread finds at a time.
const BODIES_PER_TASK: usize = 4096;

/// The fewest bodies whose sort is divided among threads.
const FEWEST_SHARED_BODIES: usize = 1 << 15;

/// The bounds of some balls, computed on all threads. Extremes don't depend on the split.
fn bounds(tier: Tier, pool: &Threads, balls: &[[f32; 4]]) -> BallBounds {
    if pool.threads() == 1 || balls.len() < FEWEST_SHARED_BODIES {
        return BallBounds::of(tier, balls);
    }
    let piece = balls.len().div_ceil(pool.threads());
    let mut found = vec![BallBounds::EMPTY; pool.threads()];
    pool.each(&mut found, |k, found| {
        let end = balls.len().min((k + 1) * piece);
        *found = BallBounds::of(tier, &balls[end.min(k * piece)..end]);
    });
    found.into_iter().fold(BallBounds::EMPTY, BallBounds::union)
}

/// The bodies to be sorted, by place.
struct BodiesByPlace<'a> {
    balls: &'a [[f32; 4]],
    names: &'a [u32],
    cells: &'a [u32],
}

/// One thread's part of the sort: the bodies in a range of cells, whose slots are a range too.
struct CellShare<'a> {
    first_cell: u32,
    /// The end of each cell.
    ends: &'a mut [u32],
    first_slot: u32,
    balls: &'a mut [[f32; 4]],
    names: &'a mut [u32],
    cells: &'a mut [u32],
}

impl<'a> CellShare<'a> {
    /// Sorts all cells, split among the threads: each reads all bodies and sorts those in its own
    /// cells, so that the order is that of one thread. Returns false without sorting if a body's
    /// cell isn't in the table.
    fn sort(mut self, pool: &Threads, from: &BodiesByPlace<'_>) -> bool {
        let threads = pool.threads();
        if threads == 1 || from.cells.len() < FEWEST_SHARED_BODIES {
            let counted = count(from.cells, self.first_cell, self.ends);
            let all = counted == from.cells.len();
            if all {
                self.place(from);
            }
            return all;
        }
        let mut shares = Vec::with_capacity(threads);
        for k in 1..threads {
            // Places are nearly in the order of cells, so this splits the bodies evenly.
            let middle = from.cells[from.cells.len() * k / threads];
            let end = self.first_cell + self.ends.len() as u32;
            let middle = middle.clamp(self.first_cell, end);
            let (ends, rest) = self.ends.split_at_mut((middle - self.first_cell) as usize);
            shares.push((self.first_cell, ends, 0));
            (self.first_cell, self.ends) = (middle, rest);
        }
        shares.push((self.first_cell, self.ends, 0));
        pool.each(&mut shares, |_, (first_cell, ends, bodies)| {
            *bodies = count(from.cells, *first_cell, ends);
        });
        if shares.iter().map(|(_, _, bodies)| bodies).sum::<usize>() < from.cells.len() {
            return false;
        }
        let mut shares: Vec<CellShare<'_>> = shares
            .into_iter()
            .map(|(first_cell, ends, bodies)| {
                let (balls, rest) = std::mem::take(&mut self.balls).split_at_mut(bodies);
                self.balls = rest;
                let (names, rest) = std::mem::take(&mut self.names).split_at_mut(bodies);
                self.names = rest;
                let (cells, rest) = std::mem::take(&mut self.cells).split_at_mut(bodies);
                self.cells = rest;
                let first_slot = self.first_slot;
                self.first_slot += bodies as u32;
                CellShare { first_cell, ends, first_slot, balls, names, cells }
            })
            .collect();
        pool.each(&mut shares, |_, share| share.place(from));
        true
    }

    /// Puts the counted bodies into their slots. Each cell's entry changes from its count to its
    /// start, and then to its end.
    fn place(&mut self, from: &BodiesByPlace<'_>) {
        let mut slot = self.first_slot;
        for end in self.ends.iter_mut() {
            slot += std::mem::replace(end, slot);
        }
        let bodies = self.balls.len();
        let (names, cells) = (&mut self.names[..bodies], &mut self.cells[..bodies]);
        for ((ball, name), &cell) in from.balls.iter().zip(from.names).zip(from.cells) {
            let own = cell.wrapping_sub(self.first_cell) as usize;
            if let Some(end) = self.ends.get_mut(own) {
                let slot = (*end - self.first_slot) as usize;
                *end += 1;
                self.balls[slot] = *ball;
                names[slot] = *name;
                cells[slot] = cell;
            }
        }
    }
}

/// Counts the bodies of each cell from `first` on; returns how many there are.
fn count(cells: &[u32], first: u32, counts: &mut [u32]) -> usize {
    counts.fill(0);
    let mut counted = 0;
    for &cell in cells {
        if let Some(count) = counts.get_mut(cell.wrapping_sub(first) as usize) {
            *count += 1;
            counted += 1;
        }
    }
    counted
}

/// Computes the cells of bodies. It is compiled per tier, for wide conversions to f64 and back.
pub(super) struct AssignCells<'a> {
    pub cells: &'a Cells,
    pub balls: &'a [[f32; 4]],
    pub to: &'a mut [u32],
}

impl Kernel for AssignCells<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        self.cells.assign(l, self.balls, self.to);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks a level of two bodies whose slots have these names.
    fn check(slotted: [u32; 2], names: [u32; 2]) {
        let (mut level, balls) = (GridLevel::new(0..2, TableLayout::Box), [[0.25; 4]; 2]);
        level.cells = Cells::fit(&BallBounds::of(Tier::SCALAR, &balls), 2, TableLayout::Box);
        (level.starts, level.widest) = (vec![0, 2], widen(0.25).into());
        let slots = Slots { names: slotted.to_vec(), ..Slots::default() };
        level.check(&slots, &balls, &names);
    }

    #[test]
    fn names_in_any_order_are_sound() {
        check([4, 1], [1, 4]);
    }

    /// Other names with the same sum are detected.
    #[test]
    #[cfg_attr(debug_assertions, should_panic(expected = "each body has one slot"))]
    fn names_of_equal_sum_differ() {
        check([2, 3], [1, 4]);
    }

    /// Other names with the same sum of squares are detected.
    #[test]
    #[cfg_attr(debug_assertions, should_panic(expected = "each body has one slot"))]
    fn names_of_equal_squares_differ() {
        check([0, 5], [3, 4]);
    }

    /// Sorts balls with these names: their slots, and each slot's cell.
    fn sort(
        level: &mut GridLevel,
        threads: usize,
        balls: &[[f32; 4]],
        names: &[u32],
    ) -> (Slots, Vec<u32>) {
        let pool = Threads::new(threads).expect("a few threads");
        let (mut place_cells, mut slot_cells) = (vec![0; balls.len()], vec![0; balls.len()]);
        let mut slots = Slots {
            balls: vec![[0.0; 4]; balls.len()],
            names: vec![0; balls.len()],
            ..Slots::default()
        };
        level.sort(
            pool.executor(Tier::SCALAR),
            balls,
            names,
            &mut place_cells,
            &mut slots,
            &mut slot_cells,
        );
        (slots, slot_cells)
    }

    /// Bodies are shared by cells, and those of a cell stay in the order of places.
    #[test]
    fn threads_sort_many_bodies_alike() {
        let len = FEWEST_SHARED_BODIES + 1000;
        let ball = |i: usize| {
            let [x, y, z] = [7919, 104_729, 1_299_709].map(|p| (i * p % 1009) as f32);
            [x, y, z, 3.0 + (i % 7) as f32]
        };
        let balls: Vec<_> = (0..len).map(ball).collect();
        let names: Vec<u32> = (0..len as u32).rev().collect();
        let sorted = |threads| {
            let mut level = GridLevel::new(0..len, TableLayout::Box);
            let (slots, slot_cells) = sort(&mut level, threads, &balls, &names);
            (level.starts, level.widest, slots.balls, slots.names, slot_cells)
        };
        let one = sorted(1);
        assert!(one.4.is_sorted() && one.0.len() > 10_000);
        for threads in [2, 3, 5] {
            assert!(sorted(threads) == one, "{threads} threads");
        }
    }
}
