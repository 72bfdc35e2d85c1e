//! The worlds that live through histories, and what happens to their bodies.

use super::{rows, variants};
use sdop::choice::choices;
use sdop::settings::{CullSettings, Overlap, Strategy};

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

/// The strategies of periodic worlds of meshes. Their images are bodies like others, so that the
/// rest follow from worlds without periods.
pub const PERIODIC: [Strategy; 2] = [Strategy::Sphere, Strategy::SDopSequential];

/// Every world that lives through histories.
#[must_use]
pub fn every_world() -> Vec<WorldKind> {
    let rows = variants().next().map(rows).unwrap_or_default();
    let worlds = [WorldKind::Boxes].into_iter().chain(rows.iter().map(WorldKind::of));
    let worlds = worlds.chain([WorldKind::PeriodicBoxes]);
    let worlds = worlds.chain(PERIODIC.map(WorldKind::PeriodicMeshes));
    let culling = Strategy::ALL.iter().filter(|strategy| strategy.scheme().culls());
    let worlds = worlds.chain(culling.map(|&strategy| WorldKind::Compounds(strategy)));
    worlds.chain([WorldKind::AskedBoxes, WorldKind::AskedMeshes]).collect()
}

/// A strategy with its overlap test, as tables call it.
#[must_use]
pub fn strategy_name(strategy: Strategy, overlap: Option<Overlap>) -> String {
    overlap.map_or_else(|| strategy.to_string(), |overlap| format!("{strategy} {overlap}"))
}
