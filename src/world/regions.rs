//! Regions: sets of bodies so far from all others that they can meet only each other.
//!
//! Space is cut into cells, which are far wider than the distance of two bodies that meet. A region
//! is a connected set of occupied cells, next to each other along faces, edges or corners; if its
//! bodies are smaller than those of others, it is cut again into smaller cells. Each region is in a
//! cube with space around its bodies. The cubes are packed next to each other along a Morton curve,
//! the small ones first. Therefore the f32 coordinates of a region depend on the sizes of the cubes
//! before it, not on its position in the world.
//!
//! Cells are numbered by whole f64, which hold the cell of any f64 translation exactly. They are
//! compared by differences, because from 2⁵³ on the next whole number is not always an f64.

use std::cmp::Ordering;

use super::bounds::{BodyBounds, Cube};
use super::region::{PlacedBody, Region};
use crate::rounding::LIMIT;

/// A cell's number along each axis, a whole number.
type CellNumber = [f64; 3];

/// The neighbouring rows of cells that come after a cell's row, as steps along x and y. Each row
/// has three cells along z.
const ROWS_AFTER: [[f64; 2]; 5] = [[0.0, 0.0], [0.0, 1.0], [1.0, -1.0], [1.0, 0.0], [1.0, 1.0]];

/// All regions, and the region of each slot.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Regions {
    regions: Vec<Region>,
    of_slot: Vec<u32>,
}

impl Regions {
    pub fn of(&self, slot: usize) -> &Region {
        &self.regions[self.of_slot[slot] as usize]
    }
}

/// The regions of these bodies, if their f32 coordinates are finer than with one origin for all.
pub(super) fn regions(mut bodies: Vec<PlacedBody>, whole: BodyBounds) -> Option<Regions> {
    let mut found = Vec::new();
    split(&mut bodies, whole, &mut found);
    let cubes: Vec<Cube> = found.iter().map(|(_, bounds)| bounds.cube()).collect();
    let regions = pack(&cubes);
    if !are_finer(&regions, &cubes, &found, whole.half()) {
        return None;
    }
    let slots = bodies.iter().map(|&(slot, ..)| slot + 1).max();
    let mut of_slot = vec![0; slots.unwrap_or(0)];
    let mut bodies = bodies.iter();
    for (region, &(number, _)) in found.iter().enumerate() {
        for &(slot, ..) in bodies.by_ref().take(number) {
            of_slot[slot] = region as u32;
        }
    }
    Some(Regions { regions, of_slot })
}

/// Sorts bodies by region, and adds the number of bodies and the box of each region.
fn split(bodies: &mut [PlacedBody], bounds: BodyBounds, found: &mut Vec<(usize, BodyBounds)>) {
    let cell = bounds.cell();
    if !bounds.is_wide() {
        return found.push((bodies.len(), bounds));
    }
    let mut rest = bodies;
    for number in sort_by_set(rest, cell) {
        let (region, others) = rest.split_at_mut(number);
        let bounds = BodyBounds::of(region.iter().copied());
        if bounds.cell() < cell {
            split(region, bounds, found);
        } else {
            found.push((number, bounds)); // connected, in cells of this side
        }
        rest = others;
    }
}

/// Sorts bodies by their connected set of cells, and returns the number of bodies of each set.
fn sort_by_set(bodies: &mut [PlacedBody], cell: f64) -> Vec<usize> {
    let cell_of = |t: [f64; 3]| t.map(|x| (x / cell).floor() + 0.0); // + 0.0: one zero, not two
    let mut by_cell: Vec<(CellNumber, PlacedBody)> =
        bodies.iter().map(|&b| (cell_of(b.1), b)).collect();
    by_cell.sort_unstable_by(|a, b| compare(&a.0, &b.0));
    let mut cells: Vec<CellNumber> = by_cell.iter().map(|&(cell, _)| cell).collect();
    cells.dedup();
    let set_of = connect(&cells);
    let mut at = 0;
    let with_set = by_cell.into_iter().map(|(cell, body)| {
        at += usize::from(cells[at] != cell);
        (set_of[at], body)
    });
    let mut by_set: Vec<(u32, PlacedBody)> = with_set.collect();
    by_set.sort_by_key(|&(set, _)| set);
    for (body, &(_, sorted)) in bodies.iter_mut().zip(&by_set) {
        *body = sorted;
    }
    by_set.chunk_by(|a, b| a.0 == b.0).map(<[_]>::len).collect()
}

/// Whether coordinates about these regions are within the contract, and even the coarsest of them,
/// relative to the region's bodies, are at least twice as fine as about one origin for a box of
/// this half width.
fn are_finer(regions: &[Region], cubes: &[Cube], found: &[(usize, BodyBounds)], half: f64) -> bool {
    let (mut before, mut after) = (0.0_f64, 0.0_f64);
    for ((region, cube), (_, bounds)) in regions.iter().zip(cubes).zip(found) {
        let farthest = region.corner.iter().fold(0.0, |far: f64, x| far.max(-x)) + cube.side;
        if farthest > 0.5 * f64::from(LIMIT) {
            return false;
        }
        before = before.max(half / bounds.cell());
        after = after.max(farthest / bounds.cell());
    }
    2.0 * after < before
}

/// The order of cells: by x, then y, then z.
fn compare(a: &CellNumber, b: &CellNumber) -> Ordering {
    let by = |i: usize| a[i].total_cmp(&b[i]);
    by(0).then_with(|| by(1)).then_with(|| by(2))
}

/// The region of each cell, of sorted cells; regions are numbered in the order of their first
/// cells.
fn connect(cells: &[CellNumber]) -> Vec<u32> {
    let mut first: Vec<u32> = (0..cells.len() as u32).collect();
    for [x, y] in ROWS_AFTER {
        // The first neighbour of a cell in that row: never before that of the previous cell.
        let mut from = 0;
        for (at, cell) in cells.iter().enumerate() {
            // The step from this cell to another: exact if it is at most one, for all numbers.
            let step_to =
                |c: &CellNumber| -> CellNumber { std::array::from_fn(|i| c[i] - cell[i]) };
            let order = |c: &CellNumber, z: f64| compare(&step_to(c), &[x, y, z]);
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
        // The first cell of a set comes before the others, so its region already has a number.
        let leads = first[at] as usize == at;
        first[at] = if leads { regions } else { first[first[at] as usize] };
        regions += u32::from(leads);
    }
    first
}

/// Joins the sets of two cells; each set is named by its first cell.
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

/// A place for each cube, starting at the world's origin: cubes of equal side follow one another
/// along a Morton curve, larger ones come after smaller ones, at multiples of their side.
fn pack(cubes: &[Cube]) -> Vec<Region> {
    let mut order: Vec<usize> = (0..cubes.len()).collect();
    order.sort_by(|&a, &b| cubes[a].side.total_cmp(&cubes[b].side));
    let mut regions = vec![Region::default(); cubes.len()];
    // The first free place of the curve through cubes of this side.
    let (mut next, mut side) = (0_u64, order.first().map_or(1.0, |&at| cubes[at].side));
    for at in order {
        while side < cubes[at].side {
            (next, side) = (next.div_ceil(8), 2.0 * side);
        }
        regions[at] = Region {
            origin: cubes[at].lowest,
            corner: place_on_curve(next).map(|x| 0.0 - x * side),
        };
        next += 1;
    }
    regions
}

/// The coordinates of a place on a Morton curve: every third bit.
fn place_on_curve(place: u64) -> [f64; 3] {
    [0, 1, 2].map(|axis| {
        let bits = (0..21).map(|bit| (place >> (3 * bit + axis) & 1) << bit);
        bits.sum::<u64>() as f64
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::*;
    use crate::rounding::exp2;

    /// The region of each cell, from pairs of cells.
    fn slowly(cells: &[CellNumber]) -> Vec<u32> {
        let mut of: Vec<u32> = (0..cells.len() as u32).collect();
        for (i, a) in cells.iter().enumerate() {
            for (j, b) in cells.iter().enumerate() {
                if (0..3).all(|axis| (a[axis] - b[axis]).abs() <= 1.0) {
                    let (kept, gone) = (of[i].min(of[j]), of[i].max(of[j]));
                    of.iter_mut().filter(|r| **r == gone).for_each(|r| *r = kept);
                }
            }
        }
        let mut names: Vec<u32> = of.clone();
        names.sort_unstable();
        names.dedup();
        of.iter().map(|r| names.binary_search(r).unwrap_or(0) as u32).collect()
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
            // Some are so far away that all f64 are even, so that the numbers of neighbouring cells
            // aren't f64.
            let base = [0.0, -4.0, 2.0_f64.powi(53), -2.0_f64.powi(55)][round as usize % 4];
            let mut cells: Vec<CellNumber> = (0..40)
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

    /// Cubes of very different sides, in any order: no two overlap, and small ones lie near the
    /// origin.
    #[test]
    fn packed_cubes_are_apart() {
        let mut words = ChaCha8Rng::seed_from_u64(2);
        for round in 0..60 {
            let octaves = [1, 4, 40][round % 3];
            let cubes: Vec<Cube> = (0..80)
                .map(|_| Cube {
                    lowest: [(); 3].map(|()| f64::from(words.next_u32())),
                    side: exp2(-20 + (words.next_u32() % octaves) as i32),
                })
                .collect();
            let regions = pack(&cubes);
            let corners: Vec<[f64; 3]> = regions.iter().map(|r| r.corner.map(|x| -x)).collect();
            for i in 0..cubes.len() {
                let side = cubes[i].side;
                let no_larger = cubes.iter().filter(|cube| cube.side <= side).count();
                let most = 2.0 * side * (no_larger as f64).cbrt();
                assert!(corners[i].iter().all(|x| (0.0..=most).contains(x)), "{i}");
                assert_eq!(regions[i].origin, cubes[i].lowest);
                for j in 0..i {
                    let apart = (0..3).any(|k| {
                        corners[i][k] >= corners[j][k] + cubes[j].side
                            || corners[j][k] >= corners[i][k] + side
                    });
                    assert!(apart, "{:?} {:?}", corners[i], corners[j]);
                }
            }
        }
    }

    /// Small bodies between two giants that are as near each other as separate regions of giants
    /// can be.
    #[test]
    fn small_bodies_have_smaller_cells() {
        let mut bodies: Vec<PlacedBody> = (0..40)
            .map(|i| (i, [1.0e12 + 1.0e4 * f64::from((i / 2) as u32), 0.1, 0.0], 1.0))
            .collect();
        bodies.push((40, [0.1, 0.0, 0.0], 1.0e6));
        let whole = BodyBounds::of(bodies.iter().copied());
        let regions = regions(bodies.clone(), whole).unwrap();
        assert_eq!(regions.regions.len(), 21);
        for (slot, t, size) in bodies {
            let (place, moved) = regions.of(slot).place(t);
            assert!(moved < size * exp2(-10), "{slot}: {place:?} {moved}");
        }
    }
}
