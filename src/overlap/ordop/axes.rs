//! Separating axes of one pair per lane: both bodies' slab normals, and cross products of edges.

use super::edges;
use super::slabs::LaneSlabs;
use super::support::support;
use super::table::each_direction;
use crate::simd::{Lanes, ROW};
use crate::update::row::{O, Q, S, T};

type Vector<L> = [<L as Lanes>::F; 3];

/// The number of numbers in a [`PairFrames`].
pub const NUMBERS_PER_FRAMES: usize = 17;

/// Two bodies' frames in each other's coordinates, one pair per lane.
#[derive(Clone, Copy)]
pub struct PairFrames<L: Lanes> {
    /// `turn[i][j]` = axis i of A · axis j of B: row i is A's axis in B's coordinates, column j B's
    /// axis in A's.
    turn: [Vector<L>; 3],
    /// Δ along A's axes, Δ from the centre of A to that of B.
    gap_a: Vector<L>,
    /// −Δ along B's axes.
    gap_b: Vector<L>,
    /// The shapes of A and B, as stored in rows.
    pub shapes: [L::F; 2],
}

impl<L: Lanes> PairFrames<L> {
    /// The frames of two rows. Δ is the difference of the input translations plus that of the
    /// offsets, because a difference of rounded world centres would be inexact far from the origin.
    #[cfg_attr(not(unoptimised), inline(always))]
    pub fn new(l: L, a: [L::F; ROW], b: [L::F; ROW]) -> Self {
        let zero = l.splat(0.0);
        let mut delta = [zero; 3];
        for i in 0..3 {
            delta[i] = (b[T + i] - a[T + i]) + (b[O + i] - a[O + i]);
        }
        let (mut turn, mut gap_a, mut gap_b) = ([[zero; 3]; 3], [zero; 3], [zero; 3]);
        for (i, row) in turn.iter_mut().enumerate() {
            gap_a[i] = dot::<L>(axis::<L>(&a, i), delta);
            gap_b[i] = zero - dot::<L>(axis::<L>(&b, i), delta);
            for (j, entry) in row.iter_mut().enumerate() {
                *entry = dot::<L>(axis::<L>(&a, i), axis::<L>(&b, j));
            }
        }
        Self { turn, gap_a, gap_b, shapes: [a[S], b[S]] }
    }

    /// The frames as an array of vectors.
    #[inline(always)]
    pub fn numbers(&self) -> [L::F; NUMBERS_PER_FRAMES] {
        let ([x, y, z], [ga, gb, gc], [ha, hb, hc]) = (self.turn, self.gap_b, self.gap_a);
        let [one, other] = self.shapes;
        [one, other, x[0], x[1], x[2], y[0], y[1], y[2], z[0], z[1], z[2], ga, gb, gc, ha, hb, hc]
    }

    /// The inverse of [`Self::numbers`].
    #[inline(always)]
    pub fn from_numbers(n: [L::F; NUMBERS_PER_FRAMES]) -> Self {
        Self {
            shapes: [n[0], n[1]],
            turn: [[n[2], n[3], n[4]], [n[5], n[6], n[7]], [n[8], n[9], n[10]]],
            gap_b: [n[11], n[12], n[13]],
            gap_a: [n[14], n[15], n[16]],
        }
    }

    /// Lanes in which a slab normal of A separates the pair.
    #[inline(always)]
    pub fn by_normals_of_a<const K: usize>(
        &self,
        l: L,
        a: &LaneSlabs<L>,
        b: &LaneSlabs<L>,
    ) -> L::M {
        by_normals::<L, K>(l, self.turn, self.gap_a, a, b)
    }

    /// Lanes in which a slab normal of B separates the pair.
    #[inline(always)]
    pub fn by_normals_of_b<const K: usize>(
        &self,
        l: L,
        a: &LaneSlabs<L>,
        b: &LaneSlabs<L>,
    ) -> L::M {
        let back = [self.column(0), self.column(1), self.column(2)];
        by_normals::<L, K>(l, back, self.gap_b, b, a)
    }

    /// B's axis j in A's coordinates.
    #[inline(always)]
    fn column(&self, j: usize) -> Vector<L> {
        [self.turn[0][j], self.turn[1][j], self.turn[2][j]]
    }

    /// Lanes in which a cross product of edges separates the pair. An axis shorter than ½ (of
    /// nearly parallel edges) is skipped, because the error bounds are relative to its length, and
    /// normals separate such pairs.
    #[cfg_attr(not(unoptimised), inline(always))]
    pub fn by_edges<const K: usize>(&self, l: L, a: &LaneSlabs<L>, b: &LaneSlabs<L>) -> L::M {
        let all = l.bits(l.first(L::WIDTH));
        let (zero, quarter) = (l.splat(0.0), l.splat(0.25));
        let mut separated = l.first(0);
        for edge_b in edges::of(K) {
            let edge_b = [
                combine(l, *edge_b, self.turn[0]),
                combine(l, *edge_b, self.turn[1]),
                combine(l, *edge_b, self.turn[2]),
            ];
            for edge_a in edges::of(K) {
                let axis = cross(l, *edge_a, edge_b);
                let tau = dot::<L>(axis, self.gap_a);
                let towards = flip(l, axis, tau);
                let away = [
                    zero - dot::<L>(self.column(0), towards),
                    zero - dot::<L>(self.column(1), towards),
                    zero - dot::<L>(self.column(2), towards),
                ];
                let reach = support::<L, K>(l, a, towards) + support::<L, K>(l, b, away);
                let long = l.gt(dot::<L>(axis, axis), quarter);
                separated = separated | (l.gt(l.abs(tau), reach) & long);
            }
            if l.bits(separated) == all {
                break;
            }
        }
        separated
    }
}

/// Lanes separated along one body's own slab normals. `turn[i]` is its axis i in the other's
/// coordinates, `gap` is the vector to the other's centre along its own axes.
#[cfg_attr(not(unoptimised), inline(always))]
fn by_normals<L: Lanes, const K: usize>(
    l: L,
    turn: [Vector<L>; 3],
    gap: Vector<L>,
    own: &LaneSlabs<L>,
    other: &LaneSlabs<L>,
) -> L::M {
    let all = l.bits(l.first(L::WIDTH));
    let [x, y, z] = [
        combinations::<L>(turn[0][0], turn[1][0], turn[2][0]),
        combinations::<L>(turn[0][1], turn[1][1], turn[2][1]),
        combinations::<L>(turn[0][2], turn[1][2], turn[2][2]),
    ];
    let tau = combinations::<L>(gap[0], gap[1], gap[2]);
    // The normal towards the other body selects one slab end; the other body's support is needed in
    // the opposite direction.
    let other = other.mirrored();
    let mut separated = l.first(0);
    each_direction!(K, |i, _place| {
        let towards = flip(l, [x[i], y[i], z[i]], tau[i]);
        let reach = own.own(l, i, tau[i]) + support::<L, K>(l, &other, towards);
        separated = separated | l.gt(l.abs(tau[i]), reach);
        // A single lane returns at its first separating axis. In a wide vector all lanes are rarely
        // separated early.
        if L::WIDTH == 1 && l.bits(separated) == all {
            return separated;
        }
    });
    separated
}

/// All 13 integer combinations of a basis, in the order of the coefficients, for one coordinate.
#[inline(always)]
fn combinations<L: Lanes>(x: L::F, y: L::F, z: L::F) -> [L::F; 13] {
    let (sum, difference) = (x + y, x - y);
    [
        x,
        y,
        z,
        sum,
        difference,
        x + z,
        x - z,
        y + z,
        y - z,
        sum + z,
        z - difference,
        difference + z,
        z - sum,
    ]
}

/// A body's axis j from its row.
#[inline(always)]
fn axis<L: Lanes>(row: &[L::F; ROW], j: usize) -> Vector<L> {
    [row[Q + 3 * j], row[Q + 3 * j + 1], row[Q + 3 * j + 2]]
}

#[inline(always)]
fn dot<L: Lanes>(a: Vector<L>, b: Vector<L>) -> L::F {
    (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]
}

/// v with every sign flipped where `sign` is negative.
#[inline(always)]
fn flip<L: Lanes>(l: L, v: Vector<L>, sign: L::F) -> Vector<L> {
    [l.flip_sign(v[0], sign), l.flip_sign(v[1], sign), l.flip_sign(v[2], sign)]
}

/// n·v for a small integer vector n, whose products are exact.
#[inline(always)]
fn combine<L: Lanes>(l: L, n: [f32; 3], v: Vector<L>) -> L::F {
    dot::<L>([l.splat(n[0]), l.splat(n[1]), l.splat(n[2])], v)
}

/// n × v for a small integer vector n.
#[inline(always)]
fn cross<L: Lanes>(l: L, n: [f32; 3], v: Vector<L>) -> Vector<L> {
    let [x, y, z] = [l.splat(n[0]), l.splat(n[1]), l.splat(n[2])];
    [y * v[2] - z * v[1], z * v[0] - x * v[2], x * v[1] - y * v[0]]
}

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::super::table::COEFFICIENTS;
    use super::*;
    use crate::rounding::pose::{Rotation, rotation};
    use crate::simd::{Kernel, MAX_WIDTH, Tier, dispatch};

    fn only<L: Lanes>(l: L, x: L::F) -> f32 {
        let mut lanes = [0.0; MAX_WIDTH];
        l.store(x, &mut lanes);
        lanes[0]
    }

    /// Combinations and products are those of whole numbers.
    #[test]
    fn combinations_match_integer_arithmetic() {
        struct CombineAndCross([f32; 3], [f32; 3]);
        impl Kernel for CombineAndCross {
            type Output = ([f32; 13], [f32; 3], f32);
            #[inline(always)]
            fn run<L: Lanes>(self, l: L) -> Self::Output {
                let v @ [x, y, z] = self.1.map(|x| l.splat(x));
                (
                    combinations::<L>(x, y, z).map(|x| only(l, x)),
                    cross(l, self.0, v).map(|x| only(l, x)),
                    only(l, combine(l, self.0, v)),
                )
            }
        }
        let (n, v) = ([2.0, -3.0, 5.0], [1.0, 10.0, 100.0]);
        for tier in Tier::available() {
            let (combined, crossed, product) = dispatch(tier, CombineAndCross(n, v));
            let expected =
                COEFFICIENTS.map(|c| (0..3).map(|i| f32::from(c[i]) * v[i]).sum::<f32>());
            assert_eq!(combined, expected, "{tier}");
            assert_eq!(crossed, [-350.0, -195.0, 23.0], "{tier}");
            assert_eq!(product, 472.0, "{tier}");
        }
    }

    /// Boxes of these half edges, the second turned and moved: whether an edge × edge axis
    /// separates them, for k = 6.
    struct BoxPair([[f32; 3]; 2], Rotation, [f32; 3]);

    impl Kernel for BoxPair {
        type Output = bool;
        #[inline(always)]
        fn run<L: Lanes>(self, l: L) -> bool {
            let slabs = self.0.map(|half| {
                let mut ends = [[l.splat(0.0); 2]; 13];
                for (end, x) in ends.iter_mut().zip(half) {
                    *end = [l.splat(x); 2];
                }
                LaneSlabs { ends }
            });
            let row = |turn: [[f64; 3]; 3], t: [f32; 3]| {
                let mut row = [l.splat(0.0); ROW];
                for (j, &x) in t.iter().enumerate() {
                    row[T + j] = l.splat(x);
                    for (i, across) in turn.iter().enumerate() {
                        row[Q + 3 * j + i] = l.splat(across[j] as f32);
                    }
                }
                row
            };
            let still = rotation([0.0, 0.0, 0.0, 1.0]);
            let frames = PairFrames::new(l, row(still, [0.0; 3]), row(self.1, self.2));
            let separated = l.bits(frames.by_edges::<6>(l, &slabs[0], &slabs[1]));
            separated & 1 != 0
        }
    }

    impl BoxPair {
        /// How far, in plain f64, the best axis that is long enough to be tried separates the two.
        fn gap(&self) -> f64 {
            let Self(halves, turn, way) = self;
            let [a, b] = halves.map(|half| half.map(f64::from));
            let way = way.map(f64::from);
            let mut best = f64::NEG_INFINITY;
            for i in 0..3 {
                for j in 0..3 {
                    let [e, f] = [(i + 1) % 3, (i + 2) % 3];
                    let mut axis = [0.0; 3];
                    (axis[e], axis[f]) = (-turn[f][j], turn[e][j]);
                    if axis.iter().map(|x| x * x).sum::<f64>() <= 0.25 {
                        continue;
                    }
                    let own: f64 = (0..3).map(|n| a[n] * axis[n].abs()).sum();
                    let along = |n: usize| (0..3).map(|m| turn[m][n] * axis[m]).sum::<f64>();
                    let other: f64 = (0..3).map(|n| b[n] * along(n).abs()).sum();
                    let between: f64 = (0..3).map(|n| way[n] * axis[n]).sum();
                    best = best.max(between.abs() - own - other);
                }
            }
            best
        }
    }

    /// Edges separate boxes as plain arithmetic says.
    #[test]
    fn edge_axes_match_plain_arithmetic() {
        let mut random = ChaCha8Rng::seed_from_u64(17);
        let mut next = || (random.next_u32() >> 8) as f32 / (1 << 23) as f32 - 1.0;
        for tier in Tier::available() {
            let mut apart = 0;
            for _ in 0..2000 {
                let halves = [(); 2].map(|()| [(); 3].map(|()| 1.25 + next()));
                let turn = rotation([next(), next(), next(), 1.5 + next()]);
                let boxes = BoxPair(halves, turn, [(); 3].map(|()| 3.0 * next()));
                let gap = boxes.gap();
                if gap.abs() > 1e-3 {
                    assert_eq!(dispatch(tier, boxes), gap > 0.0, "{tier}: {gap}");
                    apart += usize::from(gap > 0.0);
                }
            }
            assert!((200..1800).contains(&apart), "{apart}");
        }
    }
}
