//! S-DOP, sequential (paper, section 4a): a pair whose spheres overlap goes to the or-DOP test at once.
//!
//! "At once" means a block of up to [`BLOCK`] pairs here, since one pair can't fill a vector; no list of the potentially
//! colliding set is kept. The same flow serves the object of interest, where some pairs of the block are not refined.

use std::ops::Range;

use super::{BLOCK, Refine, Stage};
use crate::broad_phase::{AllPairs, RunTest};
use crate::cost::{Counters, Seconds};
use crate::overlap::sphere::SphereSlots;
use crate::pairs::PairList;
use crate::simd::{Kernel, Lanes, dispatch};

pub(super) fn cull(stage: &mut Stage<'_>) {
    flow(stage, None);
}

/// Spheres, then or-DOPs block by block; with `interest`, only for pairs that have a body of interest.
pub(super) fn flow(stage: &mut Stage<'_>, interest: Option<&[bool]>) {
    let test = Test {
        spheres: stage.spheres,
        interest,
        refine: &mut stage.refine,
        block: stage.candidates,
        selected: stage.selected,
        out: stage.out,
        counters: stage.counters,
        seconds: stage.seconds,
    };
    dispatch(
        stage.level,
        Flow {
            finder: stage.finder,
            test,
        },
    );
}

struct Flow<'a, 'b> {
    finder: &'a AllPairs,
    test: Test<'a, 'b>,
}

impl Kernel for Flow<'_, '_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(mut self, l: L) {
        self.finder.find(l, &mut self.test);
        self.test.drain();
    }
}

struct Test<'a, 'b> {
    spheres: &'a SphereSlots,
    interest: Option<&'a [bool]>,
    refine: &'a mut Refine<'b>,
    block: &'a mut PairList,
    selected: &'a mut PairList,
    out: &'a mut PairList,
    counters: &'a mut Counters,
    seconds: &'a mut Seconds,
}

impl Test<'_, '_> {
    fn drain(&mut self) {
        self.counters.sphere.hits += self.block.len() as u64;
        let refined = match self.interest {
            None => &*self.block,
            Some(interest) => {
                self.selected.clear();
                for [i, j] in self.block.iter() {
                    let of_interest = interest[i as usize] || interest[j as usize];
                    let list = if of_interest {
                        &mut *self.selected
                    } else {
                        &mut *self.out
                    };
                    list.push(i, j);
                }
                &*self.selected
            }
        };
        let pairs = [refined.first(), refined.second()];
        self.refine
            .test(pairs, &mut self.counters.ordop, self.seconds, self.out);
        self.block.clear();
    }
}

impl RunTest for Test<'_, '_> {
    #[inline(always)]
    fn run<L: Lanes>(&mut self, l: L, i: usize, run: Range<usize>) {
        self.counters.sphere.tests += run.len() as u64;
        self.spheres.test_run(l, i, run, self.block);
        if self.block.len() >= BLOCK {
            self.drain();
        }
    }
}
