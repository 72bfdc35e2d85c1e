//! The interface of an engine in the comparison.
//!
//! A new engine is a file with a `Contestant` of [`Frame`]s and its [`Entry`], and a line in
//! `roster.rs`.

use sdop_bench::scene::Scene;
use sdop_judge::Claim;
use sdop_judge::contestant::Contestant;

use crate::boxes::Frame;

/// An engine with the bodies of one scene. The timed work is from the frame's boxes to a complete
/// answer in the engine's memory.
pub type Engine = Box<dyn Contestant<Frame>>;

/// The kind of pairs that an engine finds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Work {
    /// All pairs of boxes: the same work for all.
    Boxes,
    /// All pairs of bounding spheres: fewer, and closer to the truth.
    Spheres,
    /// Pairs of spheres whose or-DOPs overlap (k = 18, two-sided): the whole S-DOP.
    SDop,
    /// All pairs of convex hulls.
    Hulls,
    /// All pairs of triangle meshes.
    Meshes,
}

impl Work {
    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Boxes => "boxes",
            Self::Spheres => "spheres",
            Self::SDop => "s-dop",
            Self::Hulls => "hulls",
            Self::Meshes => "meshes",
        }
    }

    /// The claim by which the engine is judged.
    pub fn claim(self) -> Claim {
        match self {
            Self::Boxes => Claim::Aabb,
            Self::Spheres => Claim::Sphere,
            Self::Hulls => Claim::Hull,
            Self::SDop | Self::Meshes => Claim::Mesh,
        }
    }
}

/// What an engine is built for.
#[derive(Clone, Copy)]
pub struct Setup<'a> {
    /// The scene, for what culls by more than boxes.
    pub scene: &'a Scene,
    /// The first frame.
    pub first: &'a Frame,
    /// Threads to use.
    pub threads: usize,
}

/// One engine, or one way to drive it.
#[derive(Clone, Copy)]
pub struct Entry {
    /// Its name in tables and on the command line.
    pub name: &'static str,
    /// The version that is measured.
    pub version: &'static str,
    /// What it finds.
    pub work: Work,
    /// The most threads that it can use.
    pub threads: usize,
    /// Whether it keeps state other than buffers between frames. An engine that starts from nothing
    /// in each frame only joins for the last warm-up frames.
    pub ages: bool,
    /// Builds it.
    pub new: fn(&Setup<'_>) -> miette::Result<Engine>,
}

/// The name of the engine that the others are compared with.
pub const OURS: &str = "sdop boxes";
