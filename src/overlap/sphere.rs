//! Sphere against a run of spheres: cull iff d² > s², s = R_i + R_j, with R from [`inflate_radius`].
//!
//! d² sums the squares of coordinate differences: expanding the square instead would cancel far from the origin.
//!
//! [`inflate_radius`]: crate::rounding::sphere::inflate_radius

use std::ops::Range;

use crate::pairs::PairList;
use crate::simd::Lanes;

/// World spheres as columns in the pair finder's slot order, padded by [`MAX_WIDTH`](crate::simd::MAX_WIDTH) finite
/// entries.
#[derive(Clone, Debug, Default)]
pub struct SphereSlots {
    /// Centre, world frame.
    pub x: Vec<f32>,
    /// Centre, world frame.
    pub y: Vec<f32>,
    /// Centre, world frame.
    pub z: Vec<f32>,
    /// Inflated radius.
    pub r: Vec<f32>,
    /// Which body stands in the slot.
    pub body: Vec<u32>,
}

impl SphereSlots {
    /// Appends to `out` the pairs of slot `i` and each slot of `run` whose spheres may touch, as body indices, lower first.
    #[inline(always)]
    pub fn test_run<L: Lanes>(&self, l: L, i: usize, run: Range<usize>, out: &mut PairList) {
        let (xi, yi, zi) = (l.splat(self.x[i]), l.splat(self.y[i]), l.splat(self.z[i]));
        let (ri, body_i) = (l.splat(self.r[i]), l.splat_u32(self.body[i]));
        let mut start = run.start;
        while start < run.end {
            let (dx, dy) = (l.load(&self.x[start..]) - xi, l.load(&self.y[start..]) - yi);
            let dz = l.load(&self.z[start..]) - zi;
            let s = l.load(&self.r[start..]) + ri;
            let apart = l.gt((dx * dx + dy * dy) + dz * dz, s * s);
            let hit = !l.bits(apart) & l.bits(l.first(run.end - start));
            if hit != 0 {
                let body_j = l.load_u32(&self.body[start..]);
                let (first, second) = out.room(L::WIDTH);
                l.compress(hit, l.min_u32(body_i, body_j), first);
                l.compress(hit, l.max_u32(body_i, body_j), second);
                out.advance(hit.count_ones() as usize);
            }
            start += L::WIDTH;
        }
    }
}
