//! Lists of pairs through the separating-axis test, a vector of pairs at a time.

use super::axes::Frames;
use super::support::SlabEnds;
use super::table::{SlabTables, TABLE};
use crate::pairs::PairList;
use crate::scene::settings::Overlap;
use crate::simd::{Kernel, Lanes, Level, MAX_WIDTH, ROW, dispatch};
use crate::volume::DirectionSet;

/// The or-DOPs of all bodies as the pair test reads them.
#[derive(Clone, Copy)]
pub struct OrDopColumns<'a> {
    /// One row a body: Q, t, o, one number unused.
    pub rows: &'a [[f32; ROW]],
    /// Each body's shape.
    pub shape: &'a [u32],
    /// Each shape's slabs.
    pub tables: &'a SlabTables,
    /// The separating axes to try.
    pub overlap: Overlap,
}

/// Outcome of a range of pair tests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tested {
    /// Pairs tested.
    pub tests: u64,
    /// Pairs that no tried axis separates.
    pub hits: u64,
}

impl OrDopColumns<'_> {
    /// Tests the listed pairs in the tier `level` and appends the ones that may overlap to `out`, in list order.
    pub fn test_pairs(
        &self,
        level: Level,
        first: &[u32],
        second: &[u32],
        out: &mut PairList,
    ) -> Tested {
        struct Test<'a, 'b>(&'a OrDopColumns<'b>, &'a [u32], &'a [u32], &'a mut PairList);
        impl Kernel for Test<'_, '_> {
            type Output = Tested;
            #[inline(always)]
            fn run<L: Lanes>(self, l: L) -> Tested {
                self.0.test(l, self.1, self.2, self.3)
            }
        }
        dispatch(level, Test(self, first, second, out))
    }

    #[inline(always)]
    fn test<L: Lanes>(&self, l: L, first: &[u32], second: &[u32], out: &mut PairList) -> Tested {
        match self.tables.directions() {
            DirectionSet::K6 => self.test_k::<L, 6>(l, first, second, out),
            DirectionSet::K14 => self.test_k::<L, 14>(l, first, second, out),
            DirectionSet::K18 => self.test_k::<L, 18>(l, first, second, out),
            DirectionSet::K26 => self.test_k::<L, 26>(l, first, second, out),
        }
    }

    #[inline(always)]
    fn test_k<L: Lanes, const K: usize>(
        &self,
        l: L,
        first: &[u32],
        second: &[u32],
        out: &mut PairList,
    ) -> Tested {
        let mut hits = 0;
        for (first, second) in first.chunks(L::WIDTH).zip(second.chunks(L::WIDTH)) {
            let group = Group::new(self, first, second);
            let separated = l.bits(group.separated::<L, K>(l, self));
            let keep = !separated & l.bits(l.first(first.len()));
            let (out_first, out_second) = out.room(L::WIDTH);
            l.compress(keep, l.load_u32(&group.first), out_first);
            l.compress(keep, l.load_u32(&group.second), out_second);
            out.advance(keep.count_ones() as usize);
            hits += u64::from(keep.count_ones());
        }
        Tested {
            tests: first.len() as u64,
            hits,
        }
    }
}

/// Up to a vector of pairs; padding lanes repeat the first pair.
struct Group {
    first: [u32; MAX_WIDTH],
    second: [u32; MAX_WIDTH],
    /// Where each lane's slabs begin.
    first_table: [u32; MAX_WIDTH],
    second_table: [u32; MAX_WIDTH],
    /// Whether all first bodies share a shape, and all second ones.
    uniform: bool,
}

impl Group {
    #[inline(always)]
    fn new(columns: &OrDopColumns<'_>, first: &[u32], second: &[u32]) -> Self {
        let mut group = Self {
            first: [first[0]; MAX_WIDTH],
            second: [second[0]; MAX_WIDTH],
            first_table: [0; MAX_WIDTH],
            second_table: [0; MAX_WIDTH],
            uniform: true,
        };
        group.first[..first.len()].copy_from_slice(first);
        group.second[..second.len()].copy_from_slice(second);
        for lane in 0..MAX_WIDTH {
            group.first_table[lane] = columns.shape[group.first[lane] as usize] * TABLE as u32;
            group.second_table[lane] = columns.shape[group.second[lane] as usize] * TABLE as u32;
            group.uniform &= group.first_table[lane] == group.first_table[0]
                && group.second_table[lane] == group.second_table[0];
        }
        group
    }

    #[inline(always)]
    fn separated<L: Lanes, const K: usize>(&self, l: L, columns: &OrDopColumns<'_>) -> L::M {
        let frames = Frames::new(
            l,
            l.load_transposed(columns.rows, &self.first),
            l.load_transposed(columns.rows, &self.second),
        );
        if self.uniform {
            let one = Uniform(columns.tables.shape(self.first_table[0] / TABLE as u32));
            let other = Uniform(columns.tables.shape(self.second_table[0] / TABLE as u32));
            frames.separated::<K>(l, columns.overlap, &one, &other)
        } else {
            let entries = columns.tables.entries();
            let one = PerLane::<L> {
                entries,
                start: l.load_u32(&self.first_table),
            };
            let other = PerLane::<L> {
                entries,
                start: l.load_u32(&self.second_table),
            };
            frames.separated::<K>(l, columns.overlap, &one, &other)
        }
    }
}

/// One shape in all lanes.
#[derive(Clone, Copy)]
struct Uniform<'a>(&'a [f32; TABLE]);

impl<L: Lanes> SlabEnds<L> for Uniform<'_> {
    #[inline(always)]
    fn facing(&self, l: L, group: usize, octant: L::I) -> L::F {
        let (groups, _) = self.0.as_chunks::<8>();
        l.lookup(&groups[group], octant)
    }
    #[inline(always)]
    fn own(&self, l: L, group: usize, plus: usize, minus: usize, sign: L::F) -> L::F {
        let (plus, minus) = (
            l.splat(self.0[8 * group + plus]),
            l.splat(self.0[8 * group + minus]),
        );
        l.select(l.gt(l.splat(0.0), sign), minus, plus)
    }
}

/// A shape of its own in each lane.
#[derive(Clone, Copy)]
struct PerLane<'a, L: Lanes> {
    entries: &'a [f32],
    start: L::I,
}

impl<L: Lanes> SlabEnds<L> for PerLane<'_, L> {
    #[inline(always)]
    fn facing(&self, l: L, group: usize, octant: L::I) -> L::F {
        let index = l.add_u32(l.add_u32(self.start, l.splat_u32(8 * group as u32)), octant);
        l.gather(self.entries, index)
    }
    #[inline(always)]
    fn own(&self, l: L, group: usize, plus: usize, minus: usize, sign: L::F) -> L::F {
        let entry = |octant: usize| l.add_u32(self.start, l.splat_u32((8 * group + octant) as u32));
        let (plus, minus) = (
            l.gather(self.entries, entry(plus)),
            l.gather(self.entries, entry(minus)),
        );
        l.select(l.gt(l.splat(0.0), sign), minus, plus)
    }
}
