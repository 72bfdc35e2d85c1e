//! Histories of long-lived worlds: frames in which a few bodies are inserted, removed, moved, put
//! to rest, woken, fixed or changed. After each frame, a world's pairs are compared with the exact
//! answers and with those of a newly built world, and its events with the difference of its lists.
//! Worlds in which space repeats and worlds that are asked instead of culled live through the same
//! histories, and worlds of compounds through histories of robots whose parts touch.

mod compounds;
mod draw;
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
pub(crate) use judge::culler;
pub use judge::{judge_boxes, judge_meshes};
pub use periodic::{Repeated, judge_periodic_boxes, judge_periodic_meshes};
pub(crate) use queries::{Asked, AskedWorld};
pub use queries::{judge_queries_of_boxes, judge_queries_of_meshes};
pub use robots::Robots;
pub(crate) use worlds::{CompoundWorld, JudgedWorld, Listing, ReportedPair};

use super::coverage::strategy_name;
use super::forms::FormError;
use super::reference_shapes::InvalidInput;
use sdop::ThreadsError;
use sdop::choice::choices;
use sdop::compound::CompoundError;
use sdop::mesh::MeshError;
use sdop::periodic::PeriodicError;
use sdop::query::QueryError;
use sdop::settings::{CullSettings, Overlap, Strategy};
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

choices! {
    /// What happens to a body, or to two.
    ChangeKind, "kind of change", {
        /// The world saves its state.
        Saved = "saved",
        /// A new body.
        Inserted = "inserted",
        /// A body leaves.
        Removed = "removed",
        /// Another pose, or other ends.
        Moved = "moved",
        /// A dynamic or fixed body is put to rest.
        Rested = "rested",
        /// A resting body becomes dynamic.
        Woken = "woken",
        /// A body is fixed.
        Fixed = "fixed",
        /// Other groups.
        Regrouped = "regrouped",
        /// Another contact margin.
        Margin = "margin",
        /// Another shape.
        Reshaped = "reshaped",
        /// Two bodies are excluded, or included again.
        Excluded = "excluded",
        /// Other bodies are of interest.
        Interest = "interest",
        /// The world goes on as its clone.
        Cloned = "cloned",
        /// It gives back the memory that it doesn't need.
        Shrunk = "shrunk",
        /// It is culled in portions and up to a limit.
        Limited = "limited",
        /// It goes back to the state that it has saved, or another world does in its place.
        Restored = "restored",
    }
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

/// The world that is judged: given boxes, meshes by a strategy with an overlap test, both in space
/// that may repeat, compounds, or what an index answers about boxes and meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum WorldKind {
    /// A `BoxWorld`.
    Boxes,
    /// A `World`.
    Meshes(Strategy, Option<Overlap>),
    /// A `PeriodicBoxes`.
    PeriodicBoxes,
    /// A `PeriodicWorld`, with the default overlap test.
    PeriodicMeshes(Strategy),
    /// A `World` with a `PartCuller`, with the default overlap test.
    Compounds(Strategy),
    /// A `QueryIndex` of a `BoxWorld`.
    AskedBoxes,
    /// A `QueryIndex` of a `World`.
    AskedMeshes,
}

impl WorldKind {
    /// The world that culls meshes in this way.
    #[must_use]
    pub fn of(way: &CullSettings) -> Self {
        let has_test = way.strategy.scheme().has_overlap_test();
        Self::Meshes(way.strategy, has_test.then_some(way.overlap))
    }

    /// Whether its bodies can change in this way.
    #[must_use]
    pub fn has(self, change: ChangeKind) -> bool {
        let is_of_meshes =
            matches!(change, ChangeKind::Margin | ChangeKind::Reshaped | ChangeKind::Interest);
        let is_of_worlds = matches!(change, ChangeKind::Shrunk | ChangeKind::Limited);
        match self {
            Self::Boxes | Self::AskedBoxes => !is_of_meshes,
            Self::PeriodicBoxes => !is_of_meshes && !is_of_worlds,
            Self::Meshes(..) | Self::Compounds(_) => true,
            Self::AskedMeshes => change != ChangeKind::Interest,
            Self::PeriodicMeshes(_) => change != ChangeKind::Interest && !is_of_worlds,
        }
    }

    /// What tables call it.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Boxes => "given boxes".to_owned(),
            Self::Meshes(strategy, overlap) => strategy_name(strategy, overlap),
            Self::PeriodicBoxes => "periodic boxes".to_owned(),
            Self::PeriodicMeshes(strategy) => format!("periodic {strategy}"),
            Self::Compounds(strategy) => format!("compounds {strategy}"),
            Self::AskedBoxes => "queries of boxes".to_owned(),
            Self::AskedMeshes => "queries of meshes".to_owned(),
        }
    }
}

/// Every world that lives through histories; those of meshes cull by these rows.
#[must_use]
pub fn every_world(rows: &[CullSettings]) -> Vec<WorldKind> {
    let worlds = [WorldKind::Boxes].into_iter().chain(rows.iter().map(WorldKind::of));
    let worlds = worlds.chain([WorldKind::PeriodicBoxes]);
    let worlds = worlds.chain(periodic::STRATEGIES.map(WorldKind::PeriodicMeshes));
    let worlds = worlds.chain(compounds::strategies().map(WorldKind::Compounds));
    worlds.chain([WorldKind::AskedBoxes, WorldKind::AskedMeshes]).collect()
}
