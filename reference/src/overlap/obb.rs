//! Oriented box against oriented box: 3 + 3 face normals and 9 edge × edge axes (Gottschalk 1996).

use super::Overlap;
use super::ordop::{self, TurnedPolytope};
use crate::linear::Vector;
use crate::pose::separation;
use crate::shape::Body;

/// Whether the posed oriented boxes overlap.
pub fn overlap(a: &Body, b: &Body) -> bool {
    let turned = |body: &Body| TurnedPolytope::new(&body.shape.obb, &body.pose);
    overlap_turned(&turned(a), &turned(b), &separation(&a.pose, &b.pose))
}

/// [`overlap`] of boxes already turned. A box is a 6-DOP whose full test has the 15 axes.
pub fn overlap_turned(a: &TurnedPolytope, b: &TurnedPolytope, delta: &Vector<f64>) -> bool {
    ordop::overlap_turned(a, b, delta, Overlap::Full)
}
