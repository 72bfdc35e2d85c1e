//! World-aligned volumes alone: AABB or k-DOP, re-fitted each frame.

use std::ops::Range;

use super::Stage;
use crate::broad_phase::{AllPairs, RunTest};
use crate::cost::VolumeCounters;
use crate::overlap::intervals::IntervalSlots;
use crate::pairs::PairList;
use crate::simd::{Kernel, Lanes, dispatch};

pub(super) fn cull(stage: &mut Stage<'_>, mut counters: VolumeCounters) -> VolumeCounters {
    let test = Test {
        intervals: stage.intervals,
        out: stage.out,
        tests: 0,
    };
    counters.tests += dispatch(
        stage.level,
        List {
            finder: stage.finder,
            test,
        },
    );
    counters.hits += stage.out.len() as u64;
    counters
}

struct List<'a> {
    finder: &'a AllPairs,
    test: Test<'a>,
}

impl Kernel for List<'_> {
    type Output = u64;
    #[inline(always)]
    fn run<L: Lanes>(mut self, l: L) -> u64 {
        self.finder.find(l, &mut self.test);
        self.test.tests
    }
}

struct Test<'a> {
    intervals: &'a IntervalSlots,
    out: &'a mut PairList,
    tests: u64,
}

impl RunTest for Test<'_> {
    #[inline(always)]
    fn run<L: Lanes>(&mut self, l: L, i: usize, run: Range<usize>) {
        self.tests += run.len() as u64;
        self.intervals.test_run(l, i, run, self.out);
    }
}
