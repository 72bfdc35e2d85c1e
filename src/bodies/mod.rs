//! The state of all rigid bodies, one column a quantity; index i is body i in every column.

pub mod contract;
mod groups;
mod places;

pub use groups::Groups;
pub use places::Places;

/// Rigid bodies as columns. All columns have one length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bodies {
    /// Index into the scene's shapes.
    pub shape: Vec<u32>,
    /// Whether the body may move; pairs of two bodies that may not are never tested.
    pub dynamic: Vec<bool>,
    /// Orientation quaternion (x, y, z, w) of any non-zero norm.
    pub rotation: Vec<[f32; 4]>,
    /// Translation of the body origin, world frame.
    pub translation: Vec<[f32; 3]>,
    /// Linear velocity, world frame, length units a second.
    pub velocity: Vec<[f32; 3]>,
    /// Angular velocity ω, world frame, radians a second.
    pub spin: Vec<[f32; 3]>,
}

impl Bodies {
    /// Appends a body at rest.
    pub fn push(&mut self, shape: u32, dynamic: bool, rotation: [f32; 4], translation: [f32; 3]) {
        self.shape.push(shape);
        self.dynamic.push(dynamic);
        self.rotation.push(rotation);
        self.translation.push(translation);
        self.velocity.push([0.0; 3]);
        self.spin.push([0.0; 3]);
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
