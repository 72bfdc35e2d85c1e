//! The state of all rigid bodies, one column per quantity. Index i is body i in every column.

mod aabb;
mod body;
pub mod contract;
mod excluded;
mod groups;
mod motion;
mod places;
mod read_ahead;

pub use aabb::Aabb;
pub use body::Body;
pub(crate) use body::UNTURNED;
pub(crate) use excluded::{ExcludedPairs, NumberHasher, PairFilter, PairRules};
pub use groups::Groups;
pub use motion::Motion;
#[doc(hidden)]
pub use places::Places;
pub(crate) use read_ahead::read_ahead;

/// Rigid bodies as columns. All columns have one length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bodies {
    /// Index into the scene's shapes.
    pub shape: Vec<u32>,
    /// Whether the body may move. Pairs of two bodies that may not are never tested or reported.
    pub dynamic: Vec<bool>,
    /// Orientation quaternion (x, y, z, w) of any non-zero norm.
    pub rotation: Vec<[f32; 4]>,
    /// Translation of the body origin, world frame.
    pub translation: Vec<[f32; 3]>,
}

impl Bodies {
    /// Appends a body: the number of its shape, whether it may move, its orientation quaternion (x,
    /// y, z, w) of any non-zero norm, and the translation of its origin, world frame.
    pub fn push(
        &mut self,
        shape: u32,
        dynamic: bool,
        rotation: impl Into<[f32; 4]>,
        translation: impl Into<[f32; 3]>,
    ) {
        self.shape.push(shape);
        self.dynamic.push(dynamic);
        self.rotation.push(rotation.into());
        self.translation.push(translation.into());
    }

    /// The number of bodies.
    #[must_use]
    pub fn len(&self) -> usize {
        self.shape.len()
    }

    /// Whether there is no body.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.shape.is_empty()
    }
}

/// A line as the tests need it: the points from + s·speed for s from 0 to `limit`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LineTrack {
    pub from: [f64; 3],
    pub speed: [f64; 3],
    pub limit: f64,
}
