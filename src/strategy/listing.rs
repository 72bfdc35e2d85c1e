//! The first volume test: candidates in, a list of pairs out.

use std::ops::Range;

use super::Totals;
#[cfg(feature = "shapes")]
use super::hit_names::PairNames;
use super::hit_names::{HitNames, HitSlots};
use super::output::{Output, TaskOutput};
use super::tasks::{Task, Tasks, split_work};
#[cfg(feature = "shapes")]
use super::{Inputs, Scratch};
use crate::bodies::PairFilter;
use crate::broad_phase::{Block, EndSlots, FirstTest, MOST_CANDIDATES, PairFinder, SlotTest};
use crate::counters::VolumeCounters;
use crate::overlap::boxes::CubeTest;
#[cfg(feature = "shapes")]
use crate::overlap::{intervals::IntervalSlots, sphere::Spheres};
use crate::pairs::PairList;
#[cfg(feature = "shapes")]
use crate::settings::TestedVolume;
use crate::simd::{CACHE_LINE, Kernel, Lanes, MAX_WIDTH, Tier, dispatch, prefetch};
use crate::threads::{Executor, Threads};

/// Slots of a run that are tested at once, before their hits are listed.
const SLOTS_PER_TEST: usize = MOST_CANDIDATES;

/// How many slots after the farthest slot of a block names are prefetched: about twenty blocks
/// ahead of their use.
const PREFETCH_DISTANCE: usize = 256;

/// The most names that fit into the second-level cache. With fewer, prefetching only costs time.
const NAMES_IN_CACHE: usize = 1 << 16;

/// Names in a cache line.
const NAMES_PER_LINE: usize = CACHE_LINE / size_of::<u32>();

/// The first volume test of a strategy.
#[derive(Clone, Copy)]
enum FirstVolume<'a> {
    /// Spheres in slot order.
    #[cfg(feature = "shapes")]
    Spheres(crate::broad_phase::SlotBodies<'a>),
    /// World-aligned slabs.
    #[cfg(feature = "shapes")]
    Intervals(&'a IntervalSlots),
    /// No test: every candidate passes.
    #[cfg(feature = "shapes")]
    PassAll,
    /// Boxes that were given by the caller.
    Boxes(BoxTest<'a>),
}

/// How given boxes are tested.
#[derive(Clone, Copy)]
pub(crate) enum BoxTest<'a> {
    /// Given boxes, tested by the cubes around and inside them.
    Cubes(CubeTest<'a>),
    /// Given boxes, tested by their ends.
    Ends(&'a EndSlots),
}

/// The candidates of a frame, the test that they must pass, and what is listed for those that pass.
#[derive(Clone, Copy)]
pub(super) struct Listing<'a> {
    tier: Tier,
    finder: &'a PairFinder,
    first: FirstVolume<'a>,
    names: HitNames<'a>,
    /// Which pairs pass after the first test, where not all do.
    filter: Option<PairFilter<'a>>,
}

impl<'a> Listing<'a> {
    #[cfg(feature = "shapes")]
    pub(super) fn new(inputs: Inputs<'a>, listed: PairNames) -> Self {
        let arranged = inputs.arranged;
        let first = match inputs.setup.scheme.first {
            None => FirstVolume::PassAll,
            Some(TestedVolume::Sphere) => FirstVolume::Spheres(arranged.slots),
            Some(_) => FirstVolume::Intervals(inputs.volumes.intervals),
        };
        Self {
            tier: inputs.executor.tier,
            finder: arranged.finder,
            first,
            names: HitNames::new(arranged.finder, listed, arranged.names),
            filter: arranged.filter,
        }
    }

    /// Lists the pairs that pass the first test, for some parts of the finder's work, and counts
    /// tests and hits. `flush` gets the list whenever it has at least `enough` pairs.
    pub(super) fn run(
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

/// Reports the pairs that pass the first test.
#[cfg(feature = "shapes")]
pub(super) fn flow(inputs: Inputs<'_>, scratch: &mut Scratch, output: Output<'_>) -> Totals {
    list(inputs, PairNames::Bodies, &mut scratch.tasks, output)
}

/// Lists the pairs that pass the first test, on all threads.
#[cfg(feature = "shapes")]
pub(super) fn list(
    inputs: Inputs<'_>,
    listed: PairNames,
    tasks: &mut Tasks,
    output: Output<'_>,
) -> Totals {
    list_parts(Listing::new(inputs, listed), inputs.executor.pool, tasks, output)
}

/// Boxes that are arranged in slots, and how they are tested.
#[derive(Clone, Copy)]
pub(crate) struct BoxInputs<'a> {
    pub executor: Executor<'a>,
    pub finder: &'a PairFinder,
    pub test: BoxTest<'a>,
    /// Which pairs pass if their boxes meet, where not all do.
    pub filter: Option<PairFilter<'a>>,
}

/// Lists the pairs of boxes that meet, by their names, on all threads.
pub(crate) fn list_boxes(
    inputs: BoxInputs<'_>,
    tasks: &mut Tasks,
    output: Output<'_>,
) -> VolumeCounters {
    let listing = Listing {
        tier: inputs.executor.tier,
        finder: inputs.finder,
        first: FirstVolume::Boxes(inputs.test),
        names: HitNames::bodies(inputs.finder),
        filter: inputs.filter,
    };
    list_parts(listing, inputs.executor.pool, tasks, output).first
}

fn list_parts(
    listing: Listing<'_>,
    pool: &Threads,
    tasks: &mut Tasks,
    output: Output<'_>,
) -> Totals {
    let work = |parts: Range<usize>, task: &mut Task, outlet: &TaskOutput<'_, '_>| {
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

struct ListParts<'a> {
    listing: Listing<'a>,
    parts: Range<usize>,
    out: &'a mut PairList,
    flush: FlushRule<'a>,
}

impl Kernel for ListParts<'_> {
    type Output = VolumeCounters;
    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> VolumeCounters {
        match self.listing.first {
            #[cfg(feature = "shapes")]
            FirstVolume::Spheres(slots) => self.with(l, &Spheres(slots)),
            #[cfg(feature = "shapes")]
            FirstVolume::Intervals(intervals) => self.with(l, intervals),
            #[cfg(feature = "shapes")]
            FirstVolume::PassAll => self.with(l, &PassAll),
            FirstVolume::Boxes(BoxTest::Cubes(cubes)) => self.with(l, &cubes),
            FirstVolume::Boxes(BoxTest::Ends(ends)) => self.with(l, ends),
        }
    }
}

impl ListParts<'_> {
    #[inline(always)]
    fn with<L: Lanes>(self, l: L, test: &impl SlotTest) -> VolumeCounters {
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

/// A test that every candidate passes.
#[cfg(feature = "shapes")]
struct PassAll;

#[cfg(feature = "shapes")]
impl SlotTest for PassAll {
    #[inline(always)]
    fn run<L: Lanes>(&self, _: L, _: usize, run: Range<usize>, hits: &mut [u32]) -> usize {
        for (hit, slot) in hits.iter_mut().zip(run.clone()) {
            *hit = slot as u32;
        }
        run.len()
    }
    #[inline(always)]
    fn block<L: Lanes>(&self, _: L, block: &Block<'_>, hits: &mut [u32]) -> usize {
        let codes = block.codes();
        hits[..codes.len()].copy_from_slice(codes);
        codes.len()
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
