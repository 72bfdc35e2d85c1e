//! Candidates through the first volume test into a list of pairs.

use std::ops::Range;

use super::Stage;
use super::workers::{Done, share};
use crate::bodies::Groups;
use crate::broad_phase::{Block, FirstTest, MOST_CANDIDATES, PairFinder};
use crate::overlap::SlotTest;
use crate::overlap::intervals::IntervalSlots;
use crate::pairs::PairList;
use crate::simd::{Kernel, Lanes, MAX_WIDTH, Tier, dispatch};

/// Slots of a run that are tested before their hits are listed.
const PIECE: usize = MOST_CANDIDATES;

/// The first volume test of a strategy.
#[derive(Clone, Copy)]
pub(super) enum First<'a> {
    /// Spheres.
    Sphere,
    /// World-aligned slabs.
    Intervals(&'a IntervalSlots),
    /// None: every candidate goes on.
    Every,
}

/// What is listed, from which part of the finder's work.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub tier: Tier,
    pub finder: &'a PairFinder,
    pub first: First<'a>,
    /// The body in each place where the slots' names are places.
    pub body: Option<&'a [u32]>,
    /// Each body's groups where not all collide with all.
    pub groups: Option<&'a [Groups]>,
}

impl Source<'_> {
    /// Lists the pairs of some parts that pass the first test. Returns the number of tests.
    pub(super) fn list(&self, parts: Range<usize>, out: &mut PairList) -> u64 {
        self.drained(parts, out, usize::MAX, &mut |_| {})
    }

    /// As [`Self::list`]; `take` gets the list whenever it has reached `at` pairs, and empties it.
    pub(super) fn drained(
        &self,
        parts: Range<usize>,
        out: &mut PairList,
        at: usize,
        take: &mut dyn FnMut(&mut PairList),
    ) -> u64 {
        let drain = Drain { at, take };
        dispatch(
            self.tier,
            List {
                source: *self,
                parts,
                out,
                drain,
            },
        )
    }
}

impl Stage<'_> {
    /// Where this frame's candidates come from.
    pub(super) fn source<'s>(&'s self, first: First<'s>) -> Source<'s> {
        Source {
            tier: self.tier,
            finder: self.finder,
            first,
            body: self.names_are_places.then_some(&self.places.body),
            groups: self.groups,
        }
    }

    /// Reports the pairs that pass the first test.
    pub(super) fn list(&mut self, first: First<'_>) -> Done {
        let mut out = std::mem::take(self.out);
        let done = self.list_into(first, &mut out);
        if self.names_are_places {
            out.rename(0, &self.places.body);
        }
        *self.out = out;
        done
    }

    /// Lists the pairs that pass the first test as candidates, by places.
    pub(super) fn list_candidates(&mut self, first: First<'_>) -> Done {
        let mut candidates = std::mem::take(self.candidates);
        candidates.clear();
        let done = self.list_into(first, &mut candidates);
        *self.candidates = candidates;
        done
    }

    fn list_into(&mut self, first: First<'_>, list: &mut PairList) -> Done {
        let mut workers = std::mem::take(self.workers);
        let source = self.source(first);
        let parts = self.finder.parts();
        let mut done = share(self.pool, &mut workers, parts, list, |parts, worker| {
            worker.first.tests = source.list(parts, &mut worker.out);
        });
        *self.workers = workers;
        done.first.hits = list.len() as u64;
        done
    }
}

struct Drain<'a> {
    at: usize,
    take: &'a mut dyn FnMut(&mut PairList),
}

struct List<'a> {
    source: Source<'a>,
    parts: Range<usize>,
    out: &'a mut PairList,
    drain: Drain<'a>,
}

impl Kernel for List<'_> {
    type Output = u64;
    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> u64 {
        let finder = self.source.finder;
        match self.source.first {
            First::Sphere => self.with(l, finder.slots()),
            First::Intervals(intervals) => self.with(l, intervals),
            First::Every => self.with(l, &Every),
        }
    }
}

impl List<'_> {
    #[inline(always)]
    fn with<L: Lanes>(self, l: L, test: &impl SlotTest) -> u64 {
        let Source {
            finder,
            body,
            groups,
            ..
        } = self.source;
        let mut lister = Lister {
            test,
            names: &finder.slots().names,
            body,
            groups,
            out: self.out,
            drain: self.drain,
            tests: 0,
            hits: [0; PIECE + MAX_WIDTH],
        };
        finder.find(l, self.parts, &mut lister);
        lister.tests
    }
}

/// The test that nothing fails.
struct Every;

impl SlotTest for Every {
    #[inline(always)]
    fn run<L: Lanes>(&self, _: L, _: usize, run: Range<usize>, hits: &mut [u32]) -> usize {
        for (hit, slot) in hits.iter_mut().zip(run.clone()) {
            *hit = slot as u32;
        }
        run.len()
    }
    #[inline(always)]
    fn block<L: Lanes>(&self, _: L, block: &Block, hits: &mut [u32]) -> usize {
        let codes = block.codes();
        hits[..codes.len()].copy_from_slice(codes);
        codes.len()
    }
}

struct Lister<'a, 'd, T> {
    test: &'a T,
    names: &'a [u32],
    body: Option<&'a [u32]>,
    groups: Option<&'a [Groups]>,
    out: &'d mut PairList,
    drain: Drain<'d>,
    tests: u64,
    hits: [u32; PIECE + MAX_WIDTH],
}

impl<T: SlotTest> FirstTest for Lister<'_, '_, T> {
    #[inline(always)]
    fn run<L: Lanes>(&mut self, l: L, i: usize, run: Range<usize>) {
        self.tests += run.len() as u64;
        let mut start = run.start;
        while start < run.end {
            let piece = start..run.end.min(start + PIECE);
            start = piece.end;
            let found = self.test.run(l, i, piece, &mut self.hits);
            self.append(found, |slot| (i, slot as usize));
        }
    }

    #[inline(always)]
    fn block<L: Lanes>(&mut self, l: L, block: &Block) {
        self.tests += block.codes().len() as u64;
        let found = self.test.block(l, block, &mut self.hits);
        let first = block.first();
        self.append(found, |code| {
            (first + (code & 15) as usize, (code >> 4) as usize)
        });
    }
}

impl<T> Lister<'_, '_, T> {
    /// Lists the first `found` hits by name, the lower body first.
    #[inline(always)]
    fn append(&mut self, found: usize, slots: impl Fn(u32) -> (usize, usize)) {
        if let Some(groups) = self.groups {
            self.append_colliding(found, slots, groups);
        } else {
            self.append_all(found, slots);
        }
        if self.out.len() >= self.drain.at {
            (self.drain.take)(self.out);
        }
    }

    #[inline(always)]
    fn append_all(&mut self, found: usize, slots: impl Fn(u32) -> (usize, usize)) {
        let (first, second) = self.out.room(found);
        let pairs = first.iter_mut().zip(second).zip(&self.hits[..found]);
        match self.body {
            None => {
                for ((first, second), &hit) in pairs {
                    let (i, j) = slots(hit);
                    let (i, j) = (self.names[i], self.names[j]);
                    (*first, *second) = (i.min(j), i.max(j));
                }
            }
            Some(body) => {
                for ((first, second), &hit) in pairs {
                    let (i, j) = slots(hit);
                    let (i, j) = (self.names[i], self.names[j]);
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
        let body = |name: u32| self.body.map_or(name, |body| body[name as usize]);
        for &hit in &self.hits[..found] {
            let (i, j) = slots(hit);
            let (i, j) = (self.names[i], self.names[j]);
            let (a, b) = (body(i), body(j));
            if groups[a as usize].collide(groups[b as usize]) {
                let (i, j) = if a > b { (j, i) } else { (i, j) };
                self.out.push(i, j);
            }
        }
    }
}
