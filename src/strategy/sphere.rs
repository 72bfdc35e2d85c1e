//! Bounding spheres alone.

use super::Stage;
use super::listing::First;
use super::workers::add;

pub(super) fn cull(stage: &mut Stage<'_>) {
    let done = stage.list(First::Sphere);
    add(&mut stage.counters.sphere, done.first);
}
