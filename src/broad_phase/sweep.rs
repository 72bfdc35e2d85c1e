//! `sweep`: sweep and prune along one axis ("box pruning"). Balls are sorted by their lower ends,
//! and each is tested against those that begin before it ends.
//!
//! The candidates of a ball are one contiguous run in the sorted order, so vectors are full. But
//! there are N^(5/3) of them in a cube: the grid was faster at every number of bodies and in every
//! arrangement that was tried, and `auto` never picks the sweep. Ends are widened and rounded
//! outward, because the sphere test rounds too: with plain fl(x ± R), a sweep misses one in twenty
//! pairs of unequal balls that touch to the last bit (`tests/finders/`).

use std::ops::Range;

use super::{FirstTest, Reorder, Slots, bytes};
use crate::bodies::Places;
use crate::rounding::{down, up, widen};
use crate::simd::{Lanes, MAX_WIDTH};

/// Frames between reorderings of the places.
const FRAMES_PER_REORDER: u32 = 32;

/// Slots per part of the work.
const SLOTS_PER_PART: usize = 64;

/// The factor by which another axis must have more spread before static bodies are sorted again.
const LEAST_SPREAD_RATIO: f64 = 1.5;

/// Moving bodies sorted along an axis, then static ones.
#[derive(Clone, Debug, Default)]
pub struct Sweep {
    slots: Slots,
    /// The ends along the axis, by slot.
    lo: Vec<f32>,
    hi: Vec<f32>,
    moving: usize,
    len: usize,
    axis: usize,
    fixed_sorted: bool,
    sorter: Sorter,
    age: u32,
}

impl Sweep {
    pub(super) fn reorder(
        &mut self,
        moving: usize,
        names: &[u32],
        order: &mut Vec<u32>,
    ) -> Reorder {
        self.age += 1;
        if !self.age.is_multiple_of(FRAMES_PER_REORDER) || self.len == 0 {
            return Reorder::None;
        }
        order.clear();
        order.extend_from_slice(&self.slots.names[..moving]);
        order.extend_from_slice(&names[moving..]);
        Reorder::Moving
    }

    pub(super) fn arrange(&mut self, places: &Places, balls: &[[f32; 4]], names: &[u32]) {
        let len = balls.len();
        if self.len != len {
            (self.len, self.fixed_sorted) = (len, false);
            self.lo.resize(len + MAX_WIDTH, 0.0);
            self.hi.resize(len + MAX_WIDTH, 0.0);
            self.slots.names.resize(len + MAX_WIDTH, 0);
            for column in &mut self.slots.columns {
                column.resize(len + MAX_WIDTH, 0.0);
            }
        }
        self.moving = places.moving;
        self.turn(balls);
        self.sort(0..self.moving, balls, names);
        if !self.fixed_sorted {
            self.sort(self.moving..len, balls, names);
            self.fixed_sorted = true;
        }
    }

    /// Picks the axis with the largest spread of centres.
    fn turn(&mut self, balls: &[[f32; 4]]) {
        let n = balls.len().max(1) as f64;
        let spread: [f64; 3] = std::array::from_fn(|axis| {
            let column = || balls.iter().map(|ball| f64::from(ball[axis]));
            let mean = column().sum::<f64>() / n;
            column().map(|x| (x - mean) * (x - mean)).sum()
        });
        for axis in 0..3 {
            if spread[axis] > LEAST_SPREAD_RATIO * spread[self.axis] {
                (self.axis, self.fixed_sorted) = (axis, false);
            }
        }
    }

    /// Sorts the bodies in a range of places by their lower ends. Bodies with the same end keep the
    /// order of places.
    fn sort(&mut self, range: Range<usize>, balls: &[[f32; 4]], names: &[u32]) {
        let ends = |ball: &[f32; 4]| {
            let (x, reach) = (f64::from(ball[self.axis]), f64::from(widen(ball[3])));
            (down(x - reach), up(x + reach))
        };
        let keys = balls[range.clone()].iter().map(|ball| ends(ball).0);
        let order = self.sorter.sort(keys);
        for (slot, &place) in range.clone().zip(order) {
            let place = range.start + place as usize;
            (self.lo[slot], self.hi[slot]) = ends(&balls[place]);
            self.slots.names[slot] = names[place];
            for (column, number) in self.slots.columns.iter_mut().zip(balls[place]) {
                column[slot] = number;
            }
        }
    }

    pub(super) fn bytes(&self) -> usize {
        let sorted = self.sorter.pairs.iter().map(bytes).sum::<usize>();
        self.slots.bytes() + bytes(&self.lo) + bytes(&self.hi) + sorted
    }

    pub(super) fn slots(&self) -> &Slots {
        &self.slots
    }

    pub(super) fn parts(&self) -> usize {
        self.moving.div_ceil(SLOTS_PER_PART) + (self.len - self.moving).div_ceil(SLOTS_PER_PART)
    }

    #[inline(always)]
    pub(super) fn find<L: Lanes>(&self, l: L, parts: Range<usize>, test: &mut impl FirstTest) {
        let moving_parts = self.moving.div_ceil(SLOTS_PER_PART);
        for part in parts {
            let (slots, moves) = if part < moving_parts {
                (part * SLOTS_PER_PART..self.moving, true)
            } else {
                (self.moving + (part - moving_parts) * SLOTS_PER_PART..self.len, false)
            };
            for i in slots.take(SLOTS_PER_PART) {
                let (moving, fixed) = (&self.lo[..self.moving], &self.lo[self.moving..self.len]);
                let runs = if moves {
                    // Moving bodies after it, and static ones that begin no earlier.
                    let start = self.moving + fixed.partition_point(|&lo| lo < self.lo[i]);
                    [i + 1..self.moving, start..self.len]
                } else {
                    // Moving bodies that begin later than this static one.
                    [moving.partition_point(|&lo| lo <= self.lo[i])..self.moving, 0..0]
                };
                // A loop, although they are two: the test is compiled into it once.
                for run in runs {
                    test.run(l, i, run.start..self.end(l, i, run));
                }
            }
        }
    }

    /// The index in a sorted range from which on balls begin after the end of slot `i`.
    #[inline(always)]
    fn end<L: Lanes>(&self, l: L, i: usize, range: Range<usize>) -> usize {
        let hi = l.splat(self.hi[i]);
        let mut start = range.start;
        while start < range.end {
            let behind = l.bits(l.gt(l.load(&self.lo[start..]), hi));
            if behind != 0 {
                return range.end.min(start + behind.trailing_zeros() as usize);
            }
            start += L::WIDTH;
        }
        range.end
    }
}

/// A radix sort that keeps its buffers.
#[derive(Clone, Debug, Default)]
struct Sorter {
    /// Buffers of (key, place), source and target of each pass.
    pairs: [Vec<(u32, u32)>; 2],
}

impl Sorter {
    /// Bits per pass. Three passes cover 33 bits, and the counts of each fit into the first-level
    /// cache.
    const BITS_PER_PASS: u32 = 11;

    /// The order of the keys by value, then by position. Keys must not be NaN.
    fn sort(&mut self, keys: impl Iterator<Item = f32>) -> impl Iterator<Item = &u32> {
        const BUCKETS: usize = 1 << Sorter::BITS_PER_PASS;
        let [from, to] = &mut self.pairs;
        from.clear();
        from.extend(keys.map(ordered).zip(0..));
        to.resize(from.len(), (0, 0));
        for pass in 0..3 {
            let digit = |key: u32| (key >> (pass * Self::BITS_PER_PASS)) as usize & (BUCKETS - 1);
            let mut next = [0u32; BUCKETS];
            for &(key, _) in from.iter() {
                next[digit(key)] += 1;
            }
            let mut sum = 0;
            for count in &mut next {
                (*count, sum) = (sum, sum + *count);
            }
            for &(key, place) in from.iter() {
                let at = &mut next[digit(key)];
                to[*at as usize] = (key, place);
                *at += 1;
            }
            std::mem::swap(from, to);
        }
        from.iter().map(|(_, place)| place)
    }
}

/// An integer with the order of the numbers, −0 before +0.
fn ordered(x: f32) -> u32 {
    let bits = x.to_bits();
    bits ^ if bits >> 31 == 1 { u32::MAX } else { 1 << 31 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Keys sort by value and stay in order when equal.
    #[test]
    fn radix_sort_is_stable() {
        let keys = [3.0, -1e-40, 0.0, -7.5, 3.0, f32::MAX, -0.0, f32::MIN, 1e-40, 3.0];
        let mut expected: Vec<u32> = (0..keys.len() as u32).collect();
        expected.sort_by(|&a, &b| keys[a as usize].total_cmp(&keys[b as usize]));
        let mut sorter = Sorter::default();
        for _ in 0..2 {
            let order: Vec<u32> = sorter.sort(keys.into_iter()).copied().collect();
            assert_eq!(order, expected);
        }
    }

    /// Spreads are 1.5 times as large at exactly √1.5 times the extent; the mean counts, and the
    /// place does not.
    #[test]
    fn axis_follows_the_spread() {
        let turned = |from: usize, columns: [[i8; 6]; 3]| {
            let ball = |i: usize| {
                let [x, y, z] = columns.map(|column| f32::from(column[i]));
                [40.0 + x, y - 7.0, z, 1.0]
            };
            let balls: Vec<_> = (0..6).map(ball).collect();
            let mut sweep = Sweep { axis: from, fixed_sorted: true, ..Sweep::default() };
            sweep.turn(&balls);
            (sweep.axis, sweep.fixed_sorted)
        };
        let four = [1, -1, 1, -1, 0, 0];
        let six = [1, -1, 1, -1, 1, -1];
        let ten = [1, -1, 2, -2, 0, 0];
        let none = [0; 6];
        assert_eq!(turned(0, [four, six, none]), (0, true), "by 1.5 exactly");
        assert_eq!(turned(0, [four, ten, six]), (1, false));
        assert_eq!(turned(0, [four, six, ten]), (2, false));
        assert_eq!(turned(2, [six, four, four]), (2, true));
        assert_eq!(turned(2, [ten, four, four]), (0, false));
        assert_eq!(turned(1, [none, four, none]), (1, true));
        assert_eq!(turned(1, [none; 3]), (1, true));
    }
}
