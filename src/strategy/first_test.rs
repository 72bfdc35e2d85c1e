//! The first volume test of each strategy.

use std::ops::Range;

use super::{Inputs, Scratch, Tasks};
use crate::broad_phase::{Block, SlotBodies, SlotTest};
use crate::counters::VolumeCounters;
use crate::listing::{self, FirstVolume, HitNames, ListParts, Listing, Output, PairNames, Totals};
use crate::overlap::{intervals::IntervalSlots, sphere::Spheres};
use crate::settings::TestedVolume;
use crate::simd::Lanes;

/// The volumes of a strategy's first test.
#[derive(Clone, Copy)]
pub(super) enum FirstVolumeTest<'a> {
    /// Spheres in slot order.
    Spheres(SlotBodies<'a>),
    /// World-aligned slabs.
    Intervals(&'a IntervalSlots),
    /// No test: every candidate passes.
    PassAll,
}

impl FirstVolume for FirstVolumeTest<'_> {
    #[inline(always)]
    fn list<L: Lanes>(self, l: L, parts: ListParts<'_, Self>) -> VolumeCounters {
        match self {
            Self::Spheres(slots) => parts.with(l, &Spheres(slots)),
            Self::Intervals(intervals) => parts.with(l, intervals),
            Self::PassAll => parts.with(l, &PassAll),
        }
    }
}

/// The candidates of a frame, and the strategy's first test.
pub(super) fn listing(inputs: Inputs<'_>, listed: PairNames) -> Listing<'_, FirstVolumeTest<'_>> {
    let arranged = inputs.arranged;
    let first = match inputs.setup.scheme.first {
        None => FirstVolumeTest::PassAll,
        Some(TestedVolume::Sphere) => FirstVolumeTest::Spheres(arranged.slots),
        Some(_) => FirstVolumeTest::Intervals(inputs.volumes.intervals),
    };
    Listing {
        tier: inputs.executor.tier,
        finder: arranged.finder,
        first,
        names: HitNames::new(arranged.finder, listed, arranged.names),
        filter: arranged.filter,
    }
}

/// Reports the pairs that pass the first test.
pub(super) fn flow(inputs: Inputs<'_>, scratch: &mut Scratch, output: Output<'_>) -> Totals {
    list(inputs, PairNames::Bodies, &mut scratch.tasks, output)
}

/// Lists the pairs that pass the first test, on all threads.
pub(super) fn list(
    inputs: Inputs<'_>,
    listed: PairNames,
    tasks: &mut Tasks,
    output: Output<'_>,
) -> Totals {
    listing::list(listing(inputs, listed), inputs.executor.pool, tasks, output)
}

/// A test that every candidate passes.
struct PassAll;

impl SlotTest for PassAll {
    #[inline(always)]
    fn run<L: Lanes>(&self, _: L, _: usize, run: Range<usize>, hits: &mut [u32]) -> usize {
        for (hit, slot) in hits.iter_mut().zip(run.clone()) {
            *hit = slot as u32;
        }
        run.len()
    }
    #[inline(always)]
    fn block<L: Lanes>(&self, _: L, block: &Block<'_>, hits: &mut [u32]) -> usize {
        let codes = block.codes();
        hits[..codes.len()].copy_from_slice(codes);
        codes.len()
    }
}
