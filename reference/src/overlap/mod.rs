//! Whether the volumes of two posed bodies overlap, in plain f64, one file per volume. Touching
//! counts.
//!
//! Convex volumes are compared by the separating axis theorem: along an axis a, the sets A and B
//! are apart iff max a·A < min a·B or the other way round.

pub mod obb;
pub mod ordop;
pub mod sphere;
pub mod world;

use crate::linear::{Vector, dot};

pub use ordop::Overlap;

/// The interval that points cover along an axis; empty (∞, −∞) for none.
pub fn interval(axis: &Vector<f64>, points: &[Vector<f64>]) -> [f64; 2] {
    let empty = [f64::INFINITY, f64::NEG_INFINITY];
    points.iter().map(|p| dot(axis, p)).fold(empty, |[lo, hi], h| [lo.min(h), hi.max(h)])
}

/// Whether two intervals share no number.
pub fn apart(a: [f64; 2], b: [f64; 2]) -> bool {
    a[1] < b[0] || b[1] < a[0]
}

/// Whether one of the axes separates the two point sets.
pub fn separated<'a>(
    axes: impl IntoIterator<Item = &'a Vector<f64>>,
    a: &[Vector<f64>],
    b: &[Vector<f64>],
) -> bool {
    axes.into_iter().any(|axis| apart(interval(axis, a), interval(axis, b)))
}
