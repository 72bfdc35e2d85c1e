//! World-aligned k-DOPs, re-fitted each frame from the vertices: `aabb` is k = 6.

use super::{apart, interval};
use crate::linear::{Vector, apply, dot, integers};
use crate::pose::separation;
use crate::shape::Body;
use crate::volume::DirectionSet;

/// The posed vertices' intervals along each direction, world axes, seen from the body's origin.
pub fn extents(body: &Body, directions: DirectionSet) -> Vec<[f64; 2]> {
    let rotation = body.pose.rotation();
    let turned: Vec<_> = body.shape.points().map(|x| apply(&rotation, &x)).collect();
    world_directions(directions).iter().map(|d| interval(d, &turned)).collect()
}

/// Whether the re-fitted k-DOPs overlap.
pub fn overlap(a: &Body, b: &Body, directions: DirectionSet) -> bool {
    let delta = separation(&a.pose, &b.pose);
    overlap_extents(&extents(a, directions), &extents(b, directions), &delta, directions)
}

/// [`overlap`] of extents already fitted, B's origin at `delta` from A's.
pub fn overlap_extents(
    a: &[[f64; 2]],
    b: &[[f64; 2]],
    delta: &Vector<f64>,
    directions: DirectionSet,
) -> bool {
    let shifts = world_directions(directions).into_iter().map(|d| dot(&d, delta));
    let mut slabs = a.iter().zip(b).zip(shifts);
    !slabs.any(|((a, b), shift)| apart(*a, [b[0] + shift, b[1] + shift]))
}

fn world_directions(directions: DirectionSet) -> Vec<Vector<f64>> {
    directions.coefficients().into_iter().map(integers).collect()
}
