//! Boxes by their cubes: two cubes apart are two boxes apart, two *inner* cubes that meet are two boxes that meet, and only
//! what lies between is looked up in the boxes themselves.
//!
//! With c the centre, H the half side of the cube about a box and h that of the cube inside it, and δ the greatest H − h of
//! the frame, for the Chebyshev distance d of two centres: d > H₁ + H₂ is apart; d ≤ H₁ + H₂ − 2δ ≤ h₁ + h₂ meets. Boxes of
//! balls leave one pair in thousands between; long ones leave more, and lose time and nothing else.

use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use sdop::broad_phase::{Block, FirstTest, MOST_CANDIDATES, PairFinder, Slots};
use sdop::simd::{Kernel, LANES, Lanes, MAX_WIDTH, quads_in_columns};

use crate::boxes::{Slabs, meet};

/// Slots of a run that are tested at once.
const PIECE: usize = MOST_CANDIDATES;

/// What a cube is wider than its box, and what counts as sure is narrower: rounding takes 2⁻²⁴ of each of the few
/// differences and sums between boxes and an answer.
const WIDER: f32 = 1.0 + 1.0 / (1 << 20) as f32;
const NARROWER: f32 = 1.0 - 1.0 / (1 << 20) as f32;
/// The same for boxes without an extent.
const FLOOR: f32 = 1e-30;

/// The cube about a box as centre and half side H, and its H − h.
#[inline(always)]
pub fn cube_about(slabs: &Slabs) -> ([f32; 4], f32) {
    // Unlike `f32::max`, one instruction.
    let larger = |a: f32, b: f32| if a > b { a } else { b };
    let smaller = |a: f32, b: f32| if a < b { a } else { b };
    let (mut cube, mut outer, mut inner) = ([0.0; 4], 0.0, f32::MAX);
    for (axis, &[lo, hi]) in slabs.iter().enumerate() {
        let centre = 0.5 * (lo + hi);
        let (below, above) = (centre - lo, hi - centre);
        outer = larger(outer, larger(below, above));
        inner = smaller(inner, smaller(below, above));
        cube[axis] = centre;
    }
    cube[3] = outer * WIDER + FLOOR;
    (cube, cube[3] - inner)
}

/// The greatest H − h of a frame's boxes, as the bits of a number that isn't negative.
#[derive(Default)]
pub struct Gap(AtomicU32);

impl Gap {
    /// Raises the gap to that of more boxes, if it is greater.
    pub fn raise(&self, gap: f32) {
        self.0.fetch_max(gap.to_bits(), Relaxed);
    }

    /// 2δ.
    pub fn twice(&self) -> f32 {
        2.0 * f32::from_bits(self.0.load(Relaxed))
    }
}

/// The distance up to which two boxes surely meet, a lane: H₁ + H₂ − 2δ and less than that.
#[inline(always)]
fn sure<L: Lanes>(l: L, reach: L::F, twice_gap: f32) -> L::F {
    (reach - l.splat(twice_gap)) * l.splat(NARROWER) - l.splat(FLOOR)
}

/// The pairs of one share of the work, as two columns.
#[derive(Clone, Debug, Default)]
pub struct Found {
    first: Vec<u32>,
    second: Vec<u32>,
    len: usize,
    candidates: u64,
}

impl Found {
    /// How many candidates led to them.
    pub fn candidates(&self) -> u64 {
        self.candidates
    }

    /// The pairs.
    pub fn pairs(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        let columns = self.first.iter().zip(&self.second);
        columns.take(self.len).map(|(&i, &j)| [i, j])
    }

    /// Both columns behind the last pair, with room for `more`.
    #[inline(always)]
    fn room(&mut self, more: usize) -> (&mut [u32], &mut [u32]) {
        let needed = self.len + more;
        if needed > self.first.len() {
            let size = needed.next_power_of_two();
            self.first.resize(size, 0);
            self.second.resize(size, 0);
        }
        let behind = self.len..needed;
        (&mut self.first[behind.clone()], &mut self.second[behind])
    }
}

/// The search of some parts.
pub struct Find<'a> {
    /// Where candidates come from.
    pub finder: &'a PairFinder,
    /// Which.
    pub parts: Range<usize>,
    /// What is done with them.
    pub test: Test<'a>,
}

impl Kernel for Find<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(mut self, l: L) {
        self.finder.find(l, self.parts, &mut self.test);
    }
}

/// The test of a frame's boxes.
pub struct Test<'a> {
    slots: &'a Slots,
    /// By body.
    boxes: &'a [Slabs],
    twice_gap: f32,
    found: &'a mut Found,
    hits: [u32; PIECE + MAX_WIDTH],
}

impl<'a> Test<'a> {
    /// A test that begins a new list in `found`.
    pub fn new(slots: &'a Slots, boxes: &'a [Slabs], twice_gap: f32, found: &'a mut Found) -> Self {
        (found.len, found.candidates) = (0, 0);
        Self {
            slots,
            boxes,
            twice_gap,
            found,
            hits: [0; PIECE + MAX_WIDTH],
        }
    }

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
        let mut open = hit & l.bits(l.gt(far, sure(l, reach, self.twice_gap)));
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
        meet(a, b)
    }

    /// The cubes in the slots from `start` on, a vector of them, as columns.
    #[inline(always)]
    fn cubes<L: Lanes>(&self, l: L, start: usize) -> [L::F; 4] {
        let [x, y, z, half] = &self.slots.columns;
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

    /// Lists the first `count` hits by body.
    #[inline(always)]
    fn list(&mut self, count: usize, slots: impl Fn(u32) -> (usize, usize)) {
        let names = &self.slots.names;
        let (first, second) = self.found.room(count);
        for ((first, second), &hit) in first.iter_mut().zip(second).zip(&self.hits) {
            let (i, j) = slots(hit);
            (*first, *second) = (names[i], names[j]);
        }
        self.found.len += count;
    }
}

impl FirstTest for Test<'_> {
    #[inline(always)]
    fn run<L: Lanes>(&mut self, l: L, i: usize, run: Range<usize>) {
        self.found.candidates += run.len() as u64;
        let one = self.slots.ball(i).map(|number| l.splat(number));
        for first in run.clone().step_by(PIECE) {
            let (end, mut found) = (run.end.min(first + PIECE), 0);
            for start in (first..end).step_by(L::WIDTH) {
                let cubes = [one, self.cubes(l, start)];
                let hit = self.meeting(l, cubes, end - start, |lane| (i, start + lane));
                let slot = l.add_u32(l.splat_u32(start as u32), l.load_u32(&LANES));
                l.compress(hit, slot, &mut self.hits[found..]);
                found += hit.count_ones() as usize;
            }
            self.list(found, |slot| (i, slot as usize));
        }
    }

    #[inline(always)]
    fn block<L: Lanes>(&mut self, l: L, block: &Block) {
        let (codes, count) = (block.padded_codes(), block.codes().len());
        self.found.candidates += count as u64;
        let (first, mut found) = (block.first(), 0);
        let slots = |code: u32| (first + (code & 15) as usize, (code >> 4) as usize);
        let ours = quads_in_columns(l, &self.slots.balls[first..]);
        for start in (0..count).step_by(L::WIDTH) {
            let code = l.load_u32(&codes[start..]);
            let (_, lane) = l.split_u32(code);
            let [x, y, z, half] = &ours;
            let one = [
                l.lookup_16(x, lane),
                l.lookup_16(y, lane),
                l.lookup_16(z, lane),
                l.lookup_16(half, lane),
            ];
            let other = l.gather_quads(&self.slots.balls, &codes[start..]);
            let hit = self.meeting(l, [one, other], count - start, |lane| {
                slots(codes[start + lane])
            });
            l.compress(hit, code, &mut self.hits[found..]);
            found += hit.count_ones() as usize;
        }
        self.list(found, slots);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use sdop::simd::{Tier, dispatch};

    /// Boxes within a few units, whose sides may differ and be nothing; lengths that don't round and lengths that do.
    fn slabs() -> impl Strategy<Value = Slabs> {
        let end = prop_oneof![(0_i8..9).prop_map(f32::from), 0.0_f32..9.0];
        let offset = prop_oneof![Just(0.0_f32), Just(1e4), Just(-3e6)];
        (
            [
                [end.clone(), end.clone()],
                [end.clone(), end.clone()],
                [end.clone(), end],
            ],
            offset,
        )
            .prop_map(|(ends, offset)| ends.map(|[a, b]| [a.min(b) + offset, a.max(b) + offset]))
    }

    /// What the cubes of two boxes say: whether the boxes meet, if they know.
    struct Say<'a>(&'a Slabs, &'a Slabs);

    impl Kernel for Say<'_> {
        type Output = Option<bool>;
        #[inline(always)]
        fn run<L: Lanes>(self, l: L) -> Option<bool> {
            let ((one, round), (other, rounder)) = (cube_about(self.0), cube_about(self.1));
            let gap = Gap::default();
            gap.raise(round);
            gap.raise(rounder);
            let far = (0..3).map(|axis| (one[axis] - other[axis]).abs());
            let far = l.splat(far.fold(0.0, f32::max));
            let reach = l.splat(one[3]) + l.splat(other[3]);
            let beyond = |distance| l.bits(l.gt(far, distance)) & 1 == 1;
            match (beyond(reach), beyond(sure(l, reach, gap.twice()))) {
                (true, _) => Some(false),
                (false, true) => None,
                (false, false) => Some(true),
            }
        }
    }

    proptest! {
        #[test]
        fn cubes_answer_as_their_boxes_do(a in slabs(), b in slabs()) {
            if let Some(answer) = dispatch(Tier::detect(), Say(&a, &b)) {
                prop_assert_eq!(answer, meet(&a, &b));
            }
        }
    }

    #[test]
    fn cubes_of_balls_know_nearly_always() {
        let cube = |x: f32| [[x - 1.0, x + 1.0], [-1.0, 1.0], [300.0, 302.0]];
        let knows = |x: f32| dispatch(Tier::detect(), Say(&cube(0.1), &cube(x)));
        assert_eq!(knows(2.099), Some(true));
        assert_eq!(knows(2.101), Some(false));
    }
}
