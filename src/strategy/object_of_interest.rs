//! S-DOP for an object of interest (paper, section 4c): pairs with a body of interest are refined, the rest is left to
//! the spheres.

use super::Stage;
use super::listing::First;
use super::sequential::flow;
use super::workers::add;

pub(super) fn cull(stage: &mut Stage<'_>) {
    let done = flow(stage, First::Sphere, Some(stage.interest));
    add(&mut stage.counters.sphere, done.first);
    add(&mut stage.counters.ordop, done.refined);
}
