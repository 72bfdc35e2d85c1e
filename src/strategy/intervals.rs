//! World-aligned volumes alone: AABB or k-DOP, re-fitted each frame.

use super::Stage;
use super::listing::First;
use super::workers::add;
use crate::cost::VolumeCounters;

pub(super) fn cull(stage: &mut Stage<'_>, mut counters: VolumeCounters) -> VolumeCounters {
    let done = stage.list(First::Intervals(stage.intervals));
    add(&mut counters, done.first);
    counters
}
