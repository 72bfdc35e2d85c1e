//! The separating-axis test of a list of pairs, a vector of pairs at a time.

use super::axes::{NUMBERS_PER_FRAMES, PairFrames};
use super::slabs::LaneSlabs;
use super::table::SlabTables;
use crate::pairs::PairList;
use crate::settings::Overlap;
use crate::simd::{Kernel, Lanes, MAX_WIDTH, Tier, dispatch, in_one_lane, prefetch};
use crate::update::RowsByNumber;
use crate::volume::DirectionSet;

/// Pairs per block: all are tested with the first bodies' normals before the survivors take the
/// other axes, so that the survivors' frames fit into the first-level cache.
const PAIRS_PER_BLOCK: usize = 128;

/// How many pairs ahead rows are prefetched.
const PREFETCH_DISTANCE: usize = 48;

/// The most rows that fit into the caches. With fewer, prefetching only costs time.
const ROWS_IN_CACHE: usize = 1 << 13;

/// The or-DOPs of all bodies as the pair test reads them.
#[derive(Clone, Copy)]
pub struct OrDopColumns<'a> {
    /// One row per body: Q, t, o and the shape.
    pub rows: RowsByNumber<'a>,
    /// Each shape's slabs.
    pub tables: &'a SlabTables,
    /// The separating axes to try.
    pub overlap: Overlap,
}

/// The counts of a range of pair tests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TestOutcome {
    /// Pairs tested.
    pub tests: u64,
    /// Pairs that none of the tried axes separates.
    pub hits: u64,
}

impl OrDopColumns<'_> {
    /// Tests the listed pairs in the tier `tier` and appends those that may overlap to `out`, in
    /// list order.
    pub fn test_pairs(
        &self,
        tier: Tier,
        first: &[u32],
        second: &[u32],
        out: &mut PairList,
    ) -> TestOutcome {
        struct Test<'a, 'b>(&'a OrDopColumns<'b>, &'a [u32], &'a [u32], &'a mut PairList);
        impl Kernel for Test<'_, '_> {
            type Output = TestOutcome;
            #[inline(always)]
            fn run<L: Lanes>(self, l: L) -> TestOutcome {
                self.0.test(l, self.1, self.2, self.3)
            }
        }
        dispatch(tier, Test(self, first, second, out))
    }

    /// Whether none of the tried axes separates the two rows: the same test for one pair, in one
    /// lane, which returns at the first separating axis.
    #[must_use]
    pub fn may_overlap(&self, first: u32, second: u32) -> bool {
        struct Test<'a, 'b>(&'a OrDopColumns<'b>, [u32; 2]);
        impl Kernel for Test<'_, '_> {
            type Output = bool;
            #[inline(always)]
            fn run<L: Lanes>(self, l: L) -> bool {
                match self.0.tables.directions() {
                    DirectionSet::K6 => self.0.test_one::<L, 6>(l, self.1),
                    DirectionSet::K14 => self.0.test_one::<L, 14>(l, self.1),
                    DirectionSet::K18 => self.0.test_one::<L, 18>(l, self.1),
                    DirectionSet::K26 => self.0.test_one::<L, 26>(l, self.1),
                }
            }
        }
        in_one_lane(Test(self, [first, second]))
    }

    #[cfg_attr(not(unoptimised), inline(always))]
    fn test_one<L: Lanes, const K: usize>(&self, l: L, pair: [u32; 2]) -> bool {
        let [a, b] =
            pair.map(|body| l.load_transposed(&self.rows, &[self.rows.find(body); MAX_WIDTH]));
        let frames = PairFrames::new(l, a, b);
        let [a, b] = self.slabs::<L, K, false>(l, &frames);
        let apart = |mask: L::M| l.bits(mask) & 1 != 0;
        !(apart(frames.by_normals_of_a::<K>(l, &a, &b))
            || self.overlap != Overlap::OneSided && apart(frames.by_normals_of_b::<K>(l, &a, &b))
            || self.overlap == Overlap::Full && apart(frames.by_edges::<K>(l, &a, &b)))
    }

    #[inline(always)]
    fn test<L: Lanes>(
        &self,
        l: L,
        first: &[u32],
        second: &[u32],
        out: &mut PairList,
    ) -> TestOutcome {
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
    ) -> TestOutcome {
        // Only a vector of 16 lanes has a permutation for 16 shapes; with two halves, loading rows
        // is as fast.
        let few = L::WIDTH == 16 && !self.tables.columns().is_empty();
        if few {
            self.test_blocks::<L, K, true>(l, first, second, out)
        } else {
            self.test_blocks::<L, K, false>(l, first, second, out)
        }
    }

    #[cfg_attr(not(unoptimised), inline(always))]
    fn test_blocks<L: Lanes, const K: usize, const FEW: bool>(
        &self,
        l: L,
        first: &[u32],
        second: &[u32],
        out: &mut PairList,
    ) -> TestOutcome {
        let (mut pairs, mut alive) = (PairBlock::new(), SurvivorBlock::new());
        let listed = out.len();
        for start in (0..first.len()).step_by(PAIRS_PER_BLOCK) {
            let end = first.len().min(start + PAIRS_PER_BLOCK);
            pairs.fill(&first[start..end], &second[start..end]);
            let later = first.len().min(start + PREFETCH_DISTANCE);
            let later = [&first[later..], &second[later..]];
            self.by_first::<L, K, FEW>(l, &pairs, later, &mut alive);
            self.by_rest::<L, K, FEW>(l, &alive, out);
        }
        TestOutcome { tests: first.len() as u64, hits: (out.len() - listed) as u64 }
    }

    /// Tests pairs with the normals of the first bodies. `later` are the pairs
    /// [`PREFETCH_DISTANCE`] after these, whose rows are prefetched.
    #[cfg_attr(not(unoptimised), inline(always))]
    fn by_first<L: Lanes, const K: usize, const FEW: bool>(
        &self,
        l: L,
        pairs: &PairBlock,
        later: [&[u32]; 2],
        alive: &mut SurvivorBlock,
    ) {
        alive.pairs.len = 0;
        let mut start = 0;
        while start < pairs.len {
            if self.rows.len() > ROWS_IN_CACHE {
                for column in later {
                    self.prefetch_rows(column.iter().skip(start).take(L::WIDTH));
                }
            }
            let frames = PairFrames::new(
                l,
                l.load_transposed(&self.rows, &self.rows_of(&pairs.first[start..])),
                l.load_transposed(&self.rows, &self.rows_of(&pairs.second[start..])),
            );
            let [a, b] = self.slabs::<L, K, FEW>(l, &frames);
            let separated = l.bits(frames.by_normals_of_a::<K>(l, &a, &b));
            let keep = !separated & l.bits(l.first(pairs.len - start));
            alive.push(l, keep, pairs, start, &frames, self.overlap);
            start += L::WIDTH;
        }
        alive.pad();
    }

    /// Tests the remaining pairs with all other axes, and appends the survivors to `out`.
    #[cfg_attr(not(unoptimised), inline(always))]
    fn by_rest<L: Lanes, const K: usize, const FEW: bool>(
        &self,
        l: L,
        alive: &SurvivorBlock,
        out: &mut PairList,
    ) {
        let pairs = &alive.pairs;
        let mut start = 0;
        while start < pairs.len {
            let mut keep = l.bits(l.first(pairs.len - start));
            if self.overlap != Overlap::OneSided {
                let frames = alive.frames(l, start);
                let [a, b] = self.slabs::<L, K, FEW>(l, &frames);
                keep &= !l.bits(frames.by_normals_of_b::<K>(l, &a, &b));
                if self.overlap == Overlap::Full && keep != 0 {
                    keep &= !l.bits(frames.by_edges::<K>(l, &a, &b));
                }
            }
            let (first, second) = out.room(L::WIDTH);
            l.compress(keep, l.load_u32(&pairs.first[start..]), first);
            l.compress(keep, l.load_u32(&pairs.second[start..]), second);
            out.advance(keep.count_ones() as usize);
            start += L::WIDTH;
        }
    }

    /// The indices of the first bodies' rows, a vector of them.
    #[inline(always)]
    fn rows_of(&self, bodies: &[u32]) -> [u32; MAX_WIDTH] {
        let mut rows = [0; MAX_WIDTH];
        for (row, &body) in rows.iter_mut().zip(bodies) {
            *row = self.rows.find(body);
        }
        rows
    }

    #[inline(always)]
    fn prefetch_rows<'a>(&self, wanted: impl Iterator<Item = &'a u32>) {
        for &body in wanted {
            if let Some(row) = self.rows.get(self.rows.find(body) as usize) {
                prefetch(row);
            }
        }
    }

    #[inline(always)]
    fn slabs<L: Lanes, const K: usize, const FEW: bool>(
        &self,
        l: L,
        frames: &PairFrames<L>,
    ) -> [LaneSlabs<L>; 2] {
        [
            LaneSlabs::load::<K, FEW>(l, self.tables, frames.shapes[0]),
            LaneSlabs::load::<K, FEW>(l, self.tables, frames.shapes[1]),
        ]
    }
}

/// A block of pairs, padded with copies of the first one.
struct PairBlock {
    len: usize,
    first: [u32; PAIRS_PER_BLOCK + MAX_WIDTH],
    second: [u32; PAIRS_PER_BLOCK + MAX_WIDTH],
}

impl PairBlock {
    #[inline(always)]
    fn new() -> Self {
        Self {
            len: 0,
            first: [0; PAIRS_PER_BLOCK + MAX_WIDTH],
            second: [0; PAIRS_PER_BLOCK + MAX_WIDTH],
        }
    }

    #[inline(always)]
    fn fill(&mut self, first: &[u32], second: &[u32]) {
        self.len = first.len();
        self.first[..first.len()].copy_from_slice(first);
        self.second[..second.len()].copy_from_slice(second);
        self.pad();
    }

    #[inline(always)]
    fn pad(&mut self) {
        for column in [&mut self.first, &mut self.second] {
            let one = column[0];
            column[self.len..self.len + MAX_WIDTH].fill(one);
        }
    }
}

/// Pairs of a block that the first bodies' normals don't separate, with their frames.
struct SurvivorBlock {
    pairs: PairBlock,
    frames: [[f32; PAIRS_PER_BLOCK + MAX_WIDTH]; NUMBERS_PER_FRAMES],
}

impl SurvivorBlock {
    #[inline(always)]
    fn new() -> Self {
        Self {
            pairs: PairBlock::new(),
            frames: [[0.0; PAIRS_PER_BLOCK + MAX_WIDTH]; NUMBERS_PER_FRAMES],
        }
    }

    #[inline(always)]
    fn push<L: Lanes>(
        &mut self,
        l: L,
        keep: u32,
        from: &PairBlock,
        start: usize,
        frames: &PairFrames<L>,
        overlap: Overlap,
    ) {
        let at = self.pairs.len..self.pairs.len + MAX_WIDTH;
        let (first, second) = (&mut self.pairs.first, &mut self.pairs.second);
        l.compress(keep, l.load_u32(&from.first[start..]), &mut first[at.clone()]);
        l.compress(keep, l.load_u32(&from.second[start..]), &mut second[at.clone()]);
        let needed = match overlap {
            Overlap::OneSided => 0,
            Overlap::TwoSided => NUMBERS_PER_FRAMES - 3,
            Overlap::Full => NUMBERS_PER_FRAMES,
        };
        let numbers = frames.numbers();
        for (column, number) in self.frames.iter_mut().zip(numbers).take(needed) {
            l.pack(keep, number, &mut column[at.clone()]);
        }
        self.pairs.len += keep.count_ones() as usize;
    }

    /// Pads the last vector with the first pair.
    #[inline(always)]
    fn pad(&mut self) {
        self.pairs.pad();
        let len = self.pairs.len;
        for column in &mut self.frames {
            let one = column[0];
            column[len..len + MAX_WIDTH].fill(one);
        }
    }

    #[inline(always)]
    fn frames<L: Lanes>(&self, l: L, start: usize) -> PairFrames<L> {
        let mut numbers = [l.splat(0.0); NUMBERS_PER_FRAMES];
        for (number, column) in numbers.iter_mut().zip(&self.frames) {
            *number = l.load(&column[start..]);
        }
        PairFrames::from_numbers(numbers)
    }
}
