//! Sizes of boxes and of cells: boxes of similar size share a level, whose cells are twice as wide
//! as the widest of them.
//!
//! A box is in the cell of its lower corner. Let b be a level's bound, no less than any side of its
//! boxes, and q a box. A box t of the level that meets q has q.min − b ≤ t.min ≤ q.max on each
//! axis. The cell of a coordinate x is fl(x·w), rounded to the nearest whole number, which never
//! decreases as x grows. Therefore t is in a cell between that of q.min − b, rounded down, and that
//! of q.max. Rounding adds at most one cell to that range.

use crate::bodies::Aabb;

/// The number of boxes that are drawn to estimate quantiles of sizes.
const SAMPLE_SIZE: usize = 256;
const USUAL_RANK: usize = 192;

/// Boxes of one size differ by the rounding of their ends.
const UNIT_SLACK: f64 = 1.0 + 1.0 / (1 << 10) as f64;

/// Number of bits of a fraction.
const MANTISSA_BITS: u32 = f64::MANTISSA_DIGITS - 1;

/// Boxes of similar size.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoxLevel {
    /// The number of its size: see [`size_number`].
    number: i32,
    /// The largest side of its boxes is at most this.
    bound: f64,
    /// Cells per unit of length.
    cells_per_unit: f64,
    /// Number of its boxes.
    pub boxes: usize,
}

/// The first and the last cell along each axis.
pub(super) type CellRange = [[u64; 2]; 3];

/// Cells further from the origin share a number.
const LAST_CELL: f64 = (1_u64 << 50) as f64;
/// The sum with a number up to [`LAST_CELL`] has no fraction, and its bits count whole numbers.
const WHOLE: f64 = (3_u64 << 51) as f64;

impl BoxLevel {
    /// An empty level for boxes up to a size, in units of `unit`.
    fn new(number: i32, unit: f64) -> Self {
        let bound = (unit * size_of_number(number)).next_up();
        Self { number, bound, cells_per_unit: 0.5 / bound, boxes: 0 }
    }

    /// Whether a box belongs here rather than to smaller or larger boxes. Levels overlap, so one
    /// that changes its size a little stays where it is.
    #[inline(always)]
    pub fn suits(&self, aabb: &Aabb) -> bool {
        // If the longest side, rounded once, is less than the bound, the exact one is no more.
        let side = longest_rounded(aabb);
        side < self.bound && 2.0 * side >= self.bound
    }

    #[inline(always)]
    fn cell(&self, x: f64) -> u64 {
        ((x * self.cells_per_unit).clamp(-LAST_CELL, LAST_CELL) + WHOLE).to_bits()
    }

    /// The place of the cell of a box of this level.
    #[inline]
    pub fn home(&self, aabb: &Aabb) -> u32 {
        self.place(aabb.min.map(|x| self.cell(f64::from(x))))
    }

    /// The cells that contain all boxes of this level that meet this one.
    #[inline(always)]
    pub fn cells_near(&self, aabb: &Aabb) -> CellRange {
        std::array::from_fn(|axis| {
            // By a unit of the last place less, or exact where it is zero.
            let from = f64::from(aabb.min[axis]) - self.bound;
            let from = from - f64::EPSILON * from.abs();
            [self.cell(from), self.cell(f64::from(aabb.max[axis]))]
        })
    }

    /// Calls `take` with the place of the first cell of each row of a range along x, and the number
    /// of its cells.
    #[inline(always)]
    pub fn each_row(&self, range: &CellRange, mut take: impl FnMut(u32, usize)) {
        let [[x, last], y, z] = *range;
        for z in z[0]..=z[1] {
            for y in y[0]..=y[1] {
                take(self.place([x, y, z]), (last - x) as usize + 1);
            }
        }
    }

    /// A place that few other cells have: that of the row, which y and z are mixed to, and from
    /// there on one after the other. Places wrap around at 2³².
    #[inline(always)]
    pub fn place(&self, [x, y, z]: [u64; 3]) -> u32 {
        const FACTORS: [u64; 2] = [0xc2b2_ae3d_27d4_eb4f, 0x1656_67b1_9e37_79f9];
        let start = (self.number as u64).wrapping_mul(0xff51_afd7_ed55_8ccd);
        let mixed = ([y, z].iter().zip(FACTORS))
            .fold(start, |sum, (&x, factor)| sum.wrapping_add(x.wrapping_mul(factor)));
        let mixed = (mixed ^ mixed >> 32).wrapping_mul(0xd6e8_feb8_6659_fd93);
        ((mixed >> 32) as u32).wrapping_add(x as u32)
    }
}

/// The number of cells in a range.
pub(super) fn cell_count(range: &CellRange) -> u64 {
    let [x, y, z] = range.map(|[first, last]| last - first + 1);
    x.saturating_mul(y).saturating_mul(z)
}

/// The levels of a set of boxes.
#[derive(Clone, Debug)]
pub(super) struct Levels {
    /// The unit of sizes: slightly above the usual size, so that cells fit it best.
    unit: f64,
    /// The number of the lowest level, which also has all smaller boxes.
    least: i32,
    pub all: Vec<BoxLevel>,
}

impl Levels {
    /// Chooses levels for these boxes: no level has cells much smaller than the mean distance of
    /// boxes, unless most boxes are smaller.
    pub fn suited_to(boxes: impl Iterator<Item = Aabb>, count: usize) -> Self {
        let step = count.div_ceil(SAMPLE_SIZE).max(1);
        let (mut lower, mut upper) = ([f64::MAX; 3], [f64::MIN; 3]);
        let mut sides: Vec<f64> = Vec::new();
        for (number, aabb) in boxes.enumerate() {
            for axis in 0..3 {
                lower[axis] = lower[axis].min(f64::from(aabb.min[axis]));
                upper[axis] = upper[axis].max(f64::from(aabb.max[axis]));
            }
            if number % step == 0 {
                sides.push(longest_side(&aabb));
            }
        }
        sides.sort_by(f64::total_cmp);
        let usual = sides.get(sides.len() * USUAL_RANK / SAMPLE_SIZE).copied();
        let usual = usual.unwrap_or(1.0);
        let space = (0..3).map(|axis| (upper[axis] - lower[axis]).max(usual));
        let distance = (space.product::<f64>() / count.max(1) as f64).cbrt();
        let tiniest = f64::from(f32::from_bits(1));
        let (least, unit) = if usual > f64::from(f32::MIN_POSITIVE) {
            (usual.min(0.5 * distance), usual * UNIT_SLACK)
        } else {
            let least = (0.5 * distance).max(tiniest);
            (least, least)
        };
        Self { unit, least: size_number(least.max(tiniest) / unit), all: Vec::new() }
    }

    /// The index of the level of a box.
    #[inline]
    pub fn level_of(&mut self, aabb: &Aabb) -> u16 {
        let number = size_number((longest_side(aabb) / self.unit).next_up()).max(self.least);
        let found = self.all.iter().position(|level| level.number == number);
        let index = found.unwrap_or_else(|| {
            self.all.push(BoxLevel::new(number, self.unit));
            self.all.len() - 1
        });
        // Sizes in f32 have about 600 numbers.
        index as u16
    }
}

/// An upper bound of the longest side.
fn longest_side(aabb: &Aabb) -> f64 {
    longest_rounded(aabb).next_up()
}

/// The longest side, rounded to the nearest number.
#[inline(always)]
fn longest_rounded(aabb: &Aabb) -> f64 {
    let side = |axis: usize| f64::from(aabb.max[axis]) - f64::from(aabb.min[axis]);
    let longer = |a: f64, b: f64| if b > a { b } else { a };
    longer(longer(side(0), side(1)), side(2))
}

/// Sizes 1, 1.5, 2, 3, 4, 6 … have the numbers 0, 1, 2 …; a size in between has the number of the
/// next larger one.
fn size_number(size: f64) -> i32 {
    let bits = size.to_bits();
    let exponent = (bits >> MANTISSA_BITS) as i32 - (f64::MAX_EXP - 1);
    let mantissa = bits & ((1 << MANTISSA_BITS) - 1);
    let half = 1 << (MANTISSA_BITS - 1);
    2 * exponent + i32::from(mantissa > 0) + i32::from(mantissa > half)
}

fn size_of_number(number: i32) -> f64 {
    let exponent = (number >> 1) + (f64::MAX_EXP - 1);
    let power = f64::from_bits((exponent as u64) << MANTISSA_BITS);
    if number & 1 == 1 { 1.5 * power } else { power }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn numbers_of_sizes_round_up() {
        for (size, number) in [(1.0, 0), (1.5, 1), (2.0, 2), (3.0, 3), (0.75, -1), (0.5, -2)] {
            assert_eq!((size_number(size), size_of_number(number)), (number, size));
            assert_eq!(size_number(size.next_up()), number + 1);
            assert_eq!(size_number(size.next_down()), number);
        }
    }

    fn end() -> impl Strategy<Value = f32> {
        prop_oneof![
            -8_i8..8, // shares ends with others
        ]
        .prop_map(f32::from)
        .boxed()
        .prop_union((-9.0_f32..9.0).boxed())
        .or((0_u32..40).prop_map(f32::from_bits).boxed())
        .or(any::<f32>().prop_filter("finite", |x| x.is_finite()).boxed())
    }

    fn aabb() -> impl Strategy<Value = Aabb> {
        prop::array::uniform3([end(), end()]).prop_map(|ends| {
            let lower = ends.map(|[a, b]| a.min(b));
            Aabb::new(lower, ends.map(|[a, b]| a.max(b)))
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]
        /// The argument of the module's head: a box that meets is in one of the searched cells.
        #[test]
        fn meeting_boxes_are_in_near_cells(one in aabb(), other in aabb(), least in 1e-30_f32..9.0) {
            let sized = Aabb::new([0.0; 3], [least; 3]);
            let mut levels = Levels::suited_to([sized].into_iter(), 1);
            let index = levels.level_of(&other);
            let level = levels.all[usize::from(index)];
            let home = other.min.map(|x| level.cell(f64::from(x)));
            prop_assert_eq!(level.home(&other), level.place(home));
            let near = level.cells_near(&one);
            let is_near = (0..3).all(|axis| (near[axis][0]..=near[axis][1]).contains(&home[axis]));
            prop_assert!(is_near || !one.meets(&other));
        }
    }

    /// A box of the same size looks into eight cells.
    #[test]
    fn equal_sizes_search_eight_cells() {
        let cube = |x: f32, side: f32| Aabb::new([x; 3], [x + side; 3]);
        let boxes = [cube(0.0, 1.0), cube(5.0, 1.0), cube(9.0, 1.0)];
        let mut levels = Levels::suited_to(boxes.into_iter(), 3);
        for side in [0.25_f32, 0.8, 1.0, 1.2, 1.5, 3.0, 40.0] {
            for x in 0..50 {
                let aabb = cube(0.37 * x as f32, side);
                let index = levels.level_of(&aabb);
                let near = levels.all[usize::from(index)].cells_near(&aabb);
                assert!(cell_count(&near) <= 27, "{side}: {near:?}");
            }
        }
        assert!(levels.all.len() <= 7);
    }
}
