//! Support of an or-DOP in any direction, bounded from its slabs alone by weak duality.
//!
//! If e = Σ λᵢdᵢ with λ ≥ 0, then h(e) ≤ Σ λᵢhᵢ, the dual of the linear program that maximises e·x
//! over the slabs. The multipliers below are the optimal ones for a DOP whose slabs are all tight
//! against a centrally placed ball. They are functions of (a, b, c) = |e| without sorting, so that
//! lanes never diverge; a slab that has no part in the optimum gets λ = 0. No vertices are needed,
//! rounding keeps λ ≥ 0, and the bound reports 0.9 % more pairs than the vertices would.

use super::slabs::{DirectionSigns, LaneSlabs};
use crate::simd::Lanes;

/// Upper bound of the support in direction e, in the coordinates of the DOP's own basis.
#[cfg_attr(not(unoptimised), inline(always))]
pub fn support<L: Lanes, const K: usize>(l: L, slabs: &LaneSlabs<L>, e: [L::F; 3]) -> L::F {
    let signs = DirectionSigns::of(l, e);
    let size = [l.abs(e[0]), l.abs(e[1]), l.abs(e[2])];
    match K {
        6 => {
            let [x, y, z] = slabs.axes(l, signs);
            (size[0] * x + size[1] * y) + size[2] * z
        }
        14 => support_14(l, slabs, signs, size),
        18 => support_18(l, slabs, signs, size),
        _ => support_26(l, slabs, signs, size),
    }
}

/// Axes and cube diagonals: ½(median + low) on the octant's own diagonal, the rest of the lower two
/// on the diagonal that is bent over the lowest coordinate, and the lead of the largest on its
/// axis.
#[inline(always)]
fn support_14<L: Lanes>(
    l: L,
    slabs: &LaneSlabs<L>,
    signs: DirectionSigns<L>,
    size: [L::F; 3],
) -> L::F {
    let (low, [ab, ac, bc]) = minima(l, size);
    let half = l.splat(0.5);
    // The median is the largest of the pairwise minima.
    let median = l.max(l.max(ab, ac), bc);
    let (straight, [over_a, over_b, over_c]) = slabs.cube(l, signs);
    let base = (half * (median + low)) * straight;
    let bent = ((half * (ab - low)) * over_c + (half * (ac - low)) * over_b)
        + (half * (bc - low)) * over_a;
    (base + bent) + leads(l, slabs, signs, size)
}

/// Axes and face diagonals: where no coordinate exceeds the sum of the others, face diagonals
/// alone; else two of them and the excess on its axis.
#[inline(always)]
fn support_18<L: Lanes>(
    l: L,
    slabs: &LaneSlabs<L>,
    signs: DirectionSigns<L>,
    [a, b, c]: [L::F; 3],
) -> L::F {
    let (half, zero) = (l.splat(0.5), l.splat(0.0));
    let (ca, cb, cc) = (l.min(a, b + c), l.min(b, a + c), l.min(c, a + b));
    let ([xy, xz, yz], [x, y, z]) = (slabs.pairs(l, signs), slabs.axes(l, signs));
    let ab = l.max(half * ((ca + cb) - cc), zero) * xy;
    let ac = l.max(half * ((ca + cc) - cb), zero) * xz;
    let bc = l.max(half * ((cb + cc) - ca), zero) * yz;
    let axes = ((a - ca) * x + (b - cb) * y) + (c - cc) * z;
    ((ab + ac) + bc) + axes
}

/// All groups: the lowest coordinate on the cube diagonal, the median's lead over it on a face
/// diagonal, and the largest's lead on its axis.
#[inline(always)]
fn support_26<L: Lanes>(
    l: L,
    slabs: &LaneSlabs<L>,
    signs: DirectionSigns<L>,
    size: [L::F; 3],
) -> L::F {
    let (low, [ab, ac, bc]) = minima(l, size);
    let [xy, xz, yz] = slabs.pairs(l, signs);
    let pairs = ((ab - low) * xy + (ac - low) * xz) + (bc - low) * yz;
    let (cube, _) = slabs.cube(l, signs);
    (low * cube + pairs) + leads(l, slabs, signs, size)
}

/// The lowest coordinate, and the lower of each pair.
#[inline(always)]
fn minima<L: Lanes>(l: L, [a, b, c]: [L::F; 3]) -> (L::F, [L::F; 3]) {
    let ab = l.min(a, b);
    (l.min(ab, c), [ab, l.min(a, c), l.min(b, c)])
}

/// The axes' part where diagonals take the rest: the lead of the largest coordinate over the
/// second.
#[inline(always)]
fn leads<L: Lanes>(
    l: L,
    slabs: &LaneSlabs<L>,
    signs: DirectionSigns<L>,
    [a, b, c]: [L::F; 3],
) -> L::F {
    let zero = l.splat(0.0);
    let (lead_a, lead_b) = (l.max(a - l.max(b, c), zero), l.max(b - l.max(a, c), zero));
    let lead_c = l.max(c - l.max(a, b), zero);
    let [x, y, z] = slabs.axes(l, signs);
    (lead_a * x + lead_b * y) + lead_c * z
}

#[cfg(test)]
mod tests {
    use super::super::table::{COEFFICIENTS, members_of};
    use super::*;
    use crate::simd::{Kernel, MAX_WIDTH, Tier, dispatch};

    type Ends = [[f32; 2]; 13];

    struct Support<const K: usize>(Ends, [f32; 3]);

    impl<const K: usize> Kernel for Support<K> {
        type Output = f32;
        #[inline(always)]
        fn run<L: Lanes>(self, l: L) -> f32 {
            let ends = self.0.map(|ends| ends.map(|end| l.splat(end)));
            let e = self.1.map(|x| l.splat(x));
            let mut bound = [0.0; MAX_WIDTH];
            l.store(support::<L, K>(l, &LaneSlabs { ends }, e), &mut bound);
            bound[0]
        }
    }

    fn bound(tier: Tier, k: usize, ends: Ends, e: [f32; 3]) -> f32 {
        match k {
            6 => dispatch(tier, Support::<6>(ends, e)),
            14 => dispatch(tier, Support::<14>(ends, e)),
            18 => dispatch(tier, Support::<18>(ends, e)),
            _ => dispatch(tier, Support::<26>(ends, e)),
        }
    }

    /// All directions with small whole coordinates, of any signs and in any order of size.
    fn directions() -> impl Iterator<Item = [f32; 3]> {
        let whole = |n: u32, place: u32| (n / 7u32.pow(place) % 7) as f32 - 3.0;
        (0..343).map(move |n| [0, 1, 2].map(|place| whole(n, place)))
    }

    /// A bound is linear in the ends: one end of 1 among zeros reveals its multiplier, and all of
    /// them put e together again.
    #[test]
    fn multipliers_reproduce_the_direction() {
        for tier in Tier::available() {
            for k in [6, 14, 18, 26] {
                for e in directions() {
                    let mut sum = [0.0; 3];
                    let members = members_of(k).iter();
                    for (member, side) in members.flat_map(|&member| [(member, 0), (member, 1)]) {
                        let mut ends = Ends::default();
                        ends[member][side] = 1.0;
                        let multiplier = bound(tier, k, ends, e);
                        assert!(multiplier >= 0.0, "{tier}, k = {k}, {e:?}: {member}");
                        let sign = [1.0, -1.0][side];
                        for (sum, &c) in sum.iter_mut().zip(&COEFFICIENTS[member]) {
                            *sum += sign * multiplier * f32::from(c);
                        }
                    }
                    assert_eq!(sum, e, "{tier}, k = {k}");
                }
            }
        }
    }

    /// About a ball of radius 1, whose slabs end at the lengths of their normals, the multipliers
    /// are the best there are.
    #[test]
    fn ball_bound_is_optimal() {
        let length = |c: [i8; 3]| f32::from(c.iter().map(|x| x * x).sum::<i8>()).sqrt();
        let ball = COEFFICIENTS.map(|c| [length(c); 2]);
        let [of_two, of_three] = [2.0_f32, 3.0].map(f32::sqrt);
        for e in directions() {
            let mut sorted = e.map(f32::abs);
            sorted.sort_by(f32::total_cmp);
            let [low, median, high] = sorted;
            let lead = high - median;
            let diagonals = match high - low - median {
                excess if excess > 0.0 => (low + median) * of_two + excess,
                _ => 0.5 * (low + median + high) * of_two,
            };
            for (k, expected) in [
                (6, low + median + high),
                (14, median * of_three + lead),
                (18, diagonals),
                (26, low * of_three + (median - low) * of_two + lead),
            ] {
                let found = bound(Tier::SCALAR, k, ball, e);
                assert!((found - expected).abs() < 1e-5, "k = {k}, {e:?}: {found} of {expected}");
            }
        }
    }
}
