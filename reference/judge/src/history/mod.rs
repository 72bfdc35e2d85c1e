//! Histories of long-lived worlds: frames in which a few bodies are inserted, removed, moved, put
//! to rest, woken, fixed or changed. After each frame, a world's pairs are compared with the exact
//! answers and with those of a newly built world, and its events with the difference of its lists.
//! Worlds in which space repeats and worlds that are asked instead of culled live through the same
//! histories, and worlds of compounds through histories of robots whose parts touch.

mod compounds;
pub mod contestant;
mod draw;
pub mod frames;
mod judge;
mod periodic;
mod places;
mod queries;
mod robots;
mod state;
#[cfg(test)]
mod tests;
mod worlds;

pub use compounds::judge_compounds;
pub use draw::{draw_boxes, draw_meshes, history_shapes};
pub use judge::{judge_boxes, judge_meshes};
pub use periodic::{Repeated, judge_periodic_boxes, judge_periodic_meshes};
pub(crate) use queries::{Asked, AskedWorld};
pub use queries::{judge_queries_of_boxes, judge_queries_of_meshes};
pub use robots::Robots;
pub(crate) use worlds::{CompoundWorld, JudgedWorld, Listing, ReportedPair};

use crate::configuration::world_kind::{ChangeKind, WorldKind};
use crate::draw::forms::FormError;
use crate::truth::reference_shapes::InvalidInput;
use sdop::ThreadsError;
use sdop::compound::CompoundError;
use sdop::mesh::MeshError;
use sdop::periodic::PeriodicError;
use sdop::query::QueryError;
use sdop::volume::VolumeError;
use sdop::world::{SnapshotError, WorldError};

/// The error of a history that can't be judged.
#[derive(Debug, thiserror::Error)]
pub enum HistoryError {
    /// What a world refuses.
    #[error(transparent)]
    World(#[from] WorldError),
    /// A state that a world refuses.
    #[error(transparent)]
    Snapshot(#[from] SnapshotError),
    /// What a periodic world refuses.
    #[error(transparent)]
    Periodic(#[from] PeriodicError),
    /// Parts that no compound can have.
    #[error(transparent)]
    Compound(#[from] CompoundError),
    /// Threads that the system refuses.
    #[error(transparent)]
    Threads(#[from] ThreadsError),
    /// Volumes that no query can have.
    #[error(transparent)]
    Query(#[from] QueryError),
    /// A form that can't be built.
    #[error(transparent)]
    Form(#[from] FormError),
    /// A mesh that can't be built.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A mesh that has no volumes.
    #[error(transparent)]
    Volume(#[from] VolumeError),
    /// Numbers that the reference refuses.
    #[error(transparent)]
    Input(#[from] InvalidInput),
}

/// A change; bodies are numbered in the order of their insertion.
#[derive(Clone, Debug, PartialEq)]
pub enum Change<B> {
    /// The next number.
    Insert(B),
    /// This one leaves.
    Remove(usize),
    /// This one has these properties now.
    Set(usize, B),
    /// Two are excluded (true) or included again.
    Exclude([usize; 2], bool),
    /// These are of interest.
    Interest(Vec<usize>),
    /// The state is saved.
    Save,
    /// The bodies are those of the saved state, with their numbers.
    Restore,
    /// Something that changes no pair.
    Detour(ChangeKind),
}

/// What happens to the bodies of a world.
#[derive(Clone, Debug)]
pub struct History<B> {
    /// The bodies at first.
    pub first: Vec<B>,
    /// The changes of each frame, with their kinds.
    pub frames: Vec<Vec<(ChangeKind, Change<B>)>>,
}
