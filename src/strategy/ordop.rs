//! Oriented volumes alone, no sphere stage: every candidate pair goes to the or-DOP test (the box is an or-DOP of k = 6).

use std::ops::Range;

use super::{BLOCK, Refine, Stage};
use crate::broad_phase::{AllPairs, RunTest};
use crate::cost::{Seconds, VolumeCounters};
use crate::pairs::PairList;
use crate::simd::{Kernel, Lanes, dispatch};

pub(super) fn cull(stage: &mut Stage<'_>, counters: VolumeCounters) -> VolumeCounters {
    let test = Test {
        body: &stage.spheres.body,
        refine: &mut stage.refine,
        block: stage.candidates,
        out: stage.out,
        counters,
        seconds: stage.seconds,
    };
    dispatch(
        stage.level,
        Flow {
            finder: stage.finder,
            test,
        },
    )
}

struct Flow<'a, 'b> {
    finder: &'a AllPairs,
    test: Test<'a, 'b>,
}

impl Kernel for Flow<'_, '_> {
    type Output = VolumeCounters;
    #[inline(always)]
    fn run<L: Lanes>(mut self, l: L) -> VolumeCounters {
        self.finder.find(l, &mut self.test);
        self.test.drain();
        self.test.counters
    }
}

struct Test<'a, 'b> {
    /// Which body stands in each slot.
    body: &'a [u32],
    refine: &'a mut Refine<'b>,
    block: &'a mut PairList,
    out: &'a mut PairList,
    counters: VolumeCounters,
    seconds: &'a mut Seconds,
}

impl Test<'_, '_> {
    fn drain(&mut self) {
        let pairs = [self.block.first(), self.block.second()];
        self.refine
            .test(pairs, &mut self.counters, self.seconds, self.out);
        self.block.clear();
    }
}

impl RunTest for Test<'_, '_> {
    #[inline(always)]
    fn run<L: Lanes>(&mut self, _: L, i: usize, run: Range<usize>) {
        let body_i = self.body[i];
        let (first, second) = self.block.room(run.len());
        for ((first, second), &body_j) in first.iter_mut().zip(second).zip(&self.body[run.clone()])
        {
            (*first, *second) = (body_i.min(body_j), body_i.max(body_j));
        }
        self.block.advance(run.len());
        if self.block.len() >= BLOCK {
            self.drain();
        }
    }
}
