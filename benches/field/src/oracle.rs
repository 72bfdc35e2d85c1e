//! The oracle: the pairs that every engine must report, found independently of all engines by
//! columns of cells over y and z with a sweep along x in each.
//!
//! A box is in every column that it overlaps. A pair is reported in the column of the larger of
//! both lower ends on y and on z: there is exactly one such column, and both boxes overlap it.

use crate::frame::{Slabs, meet};

/// The number of columns per side for this many boxes.
fn columns(boxes: usize) -> usize {
    ((boxes as f64 / 4.0).cbrt() as usize).clamp(1, 512)
}

/// All pairs i < j of closed boxes that meet, sorted.
pub fn pairs(boxes: &[Slabs]) -> Vec<[u32; 2]> {
    let grid = Columns::new(boxes);
    let mut members = vec![Vec::new(); grid.count * grid.count];
    for (i, slabs) in boxes.iter().enumerate() {
        let [y, z] = [1, 2].map(|axis| slabs[axis].map(|x| grid.column(axis, x)));
        for row in z[0]..=z[1] {
            for column in y[0]..=y[1] {
                members[row * grid.count + column].push(i as u32);
            }
        }
    }
    let mut pairs = Vec::new();
    for (cell, members) in members.iter_mut().enumerate() {
        let lower_x = |&i: &u32| boxes[i as usize][0][0];
        members.sort_unstable_by(|a, b| lower_x(a).total_cmp(&lower_x(b)));
        for (at, &i) in members.iter().enumerate() {
            let one = &boxes[i as usize];
            for &j in members[at + 1..].iter() {
                let other = &boxes[j as usize];
                if other[0][0] > one[0][1] {
                    break;
                }
                if meet(one, other) && grid.home(one, other) == cell {
                    pairs.push([i.min(j), i.max(j)]);
                }
            }
        }
    }
    pairs.sort_unstable();
    pairs
}

struct Columns {
    count: usize,
    lo: [f32; 3],
    width: [f32; 3],
}

impl Columns {
    fn new(boxes: &[Slabs]) -> Self {
        let count = columns(boxes.len());
        let end = |axis: usize, side: usize, pick: fn(f32, f32) -> f32, from: f32| {
            boxes.iter().map(|b| b[axis][side]).fold(from, pick)
        };
        let lo = [0, 1, 2].map(|axis| end(axis, 0, f32::min, f32::INFINITY));
        let hi = [0, 1, 2].map(|axis| end(axis, 1, f32::max, f32::NEG_INFINITY));
        Self { count, lo, width: [0, 1, 2].map(|axis| (hi[axis] - lo[axis]) / count as f32) }
    }

    /// Monotonous in x, so that a column between two others is between their ends.
    fn column(&self, axis: usize, x: f32) -> usize {
        (((x - self.lo[axis]) / self.width[axis]) as usize).min(self.count - 1)
    }

    fn home(&self, one: &Slabs, other: &Slabs) -> usize {
        let [y, z] = [1, 2].map(|axis| self.column(axis, one[axis][0].max(other[axis][0])));
        z * self.count + y
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::collection::vec;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_oracle_is_the_double_loop(
            boxes in vec(([0_i8..40, 0..40, 0..40], 0_i8..9), 0..200)
        ) {
            let boxes: Vec<Slabs> = boxes
                .into_iter()
                .map(|(at, size)| at.map(|x| [f32::from(x), f32::from(x + size)]))
                .collect();
            let mut naive = Vec::new();
            for j in 0..boxes.len() {
                for i in 0..j {
                    if meet(&boxes[i], &boxes[j]) {
                        naive.push([i as u32, j as u32]);
                    }
                }
            }
            naive.sort_unstable();
            prop_assert_eq!(pairs(&boxes), naive);
        }
    }
}
