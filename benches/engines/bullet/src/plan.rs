//! What is run: a scene, what its bodies are made of, how many of them.

use clap::ValueEnum;
use serde::{Deserialize, Serialize};

/// A scene that people simulate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SceneKind {
    /// Bodies dropped into an open box, where they settle.
    Pile,
    /// A closed box whose gravity turns about a horizontal axis.
    Tumbler,
    /// Bodies flying about in a closed box, without gravity.
    Cloud,
}

/// What bodies are made of. The order is that of `Kind` in `native/scene.cpp`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// Its convex hull.
    Hull,
    /// A triangle mesh (GImpact).
    Mesh,
    /// A box, which passes unfiltered.
    Box,
    /// A ball, which passes unfiltered.
    Ball,
}

/// How finely bodies are cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Detail {
    /// Low-polygon meshes, as people simulate them.
    Coarse,
    /// Meshes as they come from modelling, of thousands of triangles.
    Fine,
}

/// How a scene is stepped. The order is that of `Mode` in `native/scene.cpp`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Bullet as it comes.
    Plain,
    /// With the filter.
    Filtered,
    /// Without, but each pair is put to the filter too and its verdict compared with what Bullet
    /// then finds.
    Judged,
}

/// A scene to be set up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    /// What happens.
    pub scene: SceneKind,
    /// To what.
    pub kind: Kind,
    /// How many bodies.
    pub bodies: usize,
    /// Where random draws start.
    pub seed: u64,
}
