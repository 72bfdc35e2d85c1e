//! The paper's strategies (section 4) and the single volumes that they are compared with. A row of
//! [`Strategy::scheme`](crate::settings::Strategy::scheme) says which tests a strategy makes; each
//! flow of pairs through the tests is a file here.
//!
//! A strategy takes updated volumes and a pair finder, and produces the reported pairs. Strategies
//! differ in false positives and time, never in misses: each except `none` reports every pair whose
//! meshes meet.

mod batch;
mod first_test;
mod frame;
mod interest;
mod refine;
mod sequential;
mod time_critical;

pub(crate) use frame::{Arrangement, FrameVolumes, Inputs, RowTiming, Scratch, Setup, cull};
pub use interest::PlacedCone;
pub(crate) use interest::mark;
pub(crate) use time_critical::RefinementRanks;

use crate::update::RowWindow;

/// A task, with the rows that are computed where they are tested.
type Task = crate::listing::Task<RowWindow>;
type Tasks = crate::listing::Tasks<RowWindow>;
