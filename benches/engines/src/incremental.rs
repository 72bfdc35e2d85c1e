//! The interface of an engine that is given what has changed, and keeps the boxes that haven't.

use sdop::Aabb;

use crate::boxes::Slabs;
use crate::entry::{Setup, Work};

/// The boxes that have changed since the last frame, sorted by bodies.
#[derive(Clone, Debug, Default)]
pub struct Moves {
    /// The bodies' numbers.
    pub bodies: Vec<u32>,
    /// Where each body's origin is now.
    pub centres: Vec<[f32; 3]>,
    /// Each body's box now.
    pub boxes: Vec<Slabs>,
    /// The boxes as corners, for engines that take those.
    pub corners: Vec<Aabb>,
}

impl Moves {
    /// Each changed body with its box.
    pub fn iter(&self) -> impl Iterator<Item = (u32, &Slabs)> {
        self.bodies.iter().copied().zip(&self.boxes)
    }
}

/// A pair that has begun (true) or ended.
pub type Change = ([u32; 2], bool);

/// What an engine reports after a frame.
pub enum Found<'a> {
    /// The pairs that have begun or ended in this frame.
    Changes(&'a [Change]),
    /// All pairs.
    Pairs(Vec<[u32; 2]>),
}

/// An engine that keeps the boxes that don't move.
pub trait Incremental {
    /// Takes over the changed boxes and finds what has changed. This alone is timed.
    fn frame(&mut self, moves: &Moves);

    /// What the last frame has found; before the first frame, what the first boxes have.
    fn found(&self) -> Found<'_>;
}

/// Pairs that an engine may report although their boxes are apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Extras {
    /// None: it compares the boxes as they are.
    None,
    /// Pairs at this distance or nearer.
    Within(f32),
    /// Pairs that met once: it drops pairs late.
    #[cfg_attr(not(feature = "debian"), allow(dead_code, reason = "Bullet alone"))]
    Late,
}

/// One engine, or one way to drive it.
#[derive(Clone, Copy)]
pub struct MoverEntry {
    /// Its name in tables and on the command line.
    pub name: &'static str,
    /// The version that is measured.
    pub version: &'static str,
    /// The length by which it grows each box, as a table shows it.
    pub margin: f32,
    /// The pairs that it may report in addition.
    pub extras: Extras,
    /// What it finds.
    pub work: Work,
    /// Whether it runs only in one case: the scene of meshes, one body replaced per frame, or with
    /// a read list.
    pub only: Option<Only>,
    /// The most bodies with which it runs: building the slowest ones for more takes minutes.
    pub most_bodies: usize,
    /// Builds it with the first boxes, whose pairs it finds.
    pub new: fn(&Setup<'_>) -> miette::Result<Box<dyn Incremental>>,
}

/// The most bodies of engines that are too slow for more.
pub const HUNDRED_THOUSAND: usize = 100_000;

/// A case for which an entry is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Only {
    /// Bodies that leave while others come.
    Replacement,
    /// Meshes instead of boxes.
    Meshes,
    /// All pairs are read, too: at one per cent of movers.
    ReadPairs,
}

impl MoverEntry {
    /// Whether it is one of ours, which is never left out.
    pub fn is_ours(&self) -> bool {
        self.name.starts_with("sdop")
    }
}
