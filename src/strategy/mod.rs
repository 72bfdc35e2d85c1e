//! The paper's strategies (section 4) and the single volumes that they are compared with. A row of
//! [`Strategy::scheme`](crate::settings::Strategy::scheme) says which tests a strategy makes; each
//! flow of pairs through the tests is a file here.
//!
//! A strategy takes updated volumes and a pair finder, and produces the reported pairs. Strategies
//! differ in false positives and time, never in misses: each except `none` reports every pair whose
//! meshes meet.

use crate::counters::VolumeCounters;

#[cfg(feature = "shapes")]
mod batch;
#[cfg(feature = "shapes")]
mod frame;
mod hit_names;
#[cfg(feature = "shapes")]
mod interest;
mod listing;
mod output;
#[cfg(feature = "shapes")]
mod refine;
#[cfg(feature = "shapes")]
mod sequential;
mod tasks;
#[cfg(feature = "shapes")]
mod time_critical;

#[cfg(feature = "shapes")]
pub(crate) use frame::{Arrangement, FrameVolumes, Inputs, RowTiming, Scratch, Setup, cull};
#[cfg(feature = "shapes")]
pub use interest::PlacedCone;
#[cfg(feature = "shapes")]
pub(crate) use interest::mark;
pub(crate) use listing::{BoxInputs, BoxTest, list_boxes};
pub(crate) use output::Output;
pub(crate) use tasks::Tasks;
#[cfg(feature = "shapes")]
pub(crate) use time_critical::RefinementRanks;

/// What the names of the finder's slots are.
///
/// Volumes other than spheres are looked up by place. With spheres alone, names are bodies, so that
/// hits need not be looked up by place: naming slots by place under every strategy took 2.5 % more
/// instructions per frame of spheres (10,000 bodies, grid, AVX2).
#[cfg(feature = "shapes")]
#[derive(Clone, Copy)]
pub(crate) enum SlotNames<'a> {
    /// Bodies, in the order of the user's columns.
    Bodies,
    /// Places; these are the bodies in them.
    Places(&'a [u32]),
    /// The slots themselves: places have the order of slots, and these are the bodies in them.
    Slots(&'a [u32]),
}

/// The counts and times of culling a frame.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Totals {
    /// The counters of the first test.
    pub first: VolumeCounters,
    /// The counters of the refining test, with lazily computed rows as updates.
    pub refining: VolumeCounters,
    /// Pairs reported untested because the budget had ended.
    #[cfg(feature = "shapes")]
    pub untested: u64,
    /// Wall time of the refining test: its seconds divided by the number of threads.
    pub refining_seconds: f64,
    /// Wall time of computing rows lazily.
    pub update_seconds: f64,
}
