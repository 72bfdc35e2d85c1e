//! The paper's strategies (section 4) and the homogeneous volumes they are judged against: which
//! tests each makes is a row of [`Strategy::scheme`](crate::settings::Strategy::scheme), and how
//! pairs flow through them a file here.
//!
//! A strategy takes updated volumes and a pair finder and leaves the reported pairs. Strategies
//! differ in false positives and time, never in misses: each reports every pair whose meshes meet,
//! `none` excepted.

use crate::counters::VolumeCounters;

#[cfg(feature = "shapes")]
mod batch;
#[cfg(feature = "shapes")]
mod frame;
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
#[cfg(all(feature = "shapes", feature = "serde"))]
pub(crate) use time_critical::RefinementRanks;

/// What the finder's slots are named by.
///
/// Volumes other than spheres are looked up by place. With spheres alone, names are bodies, so that
/// no hit needs a look at its places: naming slots by place under every strategy took 2.5 % more
/// instructions of a frame of spheres (10,000 bodies, grid, AVX2).
#[cfg(feature = "shapes")]
#[derive(Clone, Copy)]
pub(crate) enum SlotNames<'a> {
    /// Bodies, in the order of the user's columns.
    Bodies,
    /// Places, in which these bodies are.
    Places(&'a [u32]),
    /// Themselves: places have the order of slots, and these bodies are in them.
    Slots(&'a [u32]),
}

/// What culling a frame took.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Totals {
    /// Of the first test.
    pub first: VolumeCounters,
    /// Of the refining test, with the rows made on demand as updates.
    pub refining: VolumeCounters,
    /// Pairs reported untested because the budget had ended.
    #[cfg(feature = "shapes")]
    pub untested: u64,
    /// Wall time of the refining test: its seconds over the threads.
    pub refining_seconds: f64,
    /// Wall time of making rows on demand.
    pub update_seconds: f64,
}
