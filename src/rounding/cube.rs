//! Cubes about boxes and within them: what a pair finder takes in place of a box, and what spares a look at the box itself.
//!
//! A box has the centre c, the half side H of the cube about c that contains it, and the half side h of the one about c that
//! it contains. With δ no less than any H − h, and the Chebyshev distance d of two centres: d > H₁ + H₂ is apart, and
//! d ≤ H₁ + H₂ − 2δ ≤ h₁ + h₂ meets. What lies between is decided by the boxes' ends, which needs no arithmetic.
//!
//! All of it is an eighth in size, an exact factor, so that no difference or sum of ends overflows. Each outcome is at most
//! five roundings from what it stands for, each of 2⁻²⁴ of H₁ + H₂, and of 2⁻¹²⁶ where results underflow, with denormals or
//! without; the factors leave 2⁻²⁰ for them, the floor 10⁻³⁰. The differences are taken after the factors, so that nothing
//! that cancels makes the roundings a larger share.

use glam::{BVec4A, Vec4, Vec4Swizzles as _};

use crate::simd::Lanes;

/// What a cube is wider than its box.
pub const WIDER: f32 = 1.0 + 1.0 / (1 << 20) as f32;

/// What surely meets is nearer than inner cubes that touch.
pub const NARROWER: f32 = 1.0 - 1.0 / (1 << 20) as f32;

/// The same for boxes without an extent.
pub const FLOOR: f32 = 1e-30;

/// An eighth of this of each end makes the centre.
const SIXTEENTH: f32 = 0.0625;

/// What stands for a box.
#[derive(Clone, Copy, Debug)]
pub struct Cube {
    /// The cube about it: centre and half side H.
    pub outer: [f32; 4],
    /// H − h.
    pub gap: f32,
    /// Axis by axis, the last one twice, whether both ends are finite, and the lower one not above the upper one.
    pub is_sound: BVec4A,
}

impl Cube {
    /// Of the box between two corners.
    #[inline(always)]
    #[must_use]
    pub fn about(min: &[f32; 3], max: &[f32; 3]) -> Self {
        // Four numbers that follow one another in a box are one load.
        let lo = Vec4::new(min[0], min[1], min[2], max[0]).xyzz();
        let hi = Vec4::new(min[2], max[0], max[1], max[2]).yzww();
        let in_order = lo.cmple(hi);
        let [lo, hi] = [lo, hi].map(|ends| ends * SIXTEENTH);
        let centre = lo + hi;
        let (below, above) = (centre - (lo + lo), (hi + hi) - centre);
        let outer = below.max(above).max_element() * WIDER + FLOOR;
        let inner = below.min(above).min_element();
        // The difference of infinite ends is infinite or no number.
        let is_finite = (hi - lo).cmplt(Vec4::INFINITY);
        Self {
            outer: [centre.x, centre.y, centre.z, outer],
            gap: outer - inner,
            is_sound: in_order & is_finite,
        }
    }
}

/// By how much two boxes must be nearer than their cubes, to meet for sure, where no H − h is greater than `gap`: 2δ and more.
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
    use crate::simd::{Kernel, Tier, dispatch};
    use proptest::prelude::*;

    type Slabs = [[f32; 2]; 3];

    /// Boxes within a few units, whose sides may differ and be nothing; lengths that don't round and lengths that do.
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

    fn cube(slabs: &Slabs) -> Cube {
        Cube::about(&slabs.map(|[lo, _]| lo), &slabs.map(|[_, hi]| hi))
    }

    fn meet(a: &Slabs, b: &Slabs) -> bool {
        (0..3).all(|axis| a[axis][0] <= b[axis][1] && b[axis][0] <= a[axis][1])
    }

    /// What the cubes of two boxes say: whether the boxes meet, if they know.
    struct Say<'a>(&'a Slabs, &'a Slabs);

    impl Kernel for Say<'_> {
        type Output = Option<bool>;
        #[inline(always)]
        fn run<L: Lanes>(self, l: L) -> Option<bool> {
            let (one, other) = (cube(self.0), cube(self.1));
            let less = less_than_sure(one.gap.max(other.gap));
            let far = (0..3).map(|axis| (one.outer[axis] - other.outer[axis]).abs());
            let far = l.splat(far.fold(0.0, f32::max));
            let reach = l.splat(one.outer[3]) + l.splat(other.outer[3]);
            let beyond = |distance| l.bits(l.gt(far, distance)) & 1 == 1;
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
            prop_assert!((cube(&a).is_sound & cube(&b).is_sound).all());
            for tier in [Tier::detect(), Tier::SCALAR] {
                if let Some(answer) = dispatch(tier, Say(&a, &b)) {
                    prop_assert_eq!(answer, meet(&a, &b));
                }
            }
        }

        /// The nearest ends that an f32 can tell apart, and those that touch: inner cubes thin beside the outer ones.
        #[test]
        fn thin_boxes_side_by_side_are_told_apart(
            thin in -30_i32..2, offset in -8.0_f32..8.0, steps in -3_i32..4, axis in 0_usize..3,
        ) {
            let width = 2.0_f32.powi(thin);
            let mut a = [[-1.0, 1.0]; 3];
            a[axis] = [offset, offset + width];
            let mut b = a;
            let beside = (0..steps.abs()).fold(a[axis][1], |x, _| if steps < 0 { x.next_down() } else { x.next_up() });
            b[axis] = [beside, beside + width];
            if let Some(answer) = dispatch(Tier::detect(), Say(&a, &b)) {
                prop_assert_eq!(answer, meet(&a, &b));
            }
        }
    }

    #[test]
    fn cubes_of_balls_know_nearly_always() {
        let at = |x: f32| [[x - 1.0, x + 1.0], [-1.0, 1.0], [300.0, 302.0]];
        let knows = |x: f32| dispatch(Tier::detect(), Say(&at(0.1), &at(x)));
        assert_eq!(knows(2.099), Some(true));
        assert_eq!(knows(2.101), Some(false));
    }

    #[test]
    fn boxes_that_are_none_are_told() {
        let is_sound = |axis: usize, slab: [f32; 2]| {
            let mut slabs = [[0.0, 1.0]; 3];
            slabs[axis] = slab;
            cube(&slabs).is_sound.all()
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
                assert!(!is_sound(axis, bad), "{bad:?}");
            }
            for good in [
                [0.0, 0.0],
                [0.0, -0.0],
                [-one, one],
                [f32::MIN, f32::MAX],
                [f32::MAX; 2],
                [f32::MIN; 2],
            ] {
                assert!(is_sound(axis, good), "{good:?}");
            }
        }
    }
}
