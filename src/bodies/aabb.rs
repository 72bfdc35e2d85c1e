//! World-aligned boxes, the type that engines pass to [`BoxCuller`](crate::BoxCuller) and
//! [`BoxWorld`](crate::BoxWorld).

use super::contract::{ContractError, refuse};
use crate::simd::{boxes_of, in_default_mode};

pub use crate::simd::Aabb;

impl Aabb {
    /// The box between two corners.
    #[must_use]
    pub fn new(min: impl Into<[f32; 3]>, max: impl Into<[f32; 3]>) -> Self {
        let (min, max) = (min.into(), max.into());
        Self { min, max }
    }

    /// Reads rows of six numbers as boxes, without a copy: the lower corner x, y, z, then the upper
    /// one.
    #[must_use]
    pub fn from_rows(rows: &[[f32; 6]]) -> &[Self] {
        boxes_of(rows)
    }

    /// Whether two boxes have a point in common.
    #[inline(always)]
    #[must_use]
    pub fn meets(&self, other: &Self) -> bool {
        // Without a branch: most callers have already rejected the pairs that are apart.
        let on =
            |axis: usize| (self.min[axis] <= other.max[axis]) & (other.min[axis] <= self.max[axis]);
        on(0) & on(1) & on(2)
    }

    /// Half of each side's length.
    pub(crate) fn half_sides(&self) -> [f32; 3] {
        std::array::from_fn(|axis| 0.5 * self.max[axis] - 0.5 * self.min[axis])
    }

    /// Checks that a box is valid; `body` is its number in the error.
    #[inline]
    pub(crate) fn check(&self, body: usize) -> Result<(), ContractError> {
        if self.is_surely_sound() {
            return Ok(());
        }
        self.check_ends(body)
    }

    #[cold]
    fn check_ends(&self, body: usize) -> Result<(), ContractError> {
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
