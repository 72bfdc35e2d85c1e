//! [`LaneSlabs`]: the slab ends of a vector of or-DOPs, one per lane, as columns. An end is
//! selected by signs, without a memory access.
//!
//! Each lane has its own shape, so ends can't be broadcast, and gathering them one by one takes 144
//! gathers per vector at k = 18, which was two thirds of the test's time. Instead all ends of each
//! lane's shape are loaded once, and every look-up is one to seven selections by the sign bits of
//! the direction.

use super::table::{SlabTables, each_direction};
use crate::simd::{Lanes, MAX_WIDTH, ROW};
use crate::update::row::SHAPE;

/// The ends of each lane's slabs.
#[derive(Clone, Copy)]
pub struct LaneSlabs<L: Lanes> {
    /// For each direction in the order of K26: the end in that direction, and the one in the
    /// opposite direction. Directions that the set lacks have zeros.
    pub ends: [[L::F; 2]; 13],
}

/// Which coordinates of a direction are negative, per lane.
#[derive(Clone, Copy)]
pub struct DirectionSigns<L: Lanes>([L::M; 3]);

impl<L: Lanes> DirectionSigns<L> {
    /// The signs of e. A zero counts by its sign bit.
    #[inline(always)]
    pub fn of(l: L, e: [L::F; 3]) -> Self {
        Self([l.negative(e[0]), l.negative(e[1]), l.negative(e[2])])
    }
}

impl<L: Lanes> LaneSlabs<L> {
    /// Loads the slabs of each lane's shape, with the K half-spaces that all tables have. `shapes`
    /// are as stored in rows.
    #[inline(always)]
    pub fn load<const K: usize, const FEW: bool>(l: L, tables: &SlabTables, shape: L::F) -> Self {
        let shape = l.add_u32(l.as_u32(shape), l.splat_u32(0u32.wrapping_sub(SHAPE)));
        if FEW {
            Self::look_up::<K>(l, tables.columns(), shape)
        } else {
            Self::load_rows::<K>(l, tables.rows(), shape)
        }
    }

    /// Loads every end by one permutation of a column that has it for all shapes.
    #[cfg_attr(not(unoptimised), inline(always))]
    fn look_up<const K: usize>(l: L, columns: &[[f32; ROW]], shape: L::I) -> Self {
        let mut ends = [[l.splat(0.0); 2]; 13];
        let columns = &columns[..K];
        each_direction!(K, |member, place| {
            ends[member] = [
                l.lookup_16(&columns[2 * place], shape),
                l.lookup_16(&columns[2 * place + 1], shape),
            ];
        });
        Self { ends }
    }

    #[cfg_attr(not(unoptimised), inline(always))]
    fn load_rows<const K: usize>(l: L, rows: &[[f32; ROW]], shape: L::I) -> Self {
        let zero = l.splat(0.0);
        let mut shapes = [0; MAX_WIDTH];
        l.compress(u32::MAX, shape, &mut shapes);
        let low = l.load_transposed(rows, &shapes.map(|shape| 2 * shape));
        let high = match K {
            0..=ROW => [zero; ROW],
            _ => l.load_transposed(rows, &shapes.map(|shape| 2 * shape + 1)),
        };
        let mut ends = [[zero; 2]; 13];
        each_direction!(K, |member, place| {
            ends[member] = match 2 * place {
                n @ 0..ROW => [low[n], low[n + 1]],
                n => [high[n - ROW], high[n - ROW + 1]],
            };
        });
        Self { ends }
    }

    /// The point reflections of the bodies: ends in a direction become those in the opposite one.
    #[inline(always)]
    pub fn mirrored(&self) -> Self {
        let mut ends = self.ends;
        for end in &mut ends {
            *end = [end[1], end[0]];
        }
        Self { ends }
    }

    /// The end of a direction's slab, or the other end if `sign` is negative.
    #[inline(always)]
    pub fn own(&self, l: L, member: usize, sign: L::F) -> L::F {
        pick(l, l.negative(sign), self.ends[member])
    }

    /// The ends in the directions of the axes.
    #[inline(always)]
    pub fn axes(&self, l: L, DirectionSigns([x, y, z]): DirectionSigns<L>) -> [L::F; 3] {
        [pick(l, x, self.ends[0]), pick(l, y, self.ends[1]), pick(l, z, self.ends[2])]
    }

    /// The ends in the directions of the face diagonals xy, xz and yz.
    #[inline(always)]
    pub fn pairs(&self, l: L, DirectionSigns([x, y, z]): DirectionSigns<L>) -> [L::F; 3] {
        [self.pair(l, 3, x, y), self.pair(l, 5, x, z), self.pair(l, 7, y, z)]
    }

    /// The end of one of the directions (1, 1) and (1, −1) in a pair of coordinates, which are
    /// `member` and the next.
    #[inline(always)]
    fn pair(&self, l: L, member: usize, x: L::M, y: L::M) -> L::F {
        if L::WIDTH == 1 {
            let (x, y) = (bit(l, x), bit(l, y));
            return self.ends[member + (x ^ y)][x];
        }
        let ([sum, minus_sum], [difference, minus_difference]) =
            (self.ends[member], self.ends[member + 1]);
        let with = pick(l, x, [sum, minus_difference]);
        let against = pick(l, x, [difference, minus_sum]);
        pick(l, y, [with, against])
    }

    /// The end in the direction of the cube diagonal, then those of its neighbours with x, y or z
    /// negated.
    #[inline(always)]
    pub fn cube(&self, l: L, DirectionSigns([x, y, z]): DirectionSigns<L>) -> (L::F, [L::F; 3]) {
        if L::WIDTH == 1 {
            let (x, y, z) = (bit(l, x), bit(l, y), bit(l, z));
            let facing = |x: usize, y: usize, z: usize| self.ends[9 + (x ^ z) + 2 * (y ^ z)][z];
            let bent = [facing(1 - x, y, z), facing(x, 1 - y, z), facing(x, y, 1 - z)];
            return (facing(x, y, z), bent);
        }
        let [a, b, c, d] = [self.ends[9], self.ends[10], self.ends[11], self.ends[12]];
        // Pairs by the sign of x; the four are for the signs of (y, z): ++, −+, +−, −−.
        let by_x = [[a[0], b[0]], [c[0], d[0]], [d[1], c[1]], [b[1], a[1]]];
        let (mut kept, mut bent) = ([a[0]; 4], [a[0]; 4]);
        for (i, [plus, minus]) in by_x.into_iter().enumerate() {
            kept[i] = pick(l, x, [plus, minus]);
            bent[i] = pick(l, x, [minus, plus]);
        }
        let up = pick(l, y, [kept[0], kept[1]]);
        let down = pick(l, y, [kept[2], kept[3]]);
        let over_x = [pick(l, y, [bent[0], bent[1]]), pick(l, y, [bent[2], bent[3]])];
        let over_y = [pick(l, y, [kept[1], kept[0]]), pick(l, y, [kept[3], kept[2]])];
        let bent = [pick(l, z, over_x), pick(l, z, over_y), pick(l, z, [down, up])];
        (pick(l, z, [up, down]), bent)
    }
}

/// The only lane of a mask as an index, because with one lane an indexed load is faster than
/// selections.
#[inline(always)]
fn bit<L: Lanes>(l: L, mask: L::M) -> usize {
    (l.bits(mask) & 1) as usize
}

/// The first number, or the second where the mask is set.
#[inline(always)]
fn pick<L: Lanes>(l: L, negative: L::M, ends: [L::F; 2]) -> L::F {
    if L::WIDTH == 1 {
        return ends[bit(l, negative)];
    }
    l.select(negative, ends[1], ends[0])
}
