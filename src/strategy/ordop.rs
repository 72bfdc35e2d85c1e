//! Oriented volumes alone, no sphere stage: every candidate pair goes to the or-DOP test (the box is an or-DOP of k = 6).

use super::Stage;
use super::listing::First;
use super::sequential::flow;
use super::workers::add;
use crate::cost::VolumeCounters;

pub(super) fn cull(stage: &mut Stage<'_>, mut counters: VolumeCounters) -> VolumeCounters {
    let done = flow(stage, First::Every, None);
    add(&mut counters, done.refined);
    counters
}
