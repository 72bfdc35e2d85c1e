//! Cubes about boxes, a vector of them at a time.

use crate::bodies::Aabb;
use crate::rounding::cube::Cube;
use crate::simd::{Kernel, Lanes, MAX_WIDTH};

/// Boxes that are copied before any is looked at: each is a cache miss, and so more of them are on their way at once.
const TOGETHER: usize = 64;

/// Makes the cubes of the boxes of these names. Returns the greatest H − h, and whether all boxes are sound.
pub(super) struct Make<'a> {
    pub boxes: &'a [Aabb],
    pub names: &'a [u32],
    pub cubes: &'a mut [[f32; 4]],
}

impl Kernel for Make<'_> {
    type Output = (f32, bool);
    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> (f32, bool) {
        let all = l.bits(l.first(L::WIDTH));
        let (mut greatest, mut sound) = (l.splat(0.0), all);
        let mut near = [[[0.0; 4]; TOGETHER]; 2];
        let cubes = self.cubes.chunks_mut(TOGETHER);
        for (cubes, names) in cubes.zip(self.names.chunks(TOGETHER)) {
            copy(self.boxes, names, &mut near);
            let [fronts, backs] = &near;
            for (start, cubes) in (0..).step_by(MAX_WIDTH).zip(cubes.chunks_mut(MAX_WIDTH)) {
                let mut columns = [[0.0; MAX_WIDTH]; 4];
                for lane in (0..MAX_WIDTH).step_by(L::WIDTH) {
                    let [x, y, z, _] = l.load_quads(&fronts[start + lane..]);
                    let [_, to_x, to_y, to_z] = l.load_quads(&backs[start + lane..]);
                    let cube = Cube::about(l, [x, y, z], [to_x, to_y, to_z]);
                    for (column, lanes) in columns.iter_mut().zip(cube.outer) {
                        l.store(lanes, &mut column[lane..]);
                    }
                    greatest = l.max(cube.gap, greatest);
                    sound &= cube.sound;
                }
                let [x, y, z, half] = columns;
                let numbers = x.into_iter().zip(y).zip(z).zip(half);
                for (to, (((x, y), z), half)) in cubes.iter_mut().zip(numbers) {
                    *to = [x, y, z, half];
                }
            }
        }
        let mut gaps = [0.0; MAX_WIDTH];
        l.store(greatest, &mut gaps);
        (gaps.into_iter().fold(0.0, f32::max), sound == all)
    }
}

/// Copies boxes as their first and last four numbers, each of which is one load; lanes without a box take the first one again.
#[inline(always)]
fn copy(boxes: &[Aabb], names: &[u32], [fronts, backs]: &mut [[[f32; 4]; TOGETHER]; 2]) {
    for ((front, back), &name) in fronts.iter_mut().zip(&mut *backs).zip(names) {
        let Aabb { min, max } = boxes[name as usize];
        *front = [min[0], min[1], min[2], max[0]];
        *back = [min[2], max[0], max[1], max[2]];
    }
    let spare = names.len()..names.len().next_multiple_of(MAX_WIDTH);
    let (front, back) = (fronts[0], backs[0]);
    fronts[spare.clone()].fill(front);
    backs[spare].fill(back);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::{Tier, dispatch};

    /// What a tier makes of boxes in an order of its own: their cubes, the greatest H − h, and whether all are sound.
    fn made(tier: Tier, boxes: &[Aabb], names: &[u32]) -> (Vec<[f32; 4]>, f32, bool) {
        let mut cubes = vec![[f32::NAN; 4]; names.len()];
        let make = Make {
            boxes,
            names,
            cubes: &mut cubes,
        };
        let (gap, are_sound) = dispatch(tier, make);
        (cubes, gap, are_sound)
    }

    /// Of so many boxes, the last of which is the longest.
    fn boxes(count: usize) -> Vec<Aabb> {
        let long = |i: usize| if i + 1 == count { 800.0 } else { 8.0 };
        let from = |i: usize| [16.0 * i as f32, -24.0, 8.0 * (i % 7) as f32];
        (0..count)
            .map(|i| (from(i), long(i)))
            .map(|([x, y, z], long)| Aabb::new([x, y, z], [x + 16.0, y + 8.0, z + long]))
            .collect()
    }

    #[test]
    fn every_box_has_its_cube_in_every_tier() {
        for count in [1, 15, 16, 17, TOGETHER, TOGETHER + 1, 150] {
            let boxes = boxes(count);
            let names: Vec<u32> = (0..count as u32).rev().collect();
            for tier in Tier::available() {
                let (cubes, gap, are_sound) = made(tier, &boxes, &names);
                for (cube, &name) in cubes.iter().zip(&names) {
                    let Aabb { min, max } = boxes[name as usize];
                    let centre: [f32; 3] = std::array::from_fn(|k| (min[k] + max[k]) / 16.0);
                    let half = (0..3).map(|k| (max[k] - min[k]) / 16.0).fold(0.0, f32::max);
                    assert_eq!(cube[..3], centre, "{tier}: {name} of {count}");
                    assert!(
                        cube[3] >= half && cube[3] <= half * 1.000_01,
                        "{tier}: {name}"
                    );
                }
                // The longest has H = 50 and h = 1/2.
                assert!(
                    (49.5..49.501).contains(&gap) && are_sound,
                    "{tier}: {gap} of {count}"
                );
            }
        }
    }

    #[test]
    fn a_box_that_is_none_is_told_wherever_it_stands() {
        let names: Vec<u32> = (0..40).collect();
        for bad in 0..40 {
            let mut boxes = boxes(40);
            boxes[bad].max[bad % 3] = f32::NAN;
            for tier in Tier::available() {
                assert!(!made(tier, &boxes, &names).2, "{tier}: {bad}");
            }
        }
    }
}
