//! World-aligned boxes, the type that engines pass to [`BoxCuller`](crate::BoxCuller) and
//! [`BoxWorld`](crate::BoxWorld).

use super::contract::{ContractError, refuse};
use crate::rounding::{ceil_f32, down, floor_f32, up};
use crate::simd::{boxes_of, in_default_mode};

pub use crate::simd::Aabb;

impl Aabb {
    /// The box between two corners.
    #[must_use]
    pub fn new(min: impl Into<[f32; 3]>, max: impl Into<[f32; 3]>) -> Self {
        let (min, max) = (min.into(), max.into());
        Self { min, max }
    }

    /// The smallest f32 box that contains an f64 box: the lower ends are rounded down and the upper
    /// ones up. No pair of f64 boxes is missed that way; boxes that are less than that apart may be
    /// reported. Ends in the wrong order, NaN, or beyond f32 stay invalid.
    #[must_use]
    pub fn outward(min: impl Into<[f64; 3]>, max: impl Into<[f64; 3]>) -> Self {
        let (min, max) = (min.into(), max.into());
        in_default_mode(|| {
            let is_valid = |axis: usize| min[axis] <= max[axis];
            let [down, up] = [floor_f32, ceil_f32];
            Self {
                min: [0, 1, 2].map(|i| if is_valid(i) { down(min[i]) } else { up(min[i]) }),
                max: [0, 1, 2].map(|i| if is_valid(i) { up(max[i]) } else { down(max[i]) }),
            }
        })
    }

    /// This box grown on every side by a margin, a length ≥ 0, and rounded outward: boxes that are
    /// on each axis at most the sum of their margins apart meet when each is grown by its own.
    /// Without a margin it stays the same; an invalid box or margin gives an invalid box.
    #[must_use]
    pub fn grown(self, margin: f32) -> Self {
        in_default_mode(|| {
            if margin == 0.0 {
                return self;
            }
            let is_valid = margin > 0.0 && (0..3).all(|axis| self.min[axis] <= self.max[axis]);
            let margin = if is_valid { f64::from(margin) } else { f64::NAN };
            let min = self.min.map(|x| down(f64::from(x) - margin));
            Self { min, max: self.max.map(|x| up(f64::from(x) + margin)) }
        })
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

    /// Whether the other box lies in this one.
    #[inline(always)]
    pub(crate) fn contains(&self, other: &Self) -> bool {
        let on =
            |axis: usize| (self.min[axis] <= other.min[axis]) & (other.max[axis] <= self.max[axis]);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rounding::exp2;

    /// The ends are the nearest f32 on the outer side, and themselves if f32 holds them.
    #[test]
    fn outward_boxes_are_the_smallest() {
        let given = Aabb::new([-1.5, 0.0, f32::MIN], [1.5, -0.0, f32::MAX]);
        assert_eq!(Aabb::outward(given.min.map(f64::from), given.max.map(f64::from)), given);
        for x in [0.1, 1.0 + exp2(-40), exp2(-160), 1.0e30, -0.1, -exp2(-140) - exp2(-160)] {
            let Aabb { min, max } = Aabb::outward([x; 3], [x; 3]);
            assert!(f64::from(min[0]) < x && x < f64::from(max[2]), "{x:e}");
            assert_eq!((min, max), (min, [min[0].next_up(); 3]), "{x:e}");
        }
    }

    /// Grown boxes contain what they should, however small the margin; without one nothing changes.
    #[test]
    fn grown_boxes_contain_their_margin() {
        let given = Aabb::new([-1.5, 0.0, 7.0e30], [1.5, 0.0, 7.5e30]);
        assert_eq!(given.grown(0.0), given);
        for margin in [f32::from_bits(1), 1.0e-20, 0.1, 3.0e38] {
            let grown = given.grown(margin);
            for axis in 0..3 {
                let [lo, hi] = [given.min[axis], given.max[axis]].map(f64::from);
                assert!(f64::from(grown.min[axis]) < lo && hi < f64::from(grown.max[axis]));
                assert!(f64::from(grown.min[axis]) <= lo - f64::from(margin), "{margin:e}");
            }
        }
    }

    /// Rounding mends no invalid box, and neither does a margin.
    #[test]
    fn invalid_boxes_stay_invalid() {
        let unit = Aabb::new([0.0; 3], [1.0; 3]);
        let inverted = Aabb::new([2.0, 0.0, 0.0], [1.0; 3]);
        for invalid in
            [unit.grown(-1.0), unit.grown(f32::NAN), inverted.grown(3.0), unit.grown(f32::INFINITY)]
        {
            assert!(invalid.check(0).is_err(), "{invalid:?}");
        }
        let above = 1.0 + exp2(-40);
        for (lo, hi) in [(above, 1.0), (-1.0, -above), (f64::NAN, 1.0), (0.0, 1.0e39), (0.2, 0.1)] {
            let outward = Aabb::outward([0.0, lo, 0.0], [1.0, hi, 1.0]);
            assert!(outward.check(0).is_err(), "{lo} to {hi}: {outward:?}");
        }
    }
}
