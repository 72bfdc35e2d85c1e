//! The ends of boxes in slot order. Boxes that are much longer than wide are compared by their
//! ends, because the cubes around them overlap far more often than the boxes. Comparing ends is
//! exact.
//!
//! Both the first volume test and lists of neighbours use them. For lists, boxes are [`grown`] by a
//! skin, and a list is valid while each box is within its grown box. Boxes that meet then have
//! grown boxes that meet, however these were rounded.

use std::ops::Range;

use super::{Block, SlotTest, bytes, list_slots};
use crate::bodies::Aabb;
use crate::rounding::cube::SCALE;
use crate::rounding::skin::Skin;
use crate::simd::{Kernel, Lanes, MAX_WIDTH, dispatch, numbers_of, quads_in_columns};
use crate::threads::{Executor, Threads};

/// Boxes that one thread sorts into slots, or checks, at a time.
const BOXES_PER_TASK: usize = 4096;

/// The boxes from which a finder's balls were made. A ball represents the cube around its box, at
/// an eighth of the cube's size.
#[derive(Clone, Copy, Debug)]
pub struct GivenBoxes<'a> {
    /// The boxes, indexed by name.
    pub all: &'a [Aabb],
    /// Whether the boxes are so long that lists of neighbours are built from the boxes instead of
    /// their cubes.
    pub are_long: bool,
}

/// Ends of boxes in the finder's slot order, padded by [`MAX_WIDTH`] finite entries: as quads,
/// whose fourth number is zero, for scattered candidates, and as columns for runs.
#[derive(Clone, Debug, Default)]
pub struct EndSlots {
    lower: Vec<[f32; 4]>,
    upper: Vec<[f32; 4]>,
    /// Lower ends on each axis, then upper ones.
    columns: [Vec<f32>; 6],
}

impl EndSlots {
    /// Fills in the boxes in slot order. `runs` says whether slots will be tested against runs of
    /// others.
    pub fn fill(&mut self, executor: Executor<'_>, order: &[u32], boxes: &[Aabb], runs: bool) {
        self.fill_quads(executor, order, boxes);
        self.fill_columns(executor.pool, runs);
    }

    /// As [`Self::fill`], with the boxes in the first slots grown by a skin of the cube around
    /// each, which is given.
    pub fn fill_grown(
        &mut self,
        executor: Executor<'_>,
        order: &[u32],
        boxes: &[Aabb],
        (cubes, skin): (&[[f32; 4]], Skin),
    ) {
        self.fill_quads(executor, order, boxes);
        let growing = cubes.len();
        let (lower, upper) = (&mut self.lower[..growing], &mut self.upper[..growing]);
        let pool = executor.pool;
        pool.pieces_of_two([lower, upper], BOXES_PER_TASK, |start, [lower, upper]| {
            for ((lower, upper), cube) in lower.iter_mut().zip(upper).zip(&cubes[start..]) {
                let by = SCALE * skin.of(cube[3]);
                let ([x, y, z, _], [to_x, to_y, to_z, _]) = (*lower, *upper);
                let Aabb { min, max } = grown(Aabb::new([x, y, z], [to_x, to_y, to_z]), by);
                lower[..3].copy_from_slice(&min);
                upper[..3].copy_from_slice(&max);
            }
        });
        self.fill_columns(pool, true);
    }

    fn fill_columns(&mut self, pool: &Threads, runs: bool) {
        let sides = [&self.lower, &self.upper];
        pool.each(&mut self.columns, |index, column| {
            column.clear();
            if runs {
                column.extend(sides[index / 3].iter().map(|quad| quad[index % 3]));
            }
        });
    }

    fn fill_quads(&mut self, executor: Executor<'_>, order: &[u32], boxes: &[Aabb]) {
        let [lower, upper] = [&mut self.lower, &mut self.upper].map(|quads| {
            quads.resize(order.len() + MAX_WIDTH, [0.0; 4]);
            &mut quads[..order.len()]
        });
        let boxes = numbers_of(boxes);
        let Executor { tier, pool } = executor;
        pool.pieces_of_two([lower, upper], BOXES_PER_TASK, |start, [lower, upper]| {
            let fill = FillBoxes { names: &order[start..], boxes, lower, upper };
            dispatch(tier, fill);
        });
    }

    /// Whether each of the boxes `names` is within the box in the slot with the same index.
    pub fn hold(&self, executor: Executor<'_>, names: &[u32], boxes: &[Aabb]) -> bool {
        let Executor { tier, pool } = executor;
        pool.all(names.len(), BOXES_PER_TASK, |range| {
            let within =
                BoxesWithin { ends: self, first: range.start, names: &names[range], boxes };
            dispatch(tier, within)
        })
    }

    /// Bytes that the columns have allocated, used or not.
    pub fn bytes(&self) -> usize {
        let columns = self.columns.iter().map(bytes).sum::<usize>();
        bytes(&self.lower) + bytes(&self.upper) + columns
    }

    /// A vector of ends, from the slot `start` on.
    #[inline(always)]
    fn vector<L: Lanes>(&self, l: L, start: usize) -> [[L::F; 3]; 2] {
        // Written out, because closures would be compiled without the tier's features.
        let [x, y, z, to_x, to_y, to_z] = &self.columns;
        let lower = [l.load(&x[start..]), l.load(&y[start..]), l.load(&z[start..])];
        let upper = [l.load(&to_x[start..]), l.load(&to_y[start..]), l.load(&to_z[start..])];
        [lower, upper]
    }

    /// The ends in a slot, in all lanes.
    #[inline(always)]
    fn splat<L: Lanes>(&self, l: L, slot: usize) -> [[L::F; 3]; 2] {
        let ([x, y, z, _], [to_x, to_y, to_z, _]) = (self.lower[slot], self.upper[slot]);
        [[l.splat(x), l.splat(y), l.splat(z)], [l.splat(to_x), l.splat(to_y), l.splat(to_z)]]
    }
}

/// Bits of the lanes below `count` in which the two boxes, given by lower and upper ends, meet.
#[inline(always)]
fn with_common_points<L: Lanes>(
    l: L,
    [lo, hi]: [[L::F; 3]; 2],
    [other_lo, other_hi]: [[L::F; 3]; 2],
    count: usize,
) -> u32 {
    let mut apart = l.gt(lo[0], other_hi[0]) | l.gt(other_lo[0], hi[0]);
    for axis in 1..3 {
        apart = apart | l.gt(lo[axis], other_hi[axis]) | l.gt(other_lo[axis], hi[axis]);
    }
    !l.bits(apart) & l.bits(l.first(count))
}

impl SlotTest for EndSlots {
    #[inline(always)]
    fn run<L: Lanes>(&self, l: L, i: usize, run: Range<usize>, hits: &mut [u32]) -> usize {
        let one = self.splat(l, i);
        let (mut start, mut found) = (run.start, 0);
        while start < run.end {
            let hit = with_common_points(l, one, self.vector(l, start), run.end - start);
            found += list_slots(l, hit, start, &mut hits[found..]);
            start += L::WIDTH;
        }
        found
    }

    #[inline(always)]
    fn block<L: Lanes>(&self, l: L, block: &Block<'_>, hits: &mut [u32]) -> usize {
        let ours = [
            quads_in_columns(l, &self.lower[block.first()..]),
            quads_in_columns(l, &self.upper[block.first()..]),
        ];
        let count = block.codes().len();
        let (mut start, mut found) = (0, 0);
        while start < count {
            let (code, [[x, y, z, _], lower]) = block.balls(l, start, &ours[0], &self.lower);
            let (_, [[to_x, to_y, to_z, _], upper]) = block.balls(l, start, &ours[1], &self.upper);
            let one = [[x, y, z], [to_x, to_y, to_z]];
            let other = [[lower[0], lower[1], lower[2]], [upper[0], upper[1], upper[2]]];
            let hit = with_common_points(l, one, other, count - start);
            l.compress(hit, code, &mut hits[found..]);
            found += hit.count_ones() as usize;
            start += L::WIDTH;
        }
        found
    }
}

/// The box grown by a length on all sides, rounded inward: it is at most that large, and at least
/// as large as before.
pub(super) fn grown(Aabb { min, max }: Aabb, by: f32) -> Aabb {
    // The number before the one nearest to a sum is at most the sum.
    Aabb {
        min: min.map(|end| end.min((end - by).next_up())),
        max: max.map(|end| end.max((end + by).next_down())),
    }
}

/// Gathers boxes, six numbers each, in the order of `names`: lower and upper ends as quads.
struct FillBoxes<'a> {
    names: &'a [u32],
    boxes: &'a [[f32; 6]],
    lower: &'a mut [[f32; 4]],
    upper: &'a mut [[f32; 4]],
}

impl Kernel for FillBoxes<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let whole = self.lower.len() / L::WIDTH * L::WIDTH;
        for start in (0..whole).step_by(L::WIDTH) {
            let [x, y, z, to_x, to_y, to_z] = l.gather_sixes(self.boxes, &self.names[start..]);
            let zero = l.splat(0.0);
            l.store_quads([x, y, z, zero], &mut self.lower[start..]);
            l.store_quads([to_x, to_y, to_z, zero], &mut self.upper[start..]);
        }
        for slot in whole..self.lower.len() {
            let [x, y, z, to_x, to_y, to_z] = self.boxes[self.names[slot] as usize];
            self.lower[slot] = [x, y, z, 0.0];
            self.upper[slot] = [to_x, to_y, to_z, 0.0];
        }
    }
}

/// Tests whether boxes are within those in the slots from `first` on.
struct BoxesWithin<'a> {
    ends: &'a EndSlots,
    first: usize,
    names: &'a [u32],
    boxes: &'a [Aabb],
}

impl Kernel for BoxesWithin<'_> {
    type Output = bool;
    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> bool {
        let numbers = numbers_of(self.boxes);
        for start in (0..self.names.len()).step_by(L::WIDTH) {
            let left = &self.names[start..];
            let mut padded = [left[0]; MAX_WIDTH];
            let count = left.len().min(L::WIDTH);
            padded[..count].copy_from_slice(&left[..count]);
            let [x, y, z, to_x, to_y, to_z] = l.gather_sixes(numbers, &padded);
            let [lower, upper] = self.ends.vector(l, self.first + start);
            let outside = (l.gt(lower[0], x) | l.gt(lower[1], y) | l.gt(lower[2], z))
                | (l.gt(to_x, upper[0]) | l.gt(to_y, upper[1]) | l.gt(to_z, upper[2]));
            if l.bits(outside) & l.bits(l.first(count)) != 0 {
                return false;
            }
        }
        true
    }
}

#[cfg(test)]
mod tests;
