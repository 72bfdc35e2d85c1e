//! Computes cubes around boxes, a vector of them at a time.

use crate::bodies::Aabb;
use crate::rounding::cube::Cube;
use crate::simd::{Kernel, Lanes, MAX_WIDTH, numbers_of, prefetch_ends};

/// Boxes are prefetched this many names ahead: neighbours in space can be anywhere in the user's
/// list, and a core can overlap dozens of cache misses.
pub(super) const PREFETCH_DISTANCE: usize = 128;

/// Computes the cubes of the boxes with these names. Returns the greatest H − h, and whether all
/// boxes are valid.
pub(super) struct MakeCubes<'a> {
    pub boxes: &'a [Aabb],
    pub names: &'a [u32],
    /// The names from number [`PREFETCH_DISTANCE`] on, whose boxes are prefetched, or none if boxes
    /// are in the caches.
    pub ahead: &'a [u32],
    pub cubes: &'a mut [[f32; 4]],
}

impl Kernel for MakeCubes<'_> {
    type Output = (f32, bool);
    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> (f32, bool) {
        let mut seen = CubeFacts { gap: l.splat(0.0), sound: u32::MAX };
        let numbers = numbers_of(self.boxes);
        let mut ahead = self.ahead.chunks(MAX_WIDTH);
        let cubes = self.cubes.chunks_mut(MAX_WIDTH);
        for (cubes, names) in cubes.zip(self.names.chunks(MAX_WIDTH)) {
            for &name in ahead.next().unwrap_or_default() {
                prefetch_ends(&numbers[name as usize]);
            }
            match (names.first_chunk(), cubes.first_chunk_mut()) {
                (Some(names), Some(cubes)) => seen.make(l, numbers, names, cubes),
                _ => {
                    let (mut whole, mut made) = ([names[0]; MAX_WIDTH], [[0.0; 4]; MAX_WIDTH]);
                    whole[..names.len()].copy_from_slice(names);
                    seen.make(l, numbers, &whole, &mut made);
                    cubes.copy_from_slice(&made[..cubes.len()]);
                }
            }
        }
        let mut gaps = [0.0; MAX_WIDTH];
        l.store(seen.gap, &mut gaps);
        let all = l.bits(l.first(L::WIDTH));
        let gap = gaps.into_iter().fold(0.0, f32::max);
        (gap, seen.sound & all == all)
    }
}

/// Facts about all computed cubes.
struct CubeFacts<L: Lanes> {
    /// The greatest H − h in each lane.
    gap: L::F,
    /// A bit for each lane that had only valid boxes.
    sound: u32,
}

impl<L: Lanes> CubeFacts<L> {
    /// Computes the cubes of sixteen boxes, each given as six numbers.
    #[inline(always)]
    fn make(
        &mut self,
        l: L,
        boxes: &[[f32; 6]],
        names: &[u32; MAX_WIDTH],
        cubes: &mut [[f32; 4]; MAX_WIDTH],
    ) {
        for lane in (0..MAX_WIDTH).step_by(L::WIDTH) {
            let [x, y, z, to_x, to_y, to_z] = l.gather_sixes(boxes, &names[lane..]);
            let cube = Cube::about(l, [x, y, z], [to_x, to_y, to_z]);
            l.store_quads(cube.outer, &mut cubes[lane..]);
            self.gap = l.max(cube.gap, self.gap);
            self.sound &= cube.sound;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::{Tier, dispatch};

    /// The results of a tier for boxes in the order of `names`: their cubes, the greatest H − h,
    /// and whether all are valid.
    fn made(tier: Tier, boxes: &[Aabb], names: &[u32]) -> (Vec<[f32; 4]>, f32, bool) {
        let mut cubes = vec![[f32::NAN; 4]; names.len()];
        let make = MakeCubes {
            boxes,
            names,
            ahead: names.get(PREFETCH_DISTANCE..).unwrap_or_default(),
            cubes: &mut cubes,
        };
        let (gap, are_sound) = dispatch(tier, make);
        (cubes, gap, are_sound)
    }

    /// `count` boxes, of which the last is the longest.
    fn boxes(count: usize) -> Vec<Aabb> {
        let long = |i: usize| if i + 1 == count { 800.0 } else { 8.0 };
        let from = |i: usize| [16.0 * i as f32, -24.0, 8.0 * (i % 7) as f32];
        (0..count)
            .map(|i| (from(i), long(i)))
            .map(|([x, y, z], long)| Aabb::new([x, y, z], [x + 16.0, y + 8.0, z + long]))
            .collect()
    }

    /// Every box has its cube in every tier.
    #[test]
    fn cubes_are_equal_in_tiers() {
        for count in [1, 15, 16, 17, 33, PREFETCH_DISTANCE + 22] {
            let boxes = boxes(count);
            let names: Vec<u32> = (0..count as u32).rev().collect();
            for tier in Tier::available() {
                let (cubes, gap, are_sound) = made(tier, &boxes, &names);
                for (cube, &name) in cubes.iter().zip(&names) {
                    let Aabb { min, max } = boxes[name as usize];
                    let centre: [f32; 3] = std::array::from_fn(|k| (min[k] + max[k]) / 16.0);
                    let half = (0..3).map(|k| (max[k] - min[k]) / 16.0).fold(0.0, f32::max);
                    assert_eq!(cube[..3], centre, "{tier}: {name} of {count}");
                    assert!(cube[3] >= half && cube[3] <= half * 1.000_01, "{tier}: {name}");
                }
                // The longest has H = 50 and h = 1/2.
                assert!((49.5..49.501).contains(&gap) && are_sound, "{tier}: {gap} of {count}");
            }
        }
    }

    /// An invalid box is reported at every position.
    #[test]
    fn invalid_boxes_are_reported() {
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
