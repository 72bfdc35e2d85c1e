//! S-DOP in batches (paper, section 4b): the potentially colliding set is listed first, then its or-DOPs are tested.

use super::{Stage, sphere};

pub(super) fn cull(stage: &mut Stage<'_>) {
    list_spheres(stage);
    let pairs = [stage.candidates.first(), stage.candidates.second()];
    let counters = &mut stage.counters.ordop;
    stage.refine.test(pairs, counters, stage.seconds, stage.out);
}

/// Fills the stage's candidates with the potentially colliding set.
pub(super) fn list_spheres(stage: &mut Stage<'_>) {
    let tests = sphere::list(stage.level, stage.finder, stage.spheres, stage.candidates);
    stage.counters.sphere.tests += tests;
    stage.counters.sphere.hits += stage.candidates.len() as u64;
}
