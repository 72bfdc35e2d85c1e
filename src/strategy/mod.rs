//! The paper's strategies (section 4) and the homogeneous volumes they are judged against, one file each.
//!
//! A strategy takes updated volumes and a pair finder and leaves the reported pairs. Strategies differ in false positives
//! and time, never in misses: each reports every pair whose meshes meet, `none` excepted.

use std::time::Instant;

use crate::broad_phase::AllPairs;
use crate::cost::{Counters, Seconds, VolumeCounters};
use crate::overlap::intervals::IntervalSlots;
use crate::overlap::ordop::{OrDopColumns, SlabTables};
use crate::overlap::sphere::SphereSlots;
use crate::pairs::PairList;
use crate::scene::bodies::Bodies;
use crate::scene::settings::{Budget, Order, Overlap, Strategy};
use crate::simd::Level;
use crate::update::{OrDopRows, ShapeFrame};

mod batch;
mod interest;
mod intervals;
mod object_of_interest;
mod ordop;
mod sequential;
mod sphere;
mod time_critical;

pub(crate) use interest::mark;
pub(crate) use time_critical::Memory;

/// Pairs that flow through the or-DOP test at once where no list is kept: few enough for the first-level cache, enough to
/// make the clock's cost vanish.
pub(crate) const BLOCK: usize = 256;

/// One frame's work, after the eager updates.
pub(crate) struct Stage<'a> {
    pub level: Level,
    pub finder: &'a AllPairs,
    pub spheres: &'a SphereSlots,
    pub intervals: &'a IntervalSlots,
    pub refine: Refine<'a>,
    /// Whether each body is of interest.
    pub interest: &'a [bool],
    pub budget: Option<Budget>,
    pub order: Order,
    pub memory: &'a mut Memory,
    /// The potentially colliding set, or the block in flight.
    pub candidates: &'a mut PairList,
    /// Scratch for the part of a block that is refined.
    pub selected: &'a mut PairList,
    pub counters: &'a mut Counters,
    pub seconds: &'a mut Seconds,
    pub out: &'a mut PairList,
}

/// Runs a strategy on one frame.
pub(crate) fn cull(strategy: Strategy, stage: &mut Stage<'_>) {
    match strategy {
        Strategy::None => {}
        Strategy::Sphere => sphere::cull(stage),
        Strategy::OrDop => stage.counters.ordop = ordop::cull(stage, stage.counters.ordop),
        Strategy::Obb => stage.counters.obb = ordop::cull(stage, stage.counters.obb),
        Strategy::SDopSequential => sequential::cull(stage),
        Strategy::SDopBatch => batch::cull(stage),
        Strategy::SDopObjectOfInterest => object_of_interest::cull(stage),
        Strategy::SDopTimeCritical => time_critical::cull(stage),
        Strategy::Aabb => stage.counters.aabb = intervals::cull(stage, stage.counters.aabb),
        Strategy::KDop => stage.counters.kdop = intervals::cull(stage, stage.counters.kdop),
    }
}

/// The or-DOP test with what it needs to update poses lazily.
pub(crate) struct Refine<'a> {
    pub level: Level,
    pub rows: &'a mut OrDopRows,
    pub frames: &'a [ShapeFrame],
    pub bodies: &'a Bodies,
    pub tables: &'a SlabTables,
    pub overlap: Overlap,
    /// Whether rows are made on demand.
    pub lazy: bool,
    pub stamp: u32,
}

impl Refine<'_> {
    /// Tests pairs and appends the survivors to `out`, in list order. A block a call: the dispatch is paid once for all.
    pub fn test(
        &mut self,
        [first, second]: [&[u32]; 2],
        counters: &mut VolumeCounters,
        seconds: &mut Seconds,
        out: &mut PairList,
    ) {
        let start = Instant::now();
        if self.lazy {
            for bodies in [first, second] {
                counters.updates +=
                    self.rows
                        .update_missing(self.frames, self.bodies, bodies, self.stamp);
            }
        }
        let updated = Instant::now();
        let columns = OrDopColumns {
            rows: &self.rows.rows,
            shape: &self.bodies.shape,
            tables: self.tables,
            overlap: self.overlap,
        };
        let tested = columns.test_pairs(self.level, first, second, out);
        counters.tests += tested.tests;
        counters.hits += tested.hits;
        seconds.update += (updated - start).as_secs_f64();
        seconds.ordop += updated.elapsed().as_secs_f64();
    }
}
