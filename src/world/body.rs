//! What a world knows its bodies by, and what they are made of.

use std::fmt;

use crate::bodies::Groups;

/// A body of a world. Stays the same until the body is removed, and is never given to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BodyId {
    pub(super) slot: u32,
    pub(super) generation: u32,
}

impl BodyId {
    /// Where a column a body may keep this one's entry: below [`World::slots`](super::World::slots), and given to another
    /// body once this one is removed.
    #[must_use]
    pub fn slot(self) -> usize {
        self.slot as usize
    }
}

impl fmt::Display for BodyId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.slot, self.generation)
    }
}

/// A body to be inserted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Index into the world's shapes.
    pub shape: u32,
    /// Whether it may move; pairs of two bodies that may not are never tested.
    pub dynamic: bool,
    /// Orientation quaternion (x, y, z, w) of any non-zero norm.
    pub rotation: [f32; 4],
    /// Translation of the body origin, world frame.
    pub translation: [f64; 3],
    /// Which bodies it may collide with.
    pub groups: Groups,
    /// Contact margin, a length ≥ 0: a pair is reported when its meshes, each grown by its margin, meet. The culler may
    /// round it up by an eighth.
    pub margin: f32,
}

impl Default for Body {
    /// A dynamic body of the first shape at the origin, unturned, that collides with all, without a margin.
    fn default() -> Self {
        Self {
            shape: 0,
            dynamic: true,
            rotation: [0.0, 0.0, 0.0, 1.0],
            translation: [0.0; 3],
            groups: Groups::ALL,
            margin: 0.0,
        }
    }
}
