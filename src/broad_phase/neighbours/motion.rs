//! How far balls have drifted by the end of a list, and how large they are. The next skin is chosen
//! from these. They affect how long lists last, never which pairs are reported.

use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use super::drift::{BALLS_PER_TASK, padded};
use crate::broad_phase::BLOCK_BODIES;
use crate::rounding::skin::{REACH_FLOOR, SKIN_FLOOR};
use crate::simd::{Kernel, Lanes, dispatch, quads_in_columns};
use crate::threads::Executor;

/// The most balls whose radii are sampled.
const SAMPLE_SIZE: usize = 256;

/// The largest ratio of the typical radius to the smallest half side.
const MOST_SIZE_RATIO: f64 = 16.0;

/// 2⁻⁶⁰: smaller radii count as this one, whose square is not subnormal.
const LEAST_RADIUS: f32 = SKIN_FLOOR as f32;

/// The largest drift of any ball: the root of the squares of the centre's movement and the radius'
/// growth.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LargestDrift {
    /// The drift in the ball's own radii.
    pub own: f64,
    /// The drift in typical radii.
    pub typical: f64,
}

impl LargestDrift {
    /// The largest drift of balls since `then`.
    pub fn of(executor: Executor<'_>, now: &[[f32; 4]], then: &[[f32; 4]], typical: f64) -> Self {
        // The bits of non-negative numbers are ordered as the numbers are.
        let farthest = [const { AtomicU32::new(0) }; 2];
        executor.pool.ranges(now.len(), BALLS_PER_TASK, |range| {
            let (now, then) = (&now[range.clone()], &then[range]);
            let found = dispatch(executor.tier, FindFarthest { now, then });
            for (farthest, found) in farthest.iter().zip(found) {
                farthest.fetch_max(found.to_bits(), Relaxed);
            }
        });
        let [own, length] =
            farthest.map(|square| f64::from(f32::from_bits(square.into_inner())).sqrt());
        Self { own, typical: length / typical }
    }
}

/// The typical radius r: a skin of σr for all bodies adds about as large a fraction of pairs to
/// their list as a skin of σ radii adds to a list of equal balls. The number of pairs is
/// proportional to Πₖ(hᵢₖ + hⱼₖ), the product of the sums of half sides over the axes k, and its
/// growth by a length to products of two such sums: r = 3ΣΠₖ(hᵢₖ + hⱼₖ) / 2ΣΣₖΠₗ(hᵢₗ + hⱼₗ), l ≠ k,
/// which for balls is Σ(rᵢ + rⱼ)³ / 2Σ(rᵢ + rⱼ)².
///
/// It is zero, so that no skin is measured in it, if it is more than [`MOST_SIZE_RATIO`] times the
/// longest half side of the smallest body: a skin of a giant's size would make all small bodies
/// neighbours.
pub fn typical_radius(bodies: usize, half_sides: impl Fn(usize) -> [f32; 3]) -> f64 {
    let (mut sums, mut asked, mut smallest) = ([0.0; 7], 0.0, f64::INFINITY);
    for body in (0..bodies).step_by(bodies.div_ceil(SAMPLE_SIZE).max(1)) {
        let [x, y, z] = half_sides(body).map(|half| f64::from(half.max(LEAST_RADIUS)));
        for (sum, product) in sums.iter_mut().zip([x, y, z, y * z, z * x, x * y, x * y * z]) {
            *sum += product;
        }
        (asked, smallest) = (asked + 1.0, smallest.min(x.max(y).max(z)));
    }
    let [x, y, z, yz, zx, xy, xyz] = sums.map(|sum| sum / f64::max(asked, 1.0));
    // Means over all pairs, as products of means over bodies.
    let product = 2.0 * (xyz + x * yz + y * zx + z * xy);
    let of_two = 2.0 * ((yz + y * z) + (zx + z * x) + (xy + x * y));
    let typical = 3.0 * product / (2.0 * of_two);
    if typical > MOST_SIZE_RATIO * smallest { 0.0 } else { typical }
}

/// Whether most balls are smaller than the floor of the skin and of its rounding margin. A list's
/// pairs would then be unrelated to the bodies' sizes.
pub fn are_specks(radii: impl ExactSizeIterator<Item = f32>) -> bool {
    let step = radii.len().div_ceil(SAMPLE_SIZE).max(1);
    let (mut specks, mut asked) = (0, 0);
    for radius in radii.step_by(step) {
        specks += usize::from(f64::from(radius) < REACH_FLOOR);
        asked += 1;
    }
    2 * specks > asked
}

/// The sizes of the bodies from which lists are built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizeSummary {
    /// The typical radius; that of boxes if boxes are listed.
    pub typical: f64,
    /// The typical radius in units of that of the grid's balls: 1 except for boxes that are longer
    /// than wide.
    pub of_balls: f64,
}

impl SizeSummary {
    /// The sizes of boxes, or of balls if those are listed.
    pub fn new(typical: f64, of_balls: f64) -> Self {
        let of_balls = if typical > 0.0 && of_balls > typical { typical / of_balls } else { 1.0 };
        Self { typical, of_balls }
    }
}

struct FindFarthest<'a> {
    now: &'a [[f32; 4]],
    then: &'a [[f32; 4]],
}

impl Kernel for FindFarthest<'_> {
    /// Squared drifts, in own radii and as lengths.
    type Output = [f32; 2];
    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> [f32; 2] {
        let mut farthest = [[0.0; BLOCK_BODIES]; 2];
        let (now, now_rest) = self.now.as_chunks::<BLOCK_BODIES>();
        let (then, then_rest) = self.then.as_chunks::<BLOCK_BODIES>();
        for (now, then) in now.iter().zip(then) {
            raise(l, &mut farthest, now, then);
        }
        raise(l, &mut farthest, &padded(now_rest), &padded(then_rest));
        farthest.map(|lanes| lanes.into_iter().fold(0.0, f32::max))
    }
}

/// Plain loops over sixteen numbers, which the compiler turns into vectors of the tier.
#[inline(always)]
fn raise<L: Lanes>(
    l: L,
    [own, length]: &mut [[f32; BLOCK_BODIES]; 2],
    now: &[[f32; 4]; BLOCK_BODIES],
    then: &[[f32; 4]; BLOCK_BODIES],
) {
    let (now, then) = (quads_in_columns(l, now), quads_in_columns(l, then));
    for i in 0..BLOCK_BODIES {
        let (dx, dy, dz) = (now[0][i] - then[0][i], now[1][i] - then[1][i], now[2][i] - then[2][i]);
        let growth = larger(now[3][i] - then[3][i], 0.0);
        let square = dx * dx + dy * dy + dz * dz + growth * growth;
        let radius = larger(then[3][i], LEAST_RADIUS);
        // A NaN, of a body that breaks the contract, is not larger than anything.
        own[i] = larger(square / (radius * radius), own[i]);
        length[i] = larger(square, length[i]);
    }
}

/// The larger number, or the second one if either is NaN: one instruction, compared with four for
/// `f32::max`.
#[inline(always)]
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::Tier;
    use crate::threads::Threads;

    /// The farthest counts wherever it is in every tier.
    #[test]
    fn farthest_drift_is_found() {
        let pool = Threads::default();
        for n in [1, 15, 16, 33, BALLS_PER_TASK + 1] {
            let then: Vec<_> = (0..n).map(|i| [i as f32, 2.0, -3.0, 4.0]).collect();
            for (wide, far) in [(0, n - 1), (n - 1, 0), (n / 2, n / 2)] {
                let (mut then, mut now) = (then.clone(), then.clone());
                // 2, 4, 4 and a growth of 8 are 10; 6 is 3 of one's own radii.
                for (k, by) in [2.0, -4.0, 4.0, 8.0].into_iter().enumerate() {
                    now[far][k] += by;
                }
                (then[wide][3], now[wide][3]) = (0.5, if wide == far { 8.5 } else { 0.5 });
                now[wide][1] -= 1.0;
                let expected = match wide == far {
                    true => [20.880_613, 10.440_307],
                    false => [2.5, 10.0],
                };
                for tier in Tier::available() {
                    let executor = pool.executor(tier);
                    let found = LargestDrift::of(executor, &now, &then, 0.5);
                    let found = [found.own, 0.5 * found.typical];
                    for (found, expected) in found.into_iter().zip(expected) {
                        let off = (found / expected - 1.0).abs();
                        assert!(off < 1e-6, "{tier}, {far} of {n}: {found}, {expected}");
                    }
                }
            }
        }
    }

    /// Balls that shrink or stay or have no radius are no trouble.
    #[test]
    fn shrinking_or_empty_balls_are_fine() {
        let pool = Threads::default();
        let executor = pool.executor(Tier::SCALAR);
        let motion = |now| LargestDrift::of(executor, now, &[[0.0, 0.0, 0.0, 1.0]; 2], 1.0);
        assert_eq!(motion(&[[0.0, 0.0, 0.0, 0.25]; 2]), LargestDrift::default());
        assert_eq!(motion(&[[f32::NAN; 4]; 2]), LargestDrift::default());
        let still = [[5.0, 0.0, 0.0, 0.0]; 1];
        let motion = LargestDrift::of(executor, &still, &still, 1.0);
        assert_eq!(motion, LargestDrift::default());
    }

    /// The typical radius is that of equal ones and leans to the wide.
    #[test]
    fn typical_radius_leans_to_wide() {
        let typical = |radii: &[f32]| typical_radius(radii.len(), |body| [radii[body]; 3]);
        for n in [1, 2, 300, 10_000] {
            let found = typical(&vec![3.0; n]);
            assert!((found - 3.0).abs() < 1e-12, "{n}: {found}");
        }
        // All four sums of 1 and 3: 8, 64, 64 and 216 over twice 4, 16, 16 and 36.
        let found = typical(&[1.0, 3.0]);
        assert!((found - 352.0 / 144.0).abs() < 1e-12, "{found}");
        // One in two is asked of more than 256.
        let every_other: Vec<f32> = (0..512).map(|i| if i % 2 == 0 { 1.0 } else { 50.0 }).collect();
        assert!((typical(&every_other) - 1.0).abs() < 1e-12);
        assert!(typical(&[0.0]) > 0.0);
    }

    /// What a skin adds to the pairs of boxes, next to what it adds to those of balls of the
    /// typical radius.
    #[test]
    fn typical_radius_of_long_boxes() {
        let sides = [[0.125, 1.0, 8.0], [8.0, 1.0, 0.125], [1.0, 8.0, 0.125], [3.0, 2.0, 1.0]];
        let typical = typical_radius(4, |body| sides[body]);
        let pairs = |skin: f64| -> f64 {
            let product = |a: [f32; 3], b: [f32; 3]| -> f64 {
                (0..3).map(|k| f64::from(a[k] + b[k]) + 2.0 * skin).product()
            };
            sides.iter().flat_map(|&a| sides.map(|b| product(a, b))).sum()
        };
        let step = 1e-6;
        let growth = (pairs(step) - pairs(-step)) / (2.0 * step) / pairs(0.0);
        assert!((3.0 / typical / growth - 1.0).abs() < 1e-6, "{typical}");
    }

    /// Sixteen times the smallest radius is typical and more is not.
    #[test]
    fn typical_radius_has_a_ratio_limit() {
        let typical =
            |wide: f32| typical_radius(256, |body| [if body == 0 { wide } else { 1.0 }; 3]);
        // One of x among 255 of 1: sixteen at x = 39.82.
        let found = typical(39.8);
        assert!((15.9..16.0).contains(&found), "{found}");
        assert_eq!(typical(39.9), 0.0);
        assert_eq!(typical(0.01), 0.0, "one speck");
    }
}
