//! Bounding spheres alone.

use std::ops::Range;

use super::Stage;
use crate::broad_phase::{AllPairs, RunTest};
use crate::overlap::sphere::SphereSlots;
use crate::pairs::PairList;
use crate::simd::{Kernel, Lanes, Level, dispatch};

pub(super) fn cull(stage: &mut Stage<'_>) {
    let tests = list(stage.level, stage.finder, stage.spheres, stage.out);
    stage.counters.sphere.tests += tests;
    stage.counters.sphere.hits += stage.out.len() as u64;
}

/// Lists the pairs whose spheres overlap, the potentially colliding set. Returns the number of tests.
pub(super) fn list(
    level: Level,
    finder: &AllPairs,
    spheres: &SphereSlots,
    out: &mut PairList,
) -> u64 {
    struct List<'a> {
        finder: &'a AllPairs,
        test: ListTest<'a>,
    }
    impl Kernel for List<'_> {
        type Output = u64;
        #[inline(always)]
        fn run<L: Lanes>(mut self, l: L) -> u64 {
            self.finder.find(l, &mut self.test);
            self.test.tests
        }
    }
    dispatch(
        level,
        List {
            finder,
            test: ListTest {
                spheres,
                out,
                tests: 0,
            },
        },
    )
}

struct ListTest<'a> {
    spheres: &'a SphereSlots,
    out: &'a mut PairList,
    tests: u64,
}

impl RunTest for ListTest<'_> {
    #[inline(always)]
    fn run<L: Lanes>(&mut self, l: L, i: usize, run: Range<usize>) {
        self.tests += run.len() as u64;
        self.spheres.test_run(l, i, run, self.out);
    }
}
