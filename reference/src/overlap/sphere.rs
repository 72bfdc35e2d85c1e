//! Sphere against sphere: ‖cB − cA‖² ≤ (rA + rB)².

use crate::linear::{add, dot, sub};
use crate::pose::separation;
use crate::shape::Body;

/// Whether the posed bounding spheres overlap.
pub fn overlap(a: &Body, b: &Body) -> bool {
    let centre = |body: &Body| body.pose.turn(&body.shape.ball.centre.map(f64::from));
    let d = add(&separation(&a.pose, &b.pose), &sub(&centre(b), &centre(a)));
    let reach = f64::from(a.shape.ball.radius) + f64::from(b.shape.ball.radius);
    dot(&d, &d) <= reach * reach
}
