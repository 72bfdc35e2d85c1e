//! Choices by name: pair finders, strategies and the other settings of a culler.

mod cull;
mod directions;
mod scheme;
#[cfg(feature = "serde")]
mod text;

pub use crate::choice::UnknownChoice;
use crate::choice::choices;
pub use cull::{
    Budget, CullSettings, Interest, Order, Overlap, SettingsError, Strategy, Updates, ViewCone,
};
pub use directions::DirectionSet;
pub(crate) use directions::K26;
pub use scheme::{Flow, Scheme, TestedVolume};

/// Whether the target has a clock. Without one seconds are 0, and a budget of time is an error.
pub(crate) const HAS_CLOCK: bool = !cfg!(all(target_family = "wasm", target_os = "unknown"));

choices! {
    /// Pair finders: how candidate pairs for the first volume test are found. All report the same
    /// pairs.
    Finder, "pair finder", {
        /// All N(N−1)/2 pairs, as in the paper, except those of two static bodies.
        AllPairs = "all-pairs",
        /// Uniform cells, filled by a counting sort.
        Grid = "grid",
        /// Sweep and prune along one axis.
        Sweep = "sweep",
        /// Lists of neighbours within a skin, kept over frames until a body has moved by its skin.
        Neighbours = "neighbours",
        /// Picked from the number and sizes of the bodies.
        Auto = "auto",
    }
}

choices! {
    /// How an or-DOP's axes are chosen.
    Axes, "axes", {
        /// Principal axes of the convex hull's surface.
        Principal = "principal",
        /// The mesh's own x, y, z.
        Model = "model",
    }
}
