//! S-DOP in batches (paper, section 4b): the potentially colliding set is listed first, then its or-DOPs are tested.

use super::{Refine, Stage, sphere};
use crate::cost::{Seconds, VolumeCounters};
use crate::pairs::PairList;
use crate::simd::{Kernel, Lanes, dispatch};

pub(super) fn cull(stage: &mut Stage<'_>) {
    list_spheres(stage);
    let pairs = [stage.candidates.first(), stage.candidates.second()];
    let refinement = Refinement {
        refine: &mut stage.refine,
        pairs,
        counters: &mut stage.counters.ordop,
        seconds: stage.seconds,
        out: stage.out,
    };
    dispatch(stage.level, refinement);
}

/// Fills the stage's candidates with the potentially colliding set.
pub(super) fn list_spheres(stage: &mut Stage<'_>) {
    let tests = sphere::list(stage.level, stage.finder, stage.spheres, stage.candidates);
    stage.counters.sphere.tests += tests;
    stage.counters.sphere.hits += stage.candidates.len() as u64;
}

/// The or-DOP test of a list.
pub(super) struct Refinement<'a, 'b> {
    pub refine: &'a mut Refine<'b>,
    pub pairs: [&'a [u32]; 2],
    pub counters: &'a mut VolumeCounters,
    pub seconds: &'a mut Seconds,
    pub out: &'a mut PairList,
}

impl Kernel for Refinement<'_, '_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        self.refine
            .test(l, self.pairs, self.counters, self.seconds, self.out);
    }
}
