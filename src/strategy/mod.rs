//! The paper's strategies (section 4) and the homogeneous volumes they are judged against: [`cull`] says which tests each
//! makes, and a file each how pairs flow through them.
//!
//! A strategy takes updated volumes and a pair finder and leaves the reported pairs. Strategies differ in false positives
//! and time, never in misses: each reports every pair whose meshes meet, `none` excepted.

use crate::bodies::Bodies;
use crate::bodies::Groups;
use crate::bodies::Places;
use crate::broad_phase::PairFinder;
use crate::counters::{Counters, Seconds};
use crate::overlap::intervals::IntervalSlots;
use crate::overlap::ordop::SlabTables;
use crate::pairs::PairList;
use crate::settings::{Budget, Order, Overlap, Strategy};
use crate::simd::Tier;
use crate::threads::Threads;
use crate::update::{OrDopRows, ShapeFrame};

mod batch;
mod interest;
mod listing;
mod refine;
mod sequential;
mod time_critical;
mod workers;

pub(crate) use interest::mark;
pub(crate) use time_critical::Memory;
pub(crate) use workers::Worker;

use listing::First;
use workers::add;

/// Pairs that flow through the or-DOP test at once where no list is kept: few enough for the first-level cache, enough to
/// make the clock's cost vanish.
const BLOCK: usize = 256;

/// One frame's work, after the eager updates.
pub(crate) struct Stage<'a> {
    pub tier: Tier,
    pub pool: &'a Threads,
    pub workers: &'a mut Vec<Worker>,
    pub finder: &'a PairFinder,
    /// Whether the finder's slots are named by place, not by body.
    pub names_are_places: bool,
    pub places: &'a Places,
    /// Each body's groups where not all collide with all.
    pub groups: Option<&'a [Groups]>,
    pub bodies: &'a Bodies,
    pub intervals: &'a IntervalSlots,
    /// Spheres by place.
    pub spheres: &'a [[f32; 4]],
    pub rows: &'a mut OrDopRows,
    pub frames: &'a [ShapeFrame],
    pub tables: &'a SlabTables,
    pub overlap: Overlap,
    /// Whether rows are made on demand.
    pub lazy: bool,
    pub stamp: u32,
    /// Whether each body is of interest.
    pub interest: &'a [bool],
    pub budget: Option<Budget>,
    pub order: Order,
    pub memory: &'a mut Memory,
    /// The potentially colliding set by places, where a list of it is kept.
    pub candidates: &'a mut PairList,
    pub counters: &'a mut Counters,
    pub seconds: &'a mut Seconds,
    pub out: &'a mut PairList,
}

/// Runs a strategy on one frame.
pub(crate) fn cull(strategy: Strategy, stage: &mut Stage<'_>) {
    let (aligned, interest) = (First::Intervals(stage.intervals), Some(stage.interest));
    let done = match strategy {
        Strategy::None => return,
        Strategy::Sphere => stage.list(First::Sphere),
        Strategy::Aabb | Strategy::KDop => stage.list(aligned),
        // The oriented box is an or-DOP of k = 6.
        Strategy::OrDop | Strategy::Obb => sequential::flow(stage, First::Every, None),
        Strategy::SDopSequential => sequential::flow(stage, First::Sphere, None),
        Strategy::SDopBatch => batch::flow(stage, First::Sphere, None),
        Strategy::SDopObjectOfInterest => sequential::flow(stage, First::Sphere, interest),
        Strategy::SDopTimeCritical => time_critical::cull(stage),
    };
    let counters = &mut *stage.counters;
    match strategy {
        Strategy::Aabb => add(&mut counters.aabb, done.first),
        Strategy::KDop => add(&mut counters.kdop, done.first),
        // Nothing is tested before the or-DOPs.
        Strategy::OrDop => add(&mut counters.ordop, done.refined),
        Strategy::Obb => add(&mut counters.obb, done.refined),
        _ => {
            add(&mut counters.sphere, done.first);
            add(&mut counters.ordop, done.refined);
        }
    }
}
