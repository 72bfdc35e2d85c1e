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

    /// The bits of the ends. Comparing bits works in every floating-point mode.
    #[inline]
    pub(crate) fn bits(&self) -> [[u32; 3]; 2] {
        [self.min, self.max].map(|corner| corner.map(f32::to_bits))
    }

    /// Whether the ends are finite and in order. Compares bits, so it works in every floating-point
    /// mode; it is false for a lower end of 0 and an upper end of −0.
    #[inline]
    fn is_surely_sound(&self) -> bool {
        // The bits of positive numbers are in the order of the numbers; those of negative ones in
        // the opposite order.
        let rank = |bits: u32| (bits ^ (((bits as i32) >> 31) as u32 >> 1)) as i32;
        let size = |bits: u32| bits & !(1 << 31);
        let [min, max] = self.bits();
        (0..3).all(|axis| {
            let ends = [min[axis], max[axis]];
            let are_finite = ends.map(|end| size(end) < size(f32::INFINITY.to_bits()));
            are_finite[0] & are_finite[1] & (rank(ends[0]) <= rank(ends[1]))
        })
    }

    /// Checks that a box is valid; `body` is its number in the error.
    pub(crate) fn check(&self, body: usize) -> Result<(), ContractError> {
        let is_sound = |axis: usize| {
            let [lo, hi] = [self.min[axis], self.max[axis]];
            lo <= hi && f32::MIN <= lo && hi <= f32::MAX
        };
        if self.is_surely_sound() || in_default_mode(|| (0..3).all(is_sound)) {
            return Ok(());
        }
        let value = format!("from {:?} to {:?}", self.min, self.max);
        let hint = "ends are finite, and `min` is at most `max` on each axis";
        refuse(body, "box", value, hint)
    }
}
