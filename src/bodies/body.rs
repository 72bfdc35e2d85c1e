//! A body of a world.

use super::{Groups, Motion};
use crate::rounding::narrow::narrow;
use crate::simd::in_default_mode;

/// The rotation that turns nothing, a quaternion (x, y, z, w).
pub(crate) const UNTURNED: [f32; 4] = [0.0, 0.0, 0.0, 1.0];

/// A body of a `World`: its shape, pose, motion, groups and contact margin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Index into the world's shapes.
    pub shape: u32,
    /// Whether it is dynamic, resting or fixed. Pairs of two fixed bodies are never tested.
    pub motion: Motion,
    /// Orientation quaternion (x, y, z, w) of any non-zero norm.
    pub rotation: [f32; 4],
    /// Translation of the body origin, world frame.
    pub translation: [f64; 3],
    /// Whether the rotation was rounded from f64 ([`Self::turned`]). The body is then grown by what
    /// that may move its points, rounded up to at least 2⁻¹² of its reach, so that no pair of the
    /// exact pose is missed.
    pub rounded: bool,
    /// Which bodies it may collide with.
    pub groups: Groups,
    /// Contact margin, a length ≥ 0: a pair is reported when its meshes, each grown by its margin,
    /// meet. The culler may round it up by at most an eighth.
    pub margin: f32,
}

impl Body {
    /// A dynamic body with a shape and a pose, without a margin, that collides with all: rotation
    /// as a quaternion (x, y, z, w) of any non-zero norm, translation of the body origin in the
    /// world frame.
    #[must_use]
    pub fn at(shape: u32, rotation: impl Into<[f32; 4]>, translation: impl Into<[f64; 3]>) -> Self {
        Self {
            shape,
            rotation: rotation.into(),
            translation: translation.into(),
            ..Self::default()
        }
    }

    /// This body with a rotation in f64, a quaternion (x, y, z, w) of any non-zero norm. If f32
    /// holds it, that is all. Otherwise `rotation` gets the nearest, and `rounded` says so.
    #[must_use]
    pub fn turned(self, rotation: impl Into<[f64; 4]>) -> Self {
        let (rotation, rounded) = in_default_mode(|| narrow(rotation.into()));
        Self { rotation, rounded, ..self }
    }

    /// This body, fixed: pairs of two fixed bodies are never tested.
    #[must_use]
    pub fn fixed(self) -> Self {
        Self { motion: Motion::Fixed, ..self }
    }
}

impl Default for Body {
    /// A dynamic body of shape 0 at the origin, not rotated, without a margin, that collides with
    /// all.
    fn default() -> Self {
        Self {
            shape: 0,
            motion: Motion::Dynamic,
            rotation: UNTURNED,
            translation: [0.0; 3],
            rounded: false,
            groups: Groups::ALL,
            margin: 0.0,
        }
    }
}
