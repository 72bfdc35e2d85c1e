//! Cubes around and inside boxes: a pair finder uses them instead of the boxes, and they decide
//! most pairs without the boxes' ends.
//!
//! A box has the centre c, the half side H of the cube about c that contains it, and the half side
//! h of the one about c that it contains. Let δ be at least every H − h, and d the Chebyshev
//! distance of two centres. If d > H₁ + H₂, the boxes are apart; if d ≤ H₁ + H₂ − 2δ ≤ h₁ + h₂,
//! they meet. Otherwise their ends decide, which needs no arithmetic.
//!
//! All numbers are scaled by an eighth, an exact factor, so that no difference or sum of ends
//! overflows. Each result has at most five roundings, each of 2⁻²⁴ of H₁ + H₂, and of 2⁻¹²⁶ where
//! results underflow, with or without denormals. The factors leave 2⁻²⁰ for them, and the floor
//! 10⁻³⁰. Differences are computed after the factors, so that cancellation does not increase the
//! relative error.

use crate::simd::Lanes;

/// The factor by which a cube is wider than its box.
pub const WIDER: f32 = 1.0 + 1.0 / (1 << 20) as f32;

/// The factor by which boxes must be nearer than touching inner cubes, to meet for certain.
pub const NARROWER: f32 = 1.0 - 1.0 / (1 << 20) as f32;

/// What is added to cubes for boxes without an extent.
pub const FLOOR: f32 = 1e-30;

/// The factor by which boxes are larger than the scaled cubes.
pub const SCALE: f32 = 8.0;

/// The weight of each end in the scaled centre.
const SIXTEENTH: f32 = 0.5 / SCALE;

/// The cubes of boxes, one box per lane.
#[derive(Clone, Copy)]
pub struct Cube<L: Lanes> {
    /// The cube about it: centre and half side H.
    pub outer: [L::F; 4],
    /// H − h.
    pub gap: L::F,
    /// Bits of the lanes in which all ends are finite, and no lower one is above the upper one.
    pub sound: u32,
}

impl<L: Lanes> Cube<L> {
    /// The cubes of the boxes between these ends, which are given axis by axis.
    #[inline(always)]
    #[must_use]
    pub fn about(l: L, lower: [L::F; 3], upper: [L::F; 3]) -> Self {
        let (sixteenth, infinity) = (l.splat(SIXTEENTH), l.splat(f32::INFINITY));
        let (mut widest, mut narrowest) = (l.splat(0.0), infinity);
        let mut outer = [l.splat(0.0); 4];
        let mut sound = l.bits(l.first(L::WIDTH));
        for axis in 0..3 {
            let swapped = l.gt(lower[axis], upper[axis]);
            let (lo, hi) = (lower[axis] * sixteenth, upper[axis] * sixteenth);
            let centre = lo + hi;
            let (below, above) = (centre - (lo + lo), (hi + hi) - centre);
            widest = l.max(widest, l.max(below, above));
            narrowest = l.min(narrowest, l.min(below, above));
            outer[axis] = centre;
            // The difference of infinite ends is infinite or no number.
            sound &= l.bits(l.gt(infinity, hi - lo)) & !l.bits(swapped);
        }
        outer[3] = widest * l.splat(WIDER) + l.splat(FLOOR);
        Self { outer, gap: outer[3] - narrowest, sound }
    }
}

/// Whether two centres are farther apart than `distance` along some axis: d > distance, rounded
/// nowhere but in `between`.
#[inline(always)]
pub fn apart<L: Lanes>(l: L, [x, y, z]: [L::F; 3], distance: L::F) -> L::M {
    l.gt(l.max(l.max(l.abs(x), l.abs(y)), l.abs(z)), distance)
}

/// By how much two boxes must be nearer than their cubes, to meet for sure, where no H − h is
/// greater than `gap`: 2δ and more.
#[must_use]
pub fn less_than_sure(gap: f32) -> f32 {
    2.0 * gap * WIDER + 2.0 * FLOOR
}

/// The distance up to which two boxes surely meet, of a reach H₁ + H₂.
#[inline(always)]
pub fn sure<L: Lanes>(l: L, reach: L::F, less: f32) -> L::F {
    reach * l.splat(NARROWER) - l.splat(less)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::{Kernel, MAX_WIDTH, Tier, dispatch};
    use proptest::prelude::*;

    type Slabs = [[f32; 2]; 3];

    /// Boxes within a few units, whose sides may differ and be nothing; lengths that don't round
    /// and lengths that do.
    fn slabs() -> impl Strategy<Value = Slabs> {
        let end = prop_oneof![
            (0_i8..9).prop_map(f32::from),
            0.0_f32..9.0,
            (0_u32..64).prop_map(f32::from_bits),
            Just(f32::MAX),
            Just(f32::MIN),
        ];
        let offset = prop_oneof![Just(0.0_f32), Just(1e4), Just(-3e6)];
        let slab = [end.clone(), end];
        ([slab.clone(), slab.clone(), slab], offset).prop_map(|(ends, offset)| {
            ends.map(|[a, b]| {
                [a.min(b), a.max(b)].map(|end| (end + offset).clamp(f32::MIN, f32::MAX))
            })
        })
    }

    /// A box's cube (centre and half side), its gap, and whether the box is sound.
    struct MakeCube<'a>(&'a Slabs);

    impl Kernel for MakeCube<'_> {
        type Output = ([f32; 4], f32, bool);
        #[inline(always)]
        fn run<L: Lanes>(self, l: L) -> Self::Output {
            let [lower, upper] = [0, 1].map(|end| self.0.map(|slab| l.splat(slab[end])));
            let cube = Cube::about(l, lower, upper);
            let number = |lanes| {
                let mut numbers = [0.0; MAX_WIDTH];
                l.store(lanes, &mut numbers);
                numbers[0]
            };
            let sound = cube.sound == l.bits(l.first(L::WIDTH));
            (cube.outer.map(number), number(cube.gap), sound)
        }
    }

    fn is_sound(slabs: &Slabs) -> bool {
        Tier::available().into_iter().all(|tier| dispatch(tier, MakeCube(slabs)).2)
    }

    fn meet(a: &Slabs, b: &Slabs) -> bool {
        (0..3).all(|axis| a[axis][0] <= b[axis][1] && b[axis][0] <= a[axis][1])
    }

    /// What the cubes of two boxes say: whether the boxes meet, if they know.
    struct CompareCubes<'a>(&'a Slabs, &'a Slabs);

    impl Kernel for CompareCubes<'_> {
        type Output = Option<bool>;
        #[inline(always)]
        fn run<L: Lanes>(self, l: L) -> Option<bool> {
            let [(one, gap, _), (other, other_gap, _)] =
                [MakeCube(self.0).run(l), MakeCube(self.1).run(l)];
            let less = less_than_sure(gap.max(other_gap));
            let between = [0, 1, 2].map(|axis| l.splat(one[axis]) - l.splat(other[axis]));
            let reach = l.splat(one[3]) + l.splat(other[3]);
            let beyond = |distance| l.bits(apart(l, between, distance)) & 1 == 1;
            match (beyond(reach), beyond(sure(l, reach, less))) {
                (true, _) => Some(false),
                (false, true) => None,
                (false, false) => Some(true),
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]
        #[test]
        fn cubes_answer_as_their_boxes_do(a in slabs(), b in slabs()) {
            prop_assert!(is_sound(&a) && is_sound(&b));
            for tier in [Tier::detect(), Tier::SCALAR] {
                if let Some(answer) = dispatch(tier, CompareCubes(&a, &b)) {
                    prop_assert_eq!(answer, meet(&a, &b));
                }
            }
        }

        /// The nearest ends that an f32 can tell apart, and those that touch: inner cubes thin
        /// next to the outer ones.
        #[test]
        fn thin_neighbouring_boxes_are_apart(
            thin in -30_i32..2, offset in -8.0_f32..8.0, steps in -3_i32..4, axis in 0_usize..3,
        ) {
            let width = 2.0_f32.powi(thin);
            let mut a = [[-1.0, 1.0]; 3];
            a[axis] = [offset, offset + width];
            let mut b = a;
            let beside = (0..steps.abs()).fold(a[axis][1], |x, _| if steps < 0 { x.next_down() } else { x.next_up() });
            b[axis] = [beside, beside + width];
            if let Some(answer) = dispatch(Tier::detect(), CompareCubes(&a, &b)) {
                prop_assert_eq!(answer, meet(&a, &b));
            }
        }
    }

    #[test]
    fn cubes_of_balls_know_nearly_always() {
        let at = |x: f32| [[x - 1.0, x + 1.0], [-1.0, 1.0], [300.0, 302.0]];
        let knows = |x: f32| dispatch(Tier::detect(), CompareCubes(&at(0.1), &at(x)));
        assert_eq!(knows(2.099), Some(true));
        assert_eq!(knows(2.101), Some(false));
    }

    #[test]
    fn boxes_that_are_none_are_told() {
        let with = |axis: usize, slab: [f32; 2]| {
            let mut slabs = [[0.0, 1.0]; 3];
            slabs[axis] = slab;
            slabs
        };
        let (nan, inf) = (f32::NAN, f32::INFINITY);
        let one = f32::from_bits(1);
        for axis in 0..3 {
            for bad in [
                [nan, 1.0],
                [0.0, nan],
                [nan, nan],
                [1.0, 0.0],
                [one, 0.0],
                [0.0, -one],
                [inf, inf],
                [-inf, -inf],
                [-inf, inf],
                [0.0, inf],
                [-inf, 0.0],
                [inf, -inf],
            ] {
                let told = |tier| !dispatch(tier, MakeCube(&with(axis, bad))).2;
                assert!(Tier::available().into_iter().all(told), "{bad:?}");
            }
            for good in [
                [0.0, 0.0],
                [0.0, -0.0],
                [-one, one],
                [f32::MIN, f32::MAX],
                [f32::MAX; 2],
                [f32::MIN; 2],
            ] {
                assert!(is_sound(&with(axis, good)), "{good:?}");
            }
        }
    }

    /// What is too wide loses nothing, and has the boxes themselves looked at for no reason.
    #[test]
    fn cubes_are_as_tight_as_possible() {
        let within = |found: f32, exact: f64| {
            let found = f64::from(found);
            assert!(exact <= found && found <= exact * (1.0 + 4e-6), "{found} of {exact}");
        };
        let about = MakeCube(&[[1.0, 3.0], [-8.0, 0.0], [40.0, 44.0]]);
        let (outer, gap, _) = dispatch(Tier::SCALAR, about);
        assert_eq!(outer[..3], [0.25, -0.5, 5.25]);
        within(outer[3], 0.5);
        within(gap, 0.375);
        within(less_than_sure(4.0), 8.0);
        within(less_than_sure(0.0), 2e-30_f32.into());
    }

    /// A box without an extent has a cube with one.
    #[test]
    fn empty_box_has_a_cube() {
        let about = MakeCube(&[[1.0; 2], [-8.0; 2], [40.0; 2]]);
        let found = dispatch(Tier::SCALAR, about);
        assert_eq!(found, ([0.125, -1.0, 5.0, FLOOR], FLOOR, true));
    }
}
