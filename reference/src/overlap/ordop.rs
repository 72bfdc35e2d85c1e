//! or-DOP against or-DOP: slabs fixed in each body, compared along the normals of one or both and,
//! in full, along every edge × edge axis.
//!
//! The paper's "interval pairs in local space" is [`Overlap::OneSided`]: B's extent along A's
//! normals. The extent is that of B's corners. B's own interval with the same index would be along
//! another direction once B is turned.

use super::separated;
use crate::exact::polytope::Polytope;
use crate::linear::{Vector, add, apply, cross};
use crate::pose::{Pose, separation};
use crate::shape::Body;

/// Which separating axes the or-DOP test tries.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Overlap {
    /// A's normals, A being the body of lower index.
    OneSided,
    /// A's and B's normals.
    TwoSided,
    /// Both normals and all edge × edge axes: overlaps iff the polytopes meet.
    Full,
}

impl Overlap {
    /// Every test.
    pub const ALL: [Self; 3] = [Self::OneSided, Self::TwoSided, Self::Full];
}

/// A polytope under a rotation, without its position.
#[derive(Clone, Debug)]
pub struct TurnedPolytope {
    /// Corners, world axes, seen from the body's origin.
    pub corners: Vec<Vector<f64>>,
    /// Face normals, world axes.
    pub normals: Vec<Vector<f64>>,
    /// Edge directions, world axes.
    pub edges: Vec<Vector<f64>>,
}

impl TurnedPolytope {
    /// The polytope turned by the pose.
    pub fn new(polytope: &Polytope, pose: &Pose) -> Self {
        let rotation = pose.rotation();
        let turn =
            |vectors: Vec<Vector<f64>>| vectors.iter().map(|v| apply(&rotation, v)).collect();
        Self {
            corners: turn(polytope.rounded.iter().map(|xi| polytope.position(xi)).collect()),
            normals: turn(polytope.directions(&polytope.normals)),
            edges: turn(polytope.directions(&polytope.edges)),
        }
    }
}

/// Whether the posed or-DOPs overlap, as far as the axes of `test` can tell.
pub fn overlap(a: &Body, b: &Body, test: Overlap) -> bool {
    let (turned_a, turned_b) = (
        TurnedPolytope::new(&a.shape.polytope, &a.pose),
        TurnedPolytope::new(&b.shape.polytope, &b.pose),
    );
    overlap_turned(&turned_a, &turned_b, &separation(&a.pose, &b.pose), test)
}

/// [`overlap`] of polytopes already turned, B's origin at `delta` from A's.
pub fn overlap_turned(
    a: &TurnedPolytope,
    b: &TurnedPolytope,
    delta: &Vector<f64>,
    test: Overlap,
) -> bool {
    let corners_b: Vec<_> = b.corners.iter().map(|x| add(x, delta)).collect();
    let apart_along = |axes: &[Vector<f64>]| separated(axes, &a.corners, &corners_b);
    let crossed = || a.edges.iter().flat_map(|ea| b.edges.iter().map(move |eb| cross(ea, eb)));
    let apart = match test {
        Overlap::OneSided => apart_along(&a.normals),
        Overlap::TwoSided => apart_along(&a.normals) || apart_along(&b.normals),
        Overlap::Full => {
            apart_along(&a.normals)
                || apart_along(&b.normals)
                || crossed().any(|axis| apart_along(&[axis]))
        }
    };
    !apart
}
