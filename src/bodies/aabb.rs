//! Boxes on the world's axes, as engines hand them over.

use super::contract::{ContractError, refuse};
use crate::simd::in_default_mode;

/// A closed box on the world's axes: boxes that touch meet. Its ends are finite, and no lower one is above the upper one;
/// sides of no length are fine.
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Aabb {
    /// The lower corner.
    pub min: [f32; 3],
    /// The upper corner.
    pub max: [f32; 3],
}

impl Aabb {
    /// The box between two corners.
    #[must_use]
    pub fn new(min: impl Into<[f32; 3]>, max: impl Into<[f32; 3]>) -> Self {
        let (min, max) = (min.into(), max.into());
        Self { min, max }
    }

    /// Whether two boxes have a point in common.
    #[inline(always)]
    #[must_use]
    pub fn meets(&self, other: &Self) -> bool {
        // Without a branch: who asks has mostly sifted before.
        let on =
            |axis: usize| (self.min[axis] <= other.max[axis]) & (other.min[axis] <= self.max[axis]);
        on(0) & on(1) & on(2)
    }

    /// Half its sides.
    pub(crate) fn half_sides(&self) -> [f32; 3] {
        std::array::from_fn(|axis| 0.5 * self.max[axis] - 0.5 * self.min[axis])
    }

    /// Checks that a box is one; `body` is its number.
    pub(crate) fn check(&self, body: usize) -> Result<(), ContractError> {
        let is_sound = |axis: usize| {
            let [lo, hi] = [self.min[axis], self.max[axis]];
            lo <= hi && f32::MIN <= lo && hi <= f32::MAX
        };
        if in_default_mode(|| (0..3).all(is_sound)) {
            return Ok(());
        }
        let value = format!("from {:?} to {:?}", self.min, self.max);
        let hint = "ends are finite, and `min` is at most `max` on each axis";
        refuse(body, "box", value, hint)
    }
}
