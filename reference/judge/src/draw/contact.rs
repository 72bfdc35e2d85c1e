//! Bodies that nearly touch, drawn on purpose: uniform random pairs are far apart or deep inside
//! one another, so the last bit never decides them.
//!
//! A supporting feature of A and one of B along an axis n are put together, Δ = a* − b* + gap·n. At
//! gap 0 the sets share the point a* and n separates their interiors, so the pair touches whatever
//! the other axes say. The gap is a few u of the bodies' size, and rounding tB to f32 adds half an
//! ulp of the coordinates to it.

use glam::{DMat3, DVec3};
use sdop_reference as reference;

use crate::truth::reference_shapes::Shapes;
use reference::overlap::ordop::TurnedPolytope;
use sdop::rounding::U;

/// What touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ContactKind {
    /// Bounding balls along any direction.
    Ball,
    /// or-DOP corner on or-DOP face of the first body.
    FirstFace,
    /// or-DOP corner on or-DOP face of the second body.
    SecondFace,
    /// or-DOP edge on or-DOP edge.
    Edges,
    /// A face or an edge of the oriented boxes.
    Box,
    /// Vertices along a direction of the world-aligned k-DOPs.
    World,
    /// Mesh vertices along any direction.
    Mesh,
    /// A triangle of the first mesh against the second's vertices, along the triangle's normal.
    Triangle,
    /// Ball centres coincide: nothing near, one inside the other.
    Concentric,
}

impl ContactKind {
    /// Every kind.
    pub const ALL: [Self; 9] = [
        Self::Ball,
        Self::FirstFace,
        Self::SecondFace,
        Self::Edges,
        Self::Box,
        Self::World,
        Self::Mesh,
        Self::Triangle,
        Self::Concentric,
    ];
}

/// One near-touching placement of a second body against a first.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// What touches.
    pub kind: ContactKind,
    /// Which face, edge or world direction; taken modulo their number.
    pub pick: [u32; 2],
    /// Any direction, any length; used by kinds that take one, and for the sign of the others'
    /// axes.
    pub direction: [f64; 3],
    /// Gap (overlap if negative) in u = 2⁻²⁴ of the two bodies' reach.
    pub gap: f64,
}

/// A shape's number and its pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedShape {
    /// Index into the shapes.
    pub shape: usize,
    /// Orientation quaternion (x, y, z, w).
    pub rotation: [f32; 4],
    /// Translation.
    pub translation: [f32; 3],
}

impl Contact {
    /// The translation that brings the second body, in `shape` with `rotation`, to the contact with
    /// `first`. `None` when a pose is outside the contract.
    #[must_use]
    pub fn place(
        &self,
        shapes: &Shapes,
        first: &PlacedShape,
        shape: usize,
        rotation: [f32; 4],
    ) -> Option<[f32; 3]> {
        let a = ContactSide::new(shapes, first.shape, first.rotation)?;
        let b = ContactSide::new(shapes, shape, rotation)?;
        let reach = f64::from(a.built.reach) + f64::from(b.built.reach);
        let (n, delta) = self.touching(&a, &b)?;
        let from = DVec3::from(first.translation.map(f64::from));
        let t = from + delta + n * (self.gap * U * reach);
        let t = t.as_vec3().to_array();
        t.iter().all(|x| x.abs() <= sdop::rounding::LIMIT).then_some(t)
    }

    /// The separating axis, a unit vector, and Δ at which the features share a point.
    fn touching(&self, a: &ContactSide<'_>, b: &ContactSide<'_>) -> Option<(DVec3, DVec3)> {
        let any = DVec3::from(self.direction).try_normalize()?;
        let between = a.ball() - b.ball();
        let toward = |n: DVec3| if n.dot(any) < 0.0 { -n } else { n };
        let nth = |list: &[[f64; 3]], i: usize| {
            let n = list.get(self.pick[i] as usize % list.len().max(1))?;
            DVec3::from(*n).try_normalize()
        };
        let (n, [pa, pb]) = match self.kind {
            ContactKind::Ball => {
                let radii = f64::from(a.built.ball.radius) + f64::from(b.built.ball.radius);
                return Some((any, between + any * radii));
            }
            ContactKind::Concentric => return Some((any, between)),
            ContactKind::FirstFace | ContactKind::SecondFace | ContactKind::Edges => {
                let (ta, tb) = (a.turned(), b.turned());
                let n = match self.kind {
                    ContactKind::FirstFace => nth(&ta.normals, 0)?,
                    ContactKind::SecondFace => nth(&tb.normals, 1)?,
                    _ => crossed(nth(&ta.edges, 0)?, nth(&tb.edges, 1)?, any),
                };
                (n, [ta.corners, tb.corners])
            }
            ContactKind::Box => {
                let (ta, tb) = (a.turned_box(), b.turned_box());
                let n = match self.pick[0] % 3 {
                    0 => nth(&ta.normals, 1)?,
                    1 => nth(&tb.normals, 1)?,
                    _ => crossed(nth(&ta.normals, 1)?, nth(&tb.normals, 0)?, any),
                };
                (n, [ta.corners, tb.corners])
            }
            ContactKind::World => {
                let directions = reference::DirectionSet::K26.coefficients();
                let c = directions[self.pick[0] as usize % directions.len()];
                let n = DVec3::from(c.map(f64::from)).normalize();
                (n, [a.vertices(), b.vertices()])
            }
            ContactKind::Mesh => (any, [a.vertices(), b.vertices()]),
            ContactKind::Triangle => {
                (a.triangle_normal(self.pick[0]).unwrap_or(any), [a.vertices(), b.vertices()])
            }
        };
        let n = toward(n);
        Some((n, support(&pa, n)? - support(&pb, -n)?))
    }
}

/// a × b, or `otherwise` when they are parallel.
fn crossed(a: DVec3, b: DVec3, otherwise: DVec3) -> DVec3 {
    a.cross(b).try_normalize().unwrap_or(otherwise)
}

/// The point farthest along `n`.
fn support(points: &[[f64; 3]], n: DVec3) -> Option<DVec3> {
    let along = |p: &&[f64; 3]| DVec3::from(**p).dot(n);
    points.iter().max_by(|p, q| along(p).total_cmp(&along(q))).map(|p| DVec3::from(*p))
}

/// One body about its own origin, turned.
struct ContactSide<'a> {
    built: &'a sdop::volume::Shape,
    judged: &'a reference::Shape,
    pose: reference::Pose,
    matrix: DMat3,
}

impl<'a> ContactSide<'a> {
    fn new(shapes: &'a Shapes, shape: usize, rotation: [f32; 4]) -> Option<Self> {
        let pose = reference::Pose::new(rotation, [0.0; 3]).ok()?;
        let [x, y, z] = pose.rotation().map(DVec3::from);
        Some(Self {
            built: shapes.built.get(shape)?,
            judged: shapes.judged.get(shape)?,
            pose,
            matrix: DMat3::from_cols(x, y, z).transpose(),
        })
    }

    fn ball(&self) -> DVec3 {
        self.matrix * in_f64(&self.built.ball.centre)
    }

    fn turned(&self) -> TurnedPolytope {
        TurnedPolytope::new(&self.judged.polytope, &self.pose)
    }

    fn turned_box(&self) -> TurnedPolytope {
        TurnedPolytope::new(&self.judged.obb, &self.pose)
    }

    fn vertices(&self) -> Vec<[f64; 3]> {
        let turn = |v: &[f32; 3]| (self.matrix * in_f64(v)).to_array();
        self.built.vertices.iter().map(turn).collect()
    }

    fn triangle_normal(&self, pick: u32) -> Option<DVec3> {
        let triangles = &self.built.triangles;
        let triangle = triangles.get(pick as usize % triangles.len().max(1))?;
        let [p, q, r] = triangle.map(|v| in_f64(&self.built.vertices[v as usize]));
        (self.matrix * (q - p).cross(r - p)).try_normalize()
    }
}

/// A vertex in f64.
fn in_f64(vertex: &[f32; 3]) -> DVec3 {
    DVec3::from_array(vertex.map(f64::from))
}
