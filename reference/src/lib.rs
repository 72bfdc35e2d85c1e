//! The reference of S-DOP culling: plain formulas, one per function, with no code shared with the
//! culler. It decides which pairs a culler must report, for the judge and for tests.
//!
//! Modules have the names of the culler's stages: [`pose`], [`volume`], [`shape`], [`overlap`],
//! [`broad_phase`], [`strategy`], [`cost`]. They are plain f64 loops that read like the paper.
//! [`exact`] decides the same predicates in exact real arithmetic. The culler's tests check that
//! `optimised ⊇ reference predicate ⊇ exact mesh intersection`.
//!
//! Conventions: right-handed axes, column vectors `[x, y, z]`, quaternions `(x, y, z, w)` of any
//! non-zero norm, a pose is x ↦ R(q)x/|q|² + t. Volumes are the exactly posed, uninflated ones;
//! touching counts as overlap.
//!
//! ```
//! use sdop_reference::exact::judge::meeting_pairs;
//! use sdop_reference::{Ball, Body, DirectionSet, Overlap, Pose, Shape, Slabs, Strategy, pairs};
//!
//! let ball = Ball { centre: [0.0; 3], radius: 2.0 };
//! let basis = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
//! let slabs = Slabs { directions: DirectionSet::K6, basis, lo: vec![0.0; 3], hi: vec![1.0, 1.0, 0.0] };
//! let vertices = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
//! let shape = Shape::new(ball, slabs, vertices, vec![[0, 1, 2]])?;
//! let at = |x| Pose::new([0.0, 0.0, 0.0, 2.0], [x, 0.0, 0.0]);
//! let bodies = [at(0.0)?, at(1.0)?, at(2.5)?].map(|pose| Body { shape: &shape, pose, dynamic: true });
//!
//! assert_eq!(pairs(&bodies, Strategy::Sphere, Overlap::TwoSided), [(0, 1), (0, 2), (1, 2)]);
//! assert_eq!(pairs(&bodies, Strategy::Sequential, Overlap::TwoSided), [(0, 1)]);
//! assert_eq!(meeting_pairs(&bodies).0, [(0, 1)]);
//! # Ok::<(), sdop_reference::InvalidInput>(())
//! ```

pub mod broad_phase;
pub mod containment;
pub mod cost;
pub mod exact;
pub mod linear;
pub mod number;
pub mod overlap;
pub mod pose;
pub mod shape;
pub mod strategy;
pub mod volume;
pub mod wide;

#[cfg(test)]
mod tests;

pub use overlap::Overlap;
pub use pose::Pose;
pub use shape::{Body, Shape};
pub use strategy::{Strategy, pairs};
pub use volume::{Ball, DirectionSet, Slabs};
pub use wide::WidePose;

/// Invalid input, for which an answer would be meaningless.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum InvalidInput {
    /// A coordinate is NaN or infinite.
    #[error("{0} has a NaN or infinite number: give finite ones")]
    NotFinite(&'static str),
    /// A coordinate of a translation that is larger than any f32, or smaller and not 0.
    #[error("a number of the translation is beyond the range of f32: give 0, or 2⁻¹⁴⁹ to 2¹²⁸")]
    Translation,
    /// The quaternion (0, 0, 0, 0) names no rotation.
    #[error("the quaternion is zero: give any other norm")]
    ZeroQuaternion,
    /// A component of an f64 quaternion is lost in the largest one.
    #[error("components of the quaternion differ by more than 2^900: set the smallest to zero")]
    QuaternionSpread,
    /// A part's local pose and its body's pose have an exact product that f64 doesn't hold.
    #[error(
        "f64 doesn't hold the exact pose of a part: give translations that stay short when turned"
    )]
    ComposedPose,
    /// A radius below zero, or one that is NaN or infinite.
    #[error("the radius is negative, NaN or infinite")]
    Radius,
    /// The number of slabs is not k/2.
    #[error("{lo} lower and {hi} upper slab ends for {slabs} directions")]
    SlabCount {
        /// Directions of the set, k/2.
        slabs: usize,
        /// Lower ends given.
        lo: usize,
        /// Upper ends given.
        hi: usize,
    },
    /// The basis columns are not orthogonal with one common non-zero norm, in exact arithmetic.
    #[error("the slab basis is not exactly orthogonal with one common norm")]
    Basis,
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} names vertex {vertex} of {vertices}")]
    Index {
        /// Triangle number.
        triangle: usize,
        /// Vertex it names.
        vertex: u32,
        /// Vertices there are.
        vertices: usize,
    },
}
