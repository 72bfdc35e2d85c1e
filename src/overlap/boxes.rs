//! Given boxes: apart iff on some axis one begins behind the other's end. Ends are compared as they are, so the answer is
//! exact, in either of two ways.
//!
//! Nearly cubic boxes leave little between the cube about them and the one within ([`cube`](crate::rounding::cube)): one quad
//! a box answers nearly all pairs, and the few others are looked up. Of long boxes the cubes know nothing; their ends stand in
//! slots as two quads, and are compared straight away.

use std::ops::Range;

use super::SlotTest;
use crate::bodies::Aabb;
use crate::broad_phase::{Arranged, Block};
use crate::rounding::cube::sure;
use crate::simd::{LANES, Lanes, MAX_WIDTH, quads_in_columns};
use crate::threads::Threads;

/// Boxes that one thread brings into slot order at a time.
const PIECE: usize = 4096;

/// Boxes by their cubes, which the finder has in its slots.
#[derive(Clone, Copy, Debug)]
pub struct Cubes<'a> {
    /// The cubes; slots are named by box.
    pub slots: Arranged<'a>,
    /// All boxes by name.
    pub boxes: &'a [Aabb],
    /// See [`less_than_sure`](crate::rounding::cube::less_than_sure).
    pub less: f32,
}

impl Cubes<'_> {
    /// Bits of the lanes below `count` whose boxes meet; `slots` says whose they are.
    #[inline(always)]
    fn meeting<L: Lanes>(
        &self,
        l: L,
        [one, other]: [[L::F; 4]; 2],
        count: usize,
        slots: impl Fn(usize) -> (usize, usize),
    ) -> u32 {
        let x = l.abs(other[0] - one[0]);
        let y = l.abs(other[1] - one[1]);
        let z = l.abs(other[2] - one[2]);
        let (far, reach) = (l.max(l.max(x, y), z), one[3] + other[3]);
        let mut hit = !l.bits(l.gt(far, reach)) & l.bits(l.first(count));
        let mut open = hit & l.bits(l.gt(far, sure(l, reach, self.less)));
        while open != 0 {
            let lane = open.trailing_zeros();
            open &= open - 1;
            if !self.boxes_meet(slots(lane as usize)) {
                hit &= !(1 << lane);
            }
        }
        hit
    }

    /// The definition, out of the way of what is asked for every vector.
    #[cold]
    fn boxes_meet(&self, (i, j): (usize, usize)) -> bool {
        let [a, b] = [i, j].map(|slot| &self.boxes[self.slots.names[slot] as usize]);
        a.meets(b)
    }

    /// The cubes in the slots from `start` on, a vector of them, as columns.
    #[inline(always)]
    fn vector<L: Lanes>(&self, l: L, start: usize) -> [L::F; 4] {
        let [x, y, z, half] = self.slots.columns;
        if x.is_empty() {
            l.load_quads(&self.slots.balls[start..])
        } else {
            [
                l.load(&x[start..]),
                l.load(&y[start..]),
                l.load(&z[start..]),
                l.load(&half[start..]),
            ]
        }
    }
}

impl SlotTest for Cubes<'_> {
    #[inline(always)]
    fn run<L: Lanes>(&self, l: L, i: usize, run: Range<usize>, hits: &mut [u32]) -> usize {
        let one = self.slots.ball(i).map(|number| l.splat(number));
        let (mut start, mut found) = (run.start, 0);
        while start < run.end {
            let cubes = [one, self.vector(l, start)];
            let hit = self.meeting(l, cubes, run.end - start, |lane| (i, start + lane));
            found += list(l, hit, start, &mut hits[found..]);
            start += L::WIDTH;
        }
        found
    }

    #[inline(always)]
    fn block<L: Lanes>(&self, l: L, block: &Block<'_>, hits: &mut [u32]) -> usize {
        let ours = quads_in_columns(l, &self.slots.balls[block.first()..]);
        let (first, codes) = (block.first(), block.codes());
        let (mut start, mut found) = (0, 0);
        while start < codes.len() {
            let (code, cubes) = block.balls(l, start, &ours, self.slots.balls);
            let hit = self.meeting(l, cubes, codes.len() - start, |lane| {
                let code = codes[start + lane];
                (first + (code & 15) as usize, (code >> 4) as usize)
            });
            l.compress(hit, code, &mut hits[found..]);
            found += hit.count_ones() as usize;
            start += L::WIDTH;
        }
        found
    }
}

/// Ends of boxes in the finder's slot order, each padded by [`MAX_WIDTH`] finite entries: as quads for scattered candidates,
/// whose fourth number is zero, and as columns for runs.
#[derive(Clone, Debug, Default)]
pub struct EndSlots {
    lower: Vec<[f32; 4]>,
    upper: Vec<[f32; 4]>,
    /// Lower ends on each axis, then upper ones.
    columns: [Vec<f32>; 6],
}

impl EndSlots {
    /// Takes the boxes in the order of slots.
    pub fn fill(&mut self, pool: &Threads, order: &[u32], boxes: &[Aabb]) {
        let corners: [fn(&Aabb) -> [f32; 3]; 2] = [|aabb| aabb.min, |aabb| aabb.max];
        for (quads, corner) in [&mut self.lower, &mut self.upper].into_iter().zip(corners) {
            quads.resize(order.len() + MAX_WIDTH, [0.0; 4]);
            pool.pieces(&mut quads[..order.len()], PIECE, |start, quads| {
                for (quad, &name) in quads.iter_mut().zip(&order[start..]) {
                    let [x, y, z] = corner(&boxes[name as usize]);
                    *quad = [x, y, z, 0.0];
                }
            });
        }
        let sides = [&self.lower, &self.upper];
        pool.each(&mut self.columns, |index, column| {
            column.clear();
            let ends = sides[index / 3].iter().map(|quad| quad[index % 3]);
            column.extend(ends);
        });
    }

    /// The ends in the slots from `start` on, a vector of them.
    #[inline(always)]
    fn vector<L: Lanes>(&self, l: L, start: usize) -> [[L::F; 3]; 2] {
        // Written out: closures would be compiled apart, without the tier's features.
        let [x, y, z, to_x, to_y, to_z] = &self.columns;
        let lower = [
            l.load(&x[start..]),
            l.load(&y[start..]),
            l.load(&z[start..]),
        ];
        let upper = [
            l.load(&to_x[start..]),
            l.load(&to_y[start..]),
            l.load(&to_z[start..]),
        ];
        [lower, upper]
    }

    /// The ends in a slot, in all lanes.
    #[inline(always)]
    fn splat<L: Lanes>(&self, l: L, slot: usize) -> [[L::F; 3]; 2] {
        let ([x, y, z, _], [to_x, to_y, to_z, _]) = (self.lower[slot], self.upper[slot]);
        [
            [l.splat(x), l.splat(y), l.splat(z)],
            [l.splat(to_x), l.splat(to_y), l.splat(to_z)],
        ]
    }
}

/// Bits of the lanes below `count` whose boxes, each as its lower and upper ends, meet.
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
            found += list(l, hit, start, &mut hits[found..]);
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
            let other = [
                [lower[0], lower[1], lower[2]],
                [upper[0], upper[1], upper[2]],
            ];
            let hit = with_common_points(l, one, other, count - start);
            l.compress(hit, code, &mut hits[found..]);
            found += hit.count_ones() as usize;
            start += L::WIDTH;
        }
        found
    }
}

/// Writes the slots from `start` on whose bits are set; how many.
#[inline(always)]
fn list<L: Lanes>(l: L, hit: u32, start: usize, hits: &mut [u32]) -> usize {
    let slot = l.add_u32(l.splat_u32(start as u32), l.load_u32(&LANES));
    l.compress(hit, slot, hits);
    hit.count_ones() as usize
}

#[cfg(test)]
mod tests {
    use super::super::whole_vectors::{SLOTS, check};
    use super::*;
    use crate::broad_phase::Slots;

    #[test]
    fn boxes_that_fill_their_vectors_cost_no_vector_more() {
        check(&EndSlots {
            lower: vec![[1.0, 1.0, 1.0, 0.0]; SLOTS],
            upper: vec![[2.0, 2.0, 2.0, 0.0]; SLOTS],
            columns: [1.0, 1.0, 1.0, 2.0, 2.0, 2.0].map(|end| vec![end; SLOTS]),
        });
        let mut slots = Slots {
            balls: vec![[1.5, 1.5, 1.5, 0.5]; SLOTS],
            names: (0..SLOTS as u32).collect(),
            ..Slots::default()
        };
        let boxes = [Aabb::new([1.0; 3], [2.0; 3]); SLOTS];
        let cubes = |slots: &Slots| {
            check(&Cubes {
                slots: slots.arranged(),
                boxes: &boxes,
                less: 0.0,
            });
        };
        cubes(&slots);
        let [x, y, z, half] = [1.5, 1.5, 1.5, 0.5].map(|number| vec![number; SLOTS]);
        slots.columns = [x, y, z, half];
        cubes(&slots);
    }

    #[test]
    fn ends_have_the_order_of_slots_and_a_vector_of_finite_ones_behind_it() {
        let mut slots = EndSlots::default();
        for bodies in [1, 3, 2] {
            let boxes: Vec<_> = (0..bodies as u8)
                .map(|i| Aabb::new([f32::from(i); 3], [f32::from(i) + 9.0; 3]))
                .collect();
            let order: Vec<u32> = (0..bodies as u32).rev().collect();
            slots.fill(&Threads::default(), &order, &boxes);
            let padded = bodies + MAX_WIDTH;
            assert_eq!([slots.lower.len(), slots.upper.len()], [padded; 2]);
            for (index, column) in slots.columns.iter().enumerate() {
                let ends = order.iter().map(|&name| {
                    let Aabb { min, max } = boxes[name as usize];
                    [min, max][index / 3][index % 3]
                });
                assert_eq!(column[..bodies], ends.collect::<Vec<_>>());
                assert_eq!(column.len(), padded);
                assert!(column[bodies..].iter().all(|end| end.is_finite()));
            }
        }
    }
}
