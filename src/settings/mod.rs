//! Choices by name: pair finders, and how a scene is culled.

#[cfg(feature = "shapes")]
mod cull;
#[cfg(feature = "shapes")]
mod scheme;
#[cfg(all(feature = "shapes", feature = "serde"))]
mod text;

pub use crate::choice::UnknownChoice;
use crate::choice::choices;
#[cfg(feature = "shapes")]
pub use crate::volume::{Axes, DirectionSet};
#[cfg(feature = "shapes")]
pub use cull::{
    Budget, CullSettings, Interest, Order, Overlap, SettingsError, Strategy, Updates, ViewCone,
};
#[cfg(feature = "shapes")]
pub use scheme::{Flow, Scheme, TestedVolume};

choices! {
    /// Who hands candidate pairs to the first volume test. Every finder leads to the same reported
    /// set.
    Finder, "pair finder", {
        /// The paper's N(N−1)/2 loop without the static–static pairs.
        AllPairs = "all-pairs",
        /// Uniform cells, counting sort.
        Grid = "grid",
        /// Sort along an axis, sweep.
        Sweep = "sweep",
        /// Candidates within reach and a skin, kept over frames until a body has moved by its skin.
        Neighbours = "neighbours",
        /// Chosen from the scene.
        Auto = "auto",
    }
}
