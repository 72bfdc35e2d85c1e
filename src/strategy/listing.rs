//! Candidates through the first volume test into a list of pairs.

use std::ops::Range;

use super::output::{Outlet, Output};
use super::tasks::{Task, split_work};
use super::{Inputs, Scratch, SlotNames, Totals};
use crate::bodies::Groups;
use crate::broad_phase::{Block, FirstTest, MOST_CANDIDATES, PairFinder};
use crate::counters::VolumeCounters;
use crate::overlap::SlotTest;
use crate::overlap::boxes::{Cubes, EndSlots};
use crate::overlap::intervals::IntervalSlots;
use crate::pairs::PairList;
use crate::settings::TestedVolume;
use crate::simd::{Kernel, Lanes, MAX_WIDTH, Tier, dispatch};
use crate::threads::{Executor, Threads};

/// Slots of a run that are tested before their hits are listed.
const PIECE: usize = MOST_CANDIDATES;

/// The first volume test of a strategy.
#[derive(Clone, Copy)]
enum First<'a> {
    /// Spheres, which the finder has in its slots.
    Spheres,
    /// World-aligned slabs.
    Intervals(&'a IntervalSlots),
    /// None: every candidate passes.
    PassAll,
    /// Given boxes.
    Boxes(BoxTest<'a>),
}

/// How given boxes are tested.
#[derive(Clone, Copy)]
pub(crate) enum BoxTest<'a> {
    /// By cubes about them and within.
    Cubes(Cubes<'a>),
    /// By their ends.
    Ends(&'a EndSlots),
}

/// What is listed of a pair of slots.
#[derive(Clone, Copy)]
pub(super) enum Listed {
    /// Its bodies, the lower first: what is reported.
    Bodies,
    /// Its places, that of the lower body first: what is refined.
    Places,
}

/// The candidates of a frame, the test that they must pass, and what is listed of those that do.
#[derive(Clone, Copy)]
pub(super) struct Listing<'a> {
    tier: Tier,
    finder: &'a PairFinder,
    first: First<'a>,
    listed: Listed,
    names: SlotNames<'a>,
    /// Each body's groups where not all collide with all.
    groups: Option<&'a [Groups]>,
}

impl<'a> Listing<'a> {
    pub(super) fn new(inputs: Inputs<'a>, listed: Listed) -> Self {
        let first = match inputs.settings.strategy.scheme().first {
            None => First::PassAll,
            Some(TestedVolume::Sphere) => First::Spheres,
            Some(_) => First::Intervals(inputs.intervals),
        };
        Self {
            tier: inputs.executor.tier,
            finder: inputs.finder,
            first,
            listed,
            names: inputs.names,
            groups: inputs.groups,
        }
    }

    /// Lists the pairs of some parts of the finder's work that pass the first test, and counts tests and hits. `flush`
    /// gets the list whenever it has reached `enough` pairs.
    pub(super) fn run(
        &self,
        parts: Range<usize>,
        out: &mut PairList,
        enough: usize,
        flush: &mut dyn FnMut(&mut PairList),
    ) -> VolumeCounters {
        let flush = Flush {
            enough,
            call: flush,
        };
        dispatch(
            self.tier,
            List {
                listing: *self,
                parts,
                out,
                flush,
            },
        )
    }
}

/// Reports what passes the first test.
pub(super) fn flow(inputs: Inputs<'_>, scratch: &mut Scratch, output: Output<'_>) -> Totals {
    list(inputs, Listed::Bodies, &mut scratch.tasks, output)
}

/// Lists what passes the first test, on all threads.
pub(super) fn list(
    inputs: Inputs<'_>,
    listed: Listed,
    tasks: &mut Vec<Task>,
    output: Output<'_>,
) -> Totals {
    list_parts(
        Listing::new(inputs, listed),
        inputs.executor.pool,
        tasks,
        output,
    )
}

/// Given boxes that are arranged in slots, and how they are tested.
#[derive(Clone, Copy)]
pub(crate) struct BoxInputs<'a> {
    pub executor: Executor<'a>,
    pub finder: &'a PairFinder,
    pub test: BoxTest<'a>,
    /// Each box's groups where not all collide with all.
    pub groups: Option<&'a [Groups]>,
}

/// Lists the boxes that meet, by their names, on all threads.
pub(crate) fn list_boxes(
    inputs: BoxInputs<'_>,
    scratch: &mut Scratch,
    output: Output<'_>,
) -> VolumeCounters {
    let listing = Listing {
        tier: inputs.executor.tier,
        finder: inputs.finder,
        first: First::Boxes(inputs.test),
        listed: Listed::Bodies,
        names: SlotNames::Bodies,
        groups: inputs.groups,
    };
    list_parts(listing, inputs.executor.pool, &mut scratch.tasks, output).first
}

fn list_parts(
    listing: Listing<'_>,
    pool: &Threads,
    tasks: &mut Vec<Task>,
    output: Output<'_>,
) -> Totals {
    let work = |parts: Range<usize>, task: &mut Task, outlet: &Outlet<'_, '_>| {
        let flush = &mut |out: &mut PairList| outlet.offer(out);
        task.first = listing.run(parts, &mut task.out, outlet.worth(), flush);
    };
    split_work(pool, tasks, listing.finder.parts(), output, work)
}

/// What is done with a list that has grown long enough.
struct Flush<'a> {
    enough: usize,
    call: &'a mut dyn FnMut(&mut PairList),
}

struct List<'a> {
    listing: Listing<'a>,
    parts: Range<usize>,
    out: &'a mut PairList,
    flush: Flush<'a>,
}

impl Kernel for List<'_> {
    type Output = VolumeCounters;
    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> VolumeCounters {
        let finder = self.listing.finder;
        match self.listing.first {
            First::Spheres => self.with(l, finder.slots()),
            First::Intervals(intervals) => self.with(l, intervals),
            First::PassAll => self.with(l, &PassAll),
            First::Boxes(BoxTest::Cubes(cubes)) => self.with(l, &cubes),
            First::Boxes(BoxTest::Ends(ends)) => self.with(l, ends),
        }
    }
}

impl List<'_> {
    #[inline(always)]
    fn with<L: Lanes>(self, l: L, test: &impl SlotTest) -> VolumeCounters {
        let finder = self.listing.finder;
        let mut lister = Lister {
            test,
            names: &finder.slots().names,
            listing: self.listing,
            out: self.out,
            flush: self.flush,
            counters: VolumeCounters::default(),
            hits: [0; PIECE + MAX_WIDTH],
        };
        finder.find(l, self.parts, &mut lister);
        lister.counters
    }
}

/// The test that every candidate passes.
struct PassAll;

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

/// A first test that lists what passes it.
struct Lister<'a, 'f, T> {
    test: &'a T,
    /// The name of each slot.
    names: &'a [u32],
    listing: Listing<'a>,
    out: &'f mut PairList,
    flush: Flush<'f>,
    counters: VolumeCounters,
    /// Of the piece or block at hand.
    hits: [u32; PIECE + MAX_WIDTH],
}

impl<T: SlotTest> FirstTest for Lister<'_, '_, T> {
    #[cfg_attr(not(unoptimised), inline(always))]
    fn run<L: Lanes>(&mut self, l: L, i: usize, run: Range<usize>) {
        self.counters.tests += run.len() as u64;
        let mut start = run.start;
        while start < run.end {
            let piece = start..run.end.min(start + PIECE);
            start = piece.end;
            let found = self.test.run(l, i, piece, &mut self.hits);
            self.append(found, |slot| (i, slot as usize));
        }
    }

    #[cfg_attr(not(unoptimised), inline(always))]
    fn block<L: Lanes>(&mut self, l: L, block: &Block<'_>) {
        self.counters.tests += block.codes().len() as u64;
        let found = self.test.block(l, block, &mut self.hits);
        let first = block.first();
        self.append(found, |code| {
            (first + (code & 15) as usize, (code >> 4) as usize)
        });
    }
}

impl<T> Lister<'_, '_, T> {
    /// Lists the first `found` hits.
    #[inline(always)]
    fn append(&mut self, found: usize, slots: impl Fn(u32) -> (usize, usize)) {
        let listed = self.out.len();
        if let Some(groups) = self.listing.groups {
            self.append_colliding(found, slots, groups);
        } else {
            self.append_all(found, slots);
        }
        self.counters.hits += (self.out.len() - listed) as u64;
        if self.out.len() >= self.flush.enough {
            (self.flush.call)(self.out);
        }
    }

    #[inline(always)]
    fn append_all(&mut self, found: usize, slots: impl Fn(u32) -> (usize, usize)) {
        let names = |hit: u32| {
            let (i, j) = slots(hit);
            (self.names[i], self.names[j])
        };
        let (first, second) = self.out.room(found);
        let pairs = first.iter_mut().zip(second).zip(&self.hits[..found]);
        match (self.listing.names, self.listing.listed) {
            (SlotNames::Bodies, _) => {
                for ((first, second), &hit) in pairs {
                    let (a, b) = names(hit);
                    (*first, *second) = (a.min(b), a.max(b));
                }
            }
            (SlotNames::Places(body), Listed::Bodies) => {
                for ((first, second), &hit) in pairs {
                    let (i, j) = names(hit);
                    let (a, b) = (body[i as usize], body[j as usize]);
                    (*first, *second) = (a.min(b), a.max(b));
                }
            }
            (SlotNames::Places(body), Listed::Places) => {
                for ((first, second), &hit) in pairs {
                    let (i, j) = names(hit);
                    let swap = body[i as usize] > body[j as usize];
                    (*first, *second) = if swap { (j, i) } else { (i, j) };
                }
            }
        }
        self.out.advance(found);
    }

    /// Lists those hits whose bodies may collide. Apart, so that the common case stays small.
    #[inline(never)]
    fn append_colliding(
        &mut self,
        found: usize,
        slots: impl Fn(u32) -> (usize, usize),
        groups: &[Groups],
    ) {
        let Listing { names, listed, .. } = self.listing;
        let body = |name: u32| match names {
            SlotNames::Bodies => name,
            SlotNames::Places(body) => body[name as usize],
        };
        for &hit in &self.hits[..found] {
            let (i, j) = slots(hit);
            let (i, j) = (self.names[i], self.names[j]);
            let (a, b) = (body(i), body(j));
            if groups[a as usize].collide(groups[b as usize]) {
                let [i, j] = match listed {
                    Listed::Bodies => [a, b],
                    Listed::Places => [i, j],
                };
                let (i, j) = if a > b { (j, i) } else { (i, j) };
                self.out.push(i, j);
            }
        }
    }
}
