//! A mesh made ready for culling: placed in its body frame, with its volumes (the paper's one-off construction, Co).
//!
//! `origin = "ball"` moves the smallest enclosing ball's centre into the body origin, so that the sphere of a posed body
//! is a copy of its translation; `origin = "file"` leaves the coordinates alone. Either way every volume is computed
//! from, and contains exactly, the f32 vertices as culled.

use glam::Vec3;

use super::{Axes, Ball, Basis, DirectionSet, Hull, OrDop, ball};
use crate::{choice::choices, mesh::TriangleMesh, rounding::LIMIT, simd::in_default_mode};

choices! {
    /// Which point of the mesh becomes the body's origin.
    Origin, "origin", {
        /// The centre of the smallest enclosing ball.
        Ball = "ball",
        /// The file's own origin.
        File = "file",
    }
}

/// How a mesh becomes a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeSpec {
    /// The body's origin.
    pub origin: Origin,
    /// The radius to which the smallest enclosing ball is scaled; `None` keeps the mesh's size. Needs [`Origin::Ball`].
    pub radius: Option<f32>,
    /// The or-DOP's directions.
    pub directions: DirectionSet,
    /// The or-DOP's basis.
    pub axes: Axes,
}

impl Default for ShapeSpec {
    fn default() -> Self {
        Self {
            origin: Origin::Ball,
            radius: None,
            directions: DirectionSet::K18,
            axes: Axes::Principal,
        }
    }
}

/// A mesh with its volumes: what the culler needs to know of a body's form.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// The mesh's name.
    pub name: String,
    /// Vertices as culled (body frame; for `origin = "ball"` re-centred and scaled, rounded to f32).
    pub vertices: Vec<Vec3>,
    /// Vertex indices of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Smallest enclosing ball of `vertices`, rounded up.
    pub ball: Ball,
    /// ρ: the largest vertex norm about the body origin, rounded up.
    pub reach: f32,
    /// The oriented k-DOP of `vertices`.
    pub ordop: OrDop,
}

impl Shape {
    /// Places the mesh and builds its ball and or-DOP.
    ///
    /// # Errors
    /// An empty or non-finite mesh, a radius that can't be reached, or a size beyond 2⁶⁰.
    pub fn build(mesh: &TriangleMesh, spec: &ShapeSpec) -> Result<Self, VolumeError> {
        in_default_mode(|| {
            let Placed {
                vertices,
                ball,
                reach,
            } = place(mesh, spec)?;
            Ok(Self {
                name: mesh.name.clone(),
                triangles: mesh.triangles.clone(),
                reach,
                ordop: OrDop::build(&vertices, spec.axes.basis(&vertices), spec.directions),
                ball,
                vertices,
            })
        })
    }

    /// Exchanges the or-DOP's directions; ball, basis and placement stay.
    #[must_use]
    pub fn with_directions(mut self, directions: DirectionSet) -> Self {
        let basis = self.ordop.basis;
        self.ordop = in_default_mode(|| OrDop::build(&self.vertices, basis, directions));
        self
    }

    /// The or-DOP of these vertices along other axes, with other directions.
    #[must_use]
    pub fn ordop_along(&self, axes: Axes, directions: DirectionSet) -> OrDop {
        in_default_mode(|| OrDop::build(&self.vertices, axes.basis(&self.vertices), directions))
    }

    /// The oriented bounding box: an or-DOP of three slabs along the principal axes, whatever the or-DOP's own axes.
    #[must_use]
    pub fn obb(&self, hull: &Hull) -> OrDop {
        in_default_mode(|| {
            let basis = Basis::principal(hull, &self.vertices);
            OrDop::build(&self.vertices, basis, DirectionSet::K6)
        })
    }
}

/// Vertices in the body frame with what depends on the placement alone.
struct Placed {
    vertices: Vec<Vec3>,
    ball: Ball,
    reach: f32,
}

fn place(mesh: &TriangleMesh, spec: &ShapeSpec) -> Result<Placed, VolumeError> {
    let shape = || mesh.name.clone();
    if mesh.vertices.is_empty() {
        return Err(VolumeError::Empty { shape: shape() });
    }
    if let Some(vertex) = mesh.vertices.iter().position(|v| !v.is_finite()) {
        return Err(VolumeError::NotFinite {
            shape: shape(),
            vertex,
        });
    }
    let (vertices, ball) = match (spec.origin, spec.radius) {
        (Origin::File, Some(radius)) => {
            return Err(VolumeError::FixedSize {
                shape: shape(),
                radius,
            });
        }
        (Origin::File, None) => (mesh.vertices.clone(), Ball::smallest(&mesh.vertices)),
        (Origin::Ball, radius) => {
            let vertices = centred(mesh, radius)?;
            let ball = Ball::about(Vec3::ZERO, &vertices);
            (vertices, ball)
        }
    };
    let reach = ball::farthest_distance(Vec3::ZERO, &vertices);
    let within = reach <= LIMIT; // false for NaN; bounds the centre and the ball's radius too
    if !within {
        return Err(VolumeError::TooLarge {
            shape: shape(),
            reach,
        });
    }
    Ok(Placed {
        vertices,
        ball,
        reach,
    })
}

/// fl32(s·(v − c)): the ball's centre moved into the origin and its radius scaled to `radius`.
fn centred(mesh: &TriangleMesh, radius: Option<f32>) -> Result<Vec<Vec3>, VolumeError> {
    let (centre, size) = ball::smallest_enclosing(&mesh.vertices);
    let scale = match radius {
        None => 1.0,
        Some(radius) if !(radius > 0.0 && radius <= LIMIT) => {
            return Err(VolumeError::Radius {
                shape: mesh.name.clone(),
                radius,
            });
        }
        Some(radius) if size == 0.0 => {
            return Err(VolumeError::NoExtent {
                shape: mesh.name.clone(),
                radius,
            });
        }
        Some(radius) => f64::from(radius) / size,
    };
    let place = |v: &Vec3| ((v.as_dvec3() - centre) * scale).as_vec3();
    Ok(mesh.vertices.iter().map(place).collect())
}

/// Why a mesh has no volumes.
#[derive(Clone, Debug, PartialEq, thiserror::Error, miette::Diagnostic)]
pub enum VolumeError {
    /// No vertices.
    #[error("shape `{shape}` has no vertices")]
    #[diagnostic(help("a shape needs at least one vertex: check the mesh file"))]
    Empty {
        /// The mesh's name.
        shape: String,
    },
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} of shape `{shape}` is not finite")]
    #[diagnostic(help("coordinates must be finite f32: mend the mesh file"))]
    NotFinite {
        /// The mesh's name.
        shape: String,
        /// The first such vertex, 0-based.
        vertex: usize,
    },
    /// The requested radius is not a positive number within the limit.
    #[error("radius {radius} of shape `{shape}` is not in 0 < radius ≤ 2⁶⁰")]
    #[diagnostic(help("give a positive radius, or none to keep the mesh's own size"))]
    Radius {
        /// The mesh's name.
        shape: String,
        /// The radius as given.
        radius: f32,
    },
    /// A mesh of one point can't be scaled.
    #[error("shape `{shape}` is a single point and can't be scaled to radius {radius}")]
    #[diagnostic(help("leave the radius out: the point is culled as a ball of radius 0"))]
    NoExtent {
        /// The mesh's name.
        shape: String,
        /// The radius as given.
        radius: f32,
    },
    /// A radius together with `origin = "file"`.
    #[error("shape `{shape}` keeps its file's coordinates and can't be scaled to radius {radius}")]
    #[diagnostic(help("leave the radius out, or use origin = \"ball\""))]
    FixedSize {
        /// The mesh's name.
        shape: String,
        /// The radius as given.
        radius: f32,
    },
    /// Vertices too far from the body origin for the culler's f32 arithmetic.
    #[error("shape `{shape}` reaches {reach:e} from its origin, beyond the limit of 2⁶⁰ ≈ 1.15e18")]
    #[diagnostic(help("scale the mesh down, or give a radius"))]
    TooLarge {
        /// The mesh's name.
        shape: String,
        /// The largest vertex norm.
        reach: f32,
    },
}
