//! Regions: bodies that lie so far from all others that they can meet only each other.
//!
//! Space is cut into cells, far wider than two bodies that meet are apart. A region is a connected set of occupied cells, next
//! to each other along faces, edges or corners. It lies in a cube of a power of two cells, with an empty layer at its
//! upper ends. The cubes are packed next to each other, larger ones first, along a Morton curve: then f32 coordinates stay
//! about as small as those of all cubes' volume, wherever in the world the regions are.
//!
//! Cells are numbered by whole f64, which hold the cell of any f64 translation exactly. They are compared by differences, since
//! a number's own neighbours are no f64 from 2⁵³ on.

use std::cmp::Ordering;

use super::region::{Placed, Region};
use crate::rounding::exp2;

/// A cell's number along each axis, a whole number.
type Cell = [f64; 3];

/// Cells across the smallest cube: up to two that are occupied at any place, and an empty one.
const SMALLEST: f64 = 4.0;

/// The rows of cells next to a cell's own that come after it, as steps along x and y; along z a cell on either side.
const ROWS: [[f64; 2]; 5] = [[0.0, 0.0], [0.0, 1.0], [1.0, -1.0], [1.0, 0.0], [1.0, 1.0]];

/// All regions, and which of them each slot belongs to.
#[derive(Clone, Debug)]
pub(super) struct Regions {
    regions: Vec<Region>,
    of_slot: Vec<u32>,
    /// The largest local coordinate of any cube.
    pub half: f64,
}

impl Regions {
    pub fn of(&self, slot: usize) -> &Region {
        &self.regions[self.of_slot[slot] as usize]
    }
}

/// The regions of these bodies, if there are at least two; `cell` is a power of two.
pub(super) fn regions(bodies: impl Iterator<Item = Placed>, cell: f64) -> Option<Regions> {
    let cell_of = |t: [f64; 3]| t.map(|x| (x / cell).floor() + 0.0); // + 0.0: one zero, not two
    let mut occupied: Vec<(Cell, usize)> = bodies.map(|(slot, t, _)| (cell_of(t), slot)).collect();
    occupied.sort_unstable_by(|a, b| compare(&a.0, &b.0));
    let mut cells: Vec<Cell> = occupied.iter().map(|&(cell, _)| cell).collect();
    cells.dedup();
    let region_of = connect(&cells);
    let mut cubes: Vec<Cube> = Vec::new();
    for (&cell, &region) in cells.iter().zip(&region_of) {
        match cubes.get_mut(region as usize) {
            Some(cube) => cube.take_in(cell),
            None => cubes.push(Cube::of(cell)),
        }
    }
    if cubes.len() < 2 {
        return None;
    }
    let slots = occupied.iter().map(|&(_, slot)| slot + 1).max();
    let mut of_slot = vec![0; slots.unwrap_or(0)];
    let mut at = 0;
    for (cell, slot) in occupied {
        at += usize::from(cells[at] != cell);
        of_slot[slot] = region_of[at];
    }
    let (regions, half) = pack(&cubes, cell);
    Some(Regions {
        regions,
        of_slot,
        half,
    })
}

/// The order of cells: by x, then y, then z.
fn compare(a: &Cell, b: &Cell) -> Ordering {
    let by = |i: usize| a[i].total_cmp(&b[i]);
    by(0).then_with(|| by(1)).then_with(|| by(2))
}

/// The region of each cell, of sorted cells; regions are numbered in the order of their first cells.
fn connect(cells: &[Cell]) -> Vec<u32> {
    let mut first: Vec<u32> = (0..cells.len() as u32).collect();
    for [x, y] in ROWS {
        // Where the neighbours of a cell in that row begin: never before those of the cell before it.
        let mut from = 0;
        for (at, cell) in cells.iter().enumerate() {
            // From this cell to another: exact where it is at most one, whatever the numbers.
            let step_to = |c: &Cell| -> Cell { std::array::from_fn(|i| c[i] - cell[i]) };
            let order = |c: &Cell, z: f64| compare(&step_to(c), &[x, y, z]);
            while from < cells.len() && order(&cells[from], -1.0) == Ordering::Less {
                from += 1;
            }
            let near = cells[from..].iter().zip(from..);
            for (_, other) in near.take_while(|(c, _)| order(c, 1.0) != Ordering::Greater) {
                join(&mut first, at as u32, other as u32);
            }
        }
    }
    let mut regions = 0;
    for at in 0..first.len() {
        // A cell's first comes before it, and so has its region's number by now.
        let leads = first[at] as usize == at;
        first[at] = if leads {
            regions
        } else {
            first[first[at] as usize]
        };
        regions += u32::from(leads);
    }
    first
}

/// Puts the sets of two cells together; each set is named by its first cell.
fn join(first: &mut [u32], a: u32, b: u32) {
    let (a, b) = (first_of(first, a), first_of(first, b));
    first[a.max(b) as usize] = a.min(b);
}

fn first_of(first: &mut [u32], mut at: u32) -> u32 {
    while first[at as usize] != at {
        let next = first[at as usize];
        first[at as usize] = first[next as usize];
        at = next;
    }
    at
}

/// The box of a region's cells.
struct Cube {
    lo: Cell,
    hi: Cell,
}

impl Cube {
    fn of(cell: Cell) -> Self {
        Self { lo: cell, hi: cell }
    }

    fn take_in(&mut self, cell: Cell) {
        for axis in 0..3 {
            self.lo[axis] = self.lo[axis].min(cell[axis]);
            self.hi[axis] = self.hi[axis].max(cell[axis]);
        }
    }

    /// The lowest cell of the smallest cube that holds the box and an empty layer above it, and how often the smallest side is
    /// doubled for its side. The lowest cell is a multiple of a quarter of the side, so that it seldom changes while bodies move.
    fn outer(&self) -> (Cell, u32) {
        let (mut side, mut doubled) = (SMALLEST, 0);
        loop {
            let step = 0.25 * side;
            let lowest = self.lo.map(|x| (x / step).floor() * step);
            if (0..3).all(|i| self.hi[i] - lowest[i] + 2.0 <= side) {
                return (lowest, doubled);
            }
            side *= 2.0;
            doubled += 1;
        }
    }
}

/// A place for each cube, of this size of cells, about the middle of all; and the largest coordinate.
fn pack(cubes: &[Cube], cell: f64) -> (Vec<Region>, f64) {
    let outer: Vec<(Cell, u32)> = cubes.iter().map(Cube::outer).collect();
    let mut order: Vec<usize> = (0..cubes.len()).collect();
    order.sort_by_key(|&at| std::cmp::Reverse(outer[at].1));
    let unit = SMALLEST * cell;
    let mut regions = vec![Region::default(); cubes.len()];
    // A whole number of cubes of the next size, as sizes descend.
    let (mut next, mut end) = (0_u128, [0.0_f64; 3]);
    for at in order {
        let (lowest, doubled) = outer[at];
        let corner = place_on_curve(next);
        next += 1 << (3 * doubled);
        let side = exp2(doubled as i32);
        end = std::array::from_fn(|i| end[i].max(corner[i] + side));
        regions[at] = Region {
            origin: lowest.map(|x| x * cell),
            corner: corner.map(|x| -(x * unit)),
        };
    }
    let half = end.map(|x| 0.5 * x * unit);
    for region in &mut regions {
        region.corner = std::array::from_fn(|i| region.corner[i] + half[i]);
    }
    (regions, half.into_iter().fold(0.0, f64::max))
}

/// The coordinates of a place on a Morton curve: every third bit.
fn place_on_curve(place: u128) -> [f64; 3] {
    [0, 1, 2].map(|axis| {
        let bits = (0..42).map(|bit| (place >> (3 * bit + axis) & 1) << bit);
        bits.sum::<u128>() as f64
    })
}

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::*;

    /// The region of each cell, from pairs of cells.
    fn slowly(cells: &[Cell]) -> Vec<u32> {
        let mut of: Vec<u32> = (0..cells.len() as u32).collect();
        for (i, a) in cells.iter().enumerate() {
            for (j, b) in cells.iter().enumerate() {
                if (0..3).all(|axis| (a[axis] - b[axis]).abs() <= 1.0) {
                    let (kept, gone) = (of[i].min(of[j]), of[i].max(of[j]));
                    of.iter_mut()
                        .filter(|r| **r == gone)
                        .for_each(|r| *r = kept);
                }
            }
        }
        let mut names: Vec<u32> = of.clone();
        names.sort_unstable();
        names.dedup();
        of.iter()
            .map(|r| names.binary_search(r).unwrap_or(0) as u32)
            .collect()
    }

    #[test]
    fn neighbours_along_corners_connect() {
        let cells = [[-1.0, 4.0, 0.0], [0.0, 3.0, 1.0], [0.0, 5.0, 2.0]];
        assert_eq!(connect(&cells), [0, 0, 1]);
        assert_eq!(connect(&cells), slowly(&cells));
    }

    #[test]
    fn sweeps_find_what_pairs_find() {
        let mut words = ChaCha8Rng::seed_from_u64(1);
        let mut seen = [0; 2];
        for round in 0..400_u32 {
            let side = 3 + round % 9;
            // Some lie where whole f64 are even, so that a cell's neighbours are no f64.
            let base = [0.0, -4.0, 2.0_f64.powi(53), -2.0_f64.powi(55)][round as usize % 4];
            let mut cells: Vec<Cell> = (0..40)
                .map(|_| [(); 3].map(|()| base + f64::from(words.next_u32() % side) + 0.0))
                .collect();
            cells.sort_unstable_by(compare);
            cells.dedup();
            let regions = connect(&cells);
            assert_eq!(regions, slowly(&cells), "{cells:?}");
            seen[usize::from(regions.contains(&1))] += 1;
        }
        assert!(seen[0] > 20 && seen[1] > 20, "{seen:?}");
    }

    #[test]
    fn cubes_keep_an_empty_layer() {
        let mut words = ChaCha8Rng::seed_from_u64(2);
        for _ in 0..200 {
            let cubes: Vec<Cube> = (0..50)
                .map(|_| {
                    let lo = [(); 3].map(|()| f64::from(words.next_u32() % 1000) - 500.0);
                    let wide = 1 << (words.next_u32() % 6);
                    let hi = lo.map(|x| x + f64::from(words.next_u32() % wide));
                    Cube { lo, hi }
                })
                .collect();
            let (regions, half) = pack(&cubes, 2.0);
            // The local ends of the occupied cells, in cells.
            let ends = |i: usize| -> [[f64; 2]; 3] {
                std::array::from_fn(|a| {
                    let at = |x: f64| x - (regions[i].origin[a] + regions[i].corner[a]) / 2.0;
                    [at(cubes[i].lo[a]), at(cubes[i].hi[a]) + 1.0]
                })
            };
            for i in 0..cubes.len() {
                assert!(ends(i).as_flattened().iter().all(|x| x.abs() * 2.0 <= half));
                for j in 0..i {
                    let (a, b) = (ends(i), ends(j));
                    let gap = (0..3).map(|k| (a[k][0] - b[k][1]).max(b[k][0] - a[k][1]));
                    assert!(gap.fold(-1.0, f64::max) >= 1.0, "{a:?} {b:?}");
                }
            }
        }
    }
}
