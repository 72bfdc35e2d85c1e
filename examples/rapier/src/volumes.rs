//! Rapier's shapes as sdop's: what volumes are built from, and how far rapier looks beyond them.

use sdop::mesh::TriangleMesh;
use sdop::volume::{Shape as Volume, ShapeSpec};

use super::rapier::math::{Real, Vector};
use super::rapier::parry::shape::{Shape, TriMeshFlags, TypedShape};
use super::rapier::prelude::{Collider, IntegrationParameters, RigidBody};

/// The volumes of a convex hull, a triangle mesh, or a compound of them, about the collider's own
/// origin.
///
/// `None` for all others. Balls, capsules, boxes, cylinders, cones and half-spaces have a narrow
/// phase of their own that is hardly dearer than a cull; rapier tests boxes by separating axes,
/// which can find a contact farther away than the prediction distance. A deformable mesh changes
/// between steps.
#[must_use]
pub fn volume(shape: &dyn Shape) -> Option<Volume> {
    let (vertices, triangles) = triangles_of(shape)?;
    let vertices = vertices.iter().map(|v| v.to_array().map(|x| x as f32));
    let mesh = TriangleMesh::new("collider", vertices, triangles).ok()?;
    Volume::build(&mesh, &ShapeSpec::default()).ok()
}

fn triangles_of(shape: &dyn Shape) -> Option<(Vec<Vector>, Vec<[u32; 3]>)> {
    match shape.as_typed_shape() {
        TypedShape::ConvexPolyhedron(hull) => Some(hull.to_trimesh()),
        TypedShape::TriMesh(mesh) if !mesh.flags().contains(TriMeshFlags::DEFORMABLE) => {
            Some((mesh.vertices().to_vec(), mesh.indices().to_vec()))
        }
        TypedShape::Compound(compound) => {
            let mut all = (Vec::new(), Vec::new());
            for (pose, part) in compound.shapes() {
                let (vertices, triangles) = triangles_of(part.as_ref())?;
                let first = all.0.len() as u32;
                all.0.extend(vertices.iter().map(|v| pose * *v));
                all.1.extend(triangles.iter().map(|t| t.map(|i| first + i)));
            }
            Some(all)
        }
        _ => None,
    }
}

/// How far rapier looks for contacts in a step, and how far it may be off.
#[derive(Clone, Copy, Debug, Default)]
pub struct Step {
    prediction: f64,
    dt: f64,
}

impl Step {
    /// A step with these parameters.
    #[must_use]
    pub fn new(parameters: &IntegrationParameters) -> Self {
        Self { prediction: parameters.prediction_distance() as f64, dt: parameters.dt as f64 }
    }

    /// The margin that a collider of size `reach` needs, so that two colliders whose volumes stay
    /// apart with their margins get no contact in this step:
    ///
    /// > ½·prediction + skin + dt·(|v| + |ω|·arm), and 1 % for parry's GJK, which stops within 0.1 % of a distance; and what
    /// > rounding moves: rapier's own arithmetic and, where it is f64, that of vertices and rotations to f32.
    ///
    /// Soft CCD looks as far as the velocities reach, at most. The velocities also cover points
    /// that parry keeps from earlier steps: rapier solves those that would be within the prediction
    /// distance at the end of this step.
    #[must_use]
    pub fn margin(&self, collider: &Collider, body: Option<&RigidBody>, reach: f64) -> f64 {
        let moved = body.map_or(0.0, |body| {
            let arm = (*collider.position() * Vector::ZERO - body.center_of_mass()).length() as f64;
            body.linvel().length() as f64 + body.angvel().length() as f64 * (arm + reach)
        });
        let far = collider.position().translation.abs().max_element() as f64 + reach;
        let reached = 0.5 * self.prediction + collider.contact_skin() as f64 + self.dt * moved;
        1.01 * reached + rounding(far)
    }
}

/// What rounding moves, in numbers of this size: rapier's own arithmetic, and that of poses and
/// vertices to f32.
pub fn rounding(size: f64) -> f64 {
    (64.0 * Real::EPSILON as f64 + 2f64.powi(-20)) * size
}
