//! The first volume test on all threads: candidates in, a list of pairs out, or portions of it.

mod hit_names;
mod output;
mod tasks;

use std::ops::Range;

use self::hit_names::HitSlots;
pub(crate) use self::hit_names::{HitNames, PairNames, SlotNames};
pub(crate) use self::output::{Output, PAIRS_PER_PORTION, TaskOutput, list_up_to};
pub(crate) use self::tasks::{Task, Tasks, split_work};
use crate::bodies::PairFilter;
use crate::broad_phase::{Block, FirstTest, MOST_CANDIDATES, PairFinder, SlotTest};
use crate::counters::VolumeCounters;
use crate::pairs::PairList;
use crate::simd::{CACHE_LINE, Kernel, Lanes, MAX_WIDTH, Tier, dispatch, prefetch};
use crate::threads::Threads;

/// Slots of a run that are tested at once, before their hits are listed.
const SLOTS_PER_TEST: usize = MOST_CANDIDATES;

/// How many slots after the farthest slot of a block names are prefetched: about twenty blocks
/// ahead of their use.
const PREFETCH_DISTANCE: usize = 256;

/// The most names that fit into the second-level cache. With fewer, prefetching only costs time.
const NAMES_IN_CACHE: usize = 1 << 16;

/// Names in a cache line.
const NAMES_PER_LINE: usize = CACHE_LINE / size_of::<u32>();

/// The counts and times of culling a frame.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Totals {
    /// The counters of the first test.
    pub first: VolumeCounters,
    /// The counters of the refining test, with lazily computed rows as updates.
    pub refining: VolumeCounters,
    /// Pairs reported untested because the budget had ended.
    pub untested: u64,
    /// Wall time of the refining test: its seconds divided by the number of threads.
    pub refining_seconds: f64,
    /// Wall time of computing rows lazily.
    pub update_seconds: f64,
}

/// The volumes that candidates are tested by.
pub(crate) trait FirstVolume: Copy + Sync {
    /// Lists the pairs that pass this test, by [`ListParts::with`].
    fn list<L: Lanes>(self, l: L, parts: ListParts<'_, Self>) -> VolumeCounters;
}

/// The candidates of a frame, the test that they must pass, and what is listed for those that pass.
#[derive(Clone, Copy)]
pub(crate) struct Listing<'a, V> {
    pub tier: Tier,
    pub finder: &'a PairFinder,
    pub first: V,
    pub names: HitNames<'a>,
    /// Which pairs pass after the first test, where not all do.
    pub filter: Option<PairFilter<'a>>,
}

impl<'a, V: FirstVolume> Listing<'a, V> {
    /// Lists the pairs that pass the first test, for some parts of the finder's work, and counts
    /// tests and hits. `flush` gets the list whenever it has at least `enough` pairs.
    pub fn run(
        &self,
        parts: Range<usize>,
        out: &mut PairList,
        enough: usize,
        flush: &mut dyn FnMut(&mut PairList),
    ) -> VolumeCounters {
        let flush = FlushRule { enough, call: flush };
        dispatch(self.tier, ListParts { listing: *self, parts, out, flush })
    }
}

/// Lists the pairs that pass the first test, on all threads.
pub(crate) fn list<V: FirstVolume, W: Clone + Default + Send>(
    listing: Listing<'_, V>,
    pool: &Threads,
    tasks: &mut Tasks<W>,
    output: Output<'_>,
) -> Totals {
    let work = |parts: Range<usize>, task: &mut Task<W>, outlet: &TaskOutput<'_, '_>| {
        let flush = &mut |out: &mut PairList| outlet.offer(out);
        task.first = listing.run(parts, &mut task.out, outlet.worth(), flush);
    };
    split_work(pool, tasks, listing.finder.parts(), output, work)
}

/// What happens when a list has enough pairs.
struct FlushRule<'a> {
    enough: usize,
    call: &'a mut dyn FnMut(&mut PairList),
}

/// Some parts of a frame's candidates, and the list of those that pass.
pub(crate) struct ListParts<'a, V> {
    listing: Listing<'a, V>,
    parts: Range<usize>,
    out: &'a mut PairList,
    flush: FlushRule<'a>,
}

impl<V: FirstVolume> Kernel for ListParts<'_, V> {
    type Output = VolumeCounters;
    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> VolumeCounters {
        self.listing.first.list(l, self)
    }
}

impl<V> ListParts<'_, V> {
    /// Lists the pairs that pass this test.
    #[inline(always)]
    pub fn with<L: Lanes>(self, l: L, test: &impl SlotTest) -> VolumeCounters {
        let finder = self.listing.finder;
        let mut lister = Lister {
            test,
            names: self.listing.names,
            filter: self.listing.filter,
            out: self.out,
            flush: self.flush,
            counters: VolumeCounters::default(),
            prefetched: 0,
            hits: HitBuffer([0; SLOTS_PER_TEST + MAX_WIDTH]),
        };
        finder.find(l, self.parts, &mut lister);
        lister.counters
    }
}

/// A first test that lists the pairs that pass.
struct Lister<'a, 'f, T> {
    test: &'a T,
    names: HitNames<'a>,
    filter: Option<PairFilter<'a>>,
    out: &'f mut PairList,
    flush: FlushRule<'f>,
    counters: VolumeCounters,
    /// The slot up to which names are prefetched.
    prefetched: usize,
    /// The hits of the present piece or block.
    hits: HitBuffer,
}

/// A buffer for the hits of a piece or a block, aligned to a cache line. Each vector of tests
/// stores a vector of hits after the earlier ones, usually at the same place because there are no
/// hits. If that store crosses a page, a frame of spheres takes 3.4 times as long (500 bodies, all
/// pairs, AVX-512), which would depend on the position of the stack.
#[repr(align(64))]
struct HitBuffer([u32; SLOTS_PER_TEST + MAX_WIDTH]);

impl<T: SlotTest> FirstTest for Lister<'_, '_, T> {
    #[cfg_attr(not(unoptimised), inline(always))]
    fn run<L: Lanes>(&mut self, l: L, i: usize, run: Range<usize>) {
        self.counters.tests += run.len() as u64;
        let mut start = run.start;
        while start < run.end {
            let piece = start..run.end.min(start + SLOTS_PER_TEST);
            start = piece.end;
            let found = self.test.run(l, i, piece, &mut self.hits.0);
            self.append(l, found, HitSlots::With(i));
        }
    }

    #[cfg_attr(not(unoptimised), inline(always))]
    fn block<L: Lanes>(&mut self, l: L, block: &Block<'_>) {
        self.counters.tests += block.codes().len() as u64;
        if self.names.by_slot.len() > NAMES_IN_CACHE {
            self.prefetch_beyond(block);
        }
        let found = self.test.block(l, block, &mut self.hits.0);
        self.append(l, found, HitSlots::Codes(block.first()));
    }
}

impl<T> Lister<'_, '_, T> {
    /// Prefetches the names that the next blocks will be the first to read: those after the
    /// farthest slot so far. It is not inlined, so that scenes whose names are in the caches pay
    /// only for a comparison.
    #[inline(never)]
    fn prefetch_beyond(&mut self, block: &Block<'_>) {
        let farthest = block.codes().last().map_or(0, |code| code >> 4) as usize;
        let end = self.names.by_slot.len().min(farthest + PREFETCH_DISTANCE);
        let mut slot = self.prefetched.max(end.saturating_sub(2 * PREFETCH_DISTANCE));
        while slot < end {
            prefetch(&self.names.by_slot[slot]);
            slot += NAMES_PER_LINE;
        }
        self.prefetched = slot;
    }

    /// Lists the first `found` hits.
    #[inline(always)]
    fn append<L: Lanes>(&mut self, l: L, found: usize, hits: HitSlots) {
        let listed = self.out.len();
        self.name(l, found, hits);
        if let Some(filter) = self.filter {
            self.keep_passing(listed, filter);
        }
        // A list for which there is no memory has lost what it had.
        self.counters.hits += self.out.len().saturating_sub(listed) as u64;
        if self.out.len() >= self.flush.enough {
            (self.flush.call)(self.out);
        }
    }

    /// Lists all hits, a vector at a time. Results in lanes after the last hit are overwritten by
    /// the next pairs.
    #[inline(always)]
    fn name<L: Lanes>(&mut self, l: L, found: usize, hits: HitSlots) {
        let (first, second) = self.out.room(found);
        let mut start = 0;
        while start < found {
            let hit = l.load_u32(&self.hits.0[start..]);
            let entries = hits.entries(l, hit, self.names.by_slot);
            let [lower, higher] = self.names.listed(l, hits, hit, entries);
            l.store_u32(lower, &mut first[start..]);
            l.store_u32(higher, &mut second[start..]);
            start += L::WIDTH;
        }
        self.out.advance(found);
    }

    /// Drops those listed from this one on that don't pass the filter. Apart, so that the common
    /// case stays small.
    #[inline(never)]
    fn keep_passing(&mut self, listed: usize, filter: PairFilter<'_>) {
        let body_of = |name: u32| self.names.body_of(name);
        self.out.keep_from(listed, |[a, b]| filter.passes(body_of(a), body_of(b)));
    }
}
