//! S-DOP in batches (paper, section 4b): the potentially colliding set is listed first, then its or-DOPs are tested.

use super::Stage;
use super::listing::First;
use super::workers::add;

pub(super) fn cull(stage: &mut Stage<'_>) {
    let done = stage.list_candidates(First::Sphere);
    add(&mut stage.counters.sphere, done.first);
    let refined = stage.refine_candidates();
    add(&mut stage.counters.ordop, refined);
}
