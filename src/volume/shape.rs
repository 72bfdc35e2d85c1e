//! [`Shape`]: a mesh prepared for culling, in its body frame, with its volumes (the paper's one-off
//! construction, Co).
//!
//! `origin = "file"`, the default, keeps the mesh's own origin, to which an engine's poses refer.
//! `origin = "ball"` makes the centre of the smallest enclosing ball the body's origin, so that
//! updating a sphere only copies the translation. Either way, every volume is computed from these
//! f32 vertices and contains them exactly:
//!
//! > vertex = scale · (point of the file − offset), rounded to f32
//!
//! with the shape's [`Shape::offset`] and [`Shape::scale`]. A mesh that is far from its own origin
//! is the exception: its vertices are relative to a point near it, and [`Shape::pose_offset`] is
//! the position of that point relative to the one that poses refer to. Its volumes are grown by
//! [`Shape::rounding`].

use glam::DVec3;

use super::{Axes, Ball, Basis, DirectionSet, Hull, OrDop, ball};
use crate::{
    choice::choices,
    mesh::{TriangleMesh, in_f64},
    rounding::{LIMIT, exp2, up},
    simd::in_default_mode,
};

choices! {
    /// Which point of the mesh becomes the body's origin.
    Origin, "origin", {
        /// The centre of the smallest enclosing ball.
        Ball = "ball",
        /// The file's own origin.
        File = "file",
    }
}

/// Options for building a shape from a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeSpec {
    /// The body's origin, the point that poses place. The default is the mesh's own,
    /// [`Origin::File`].
    pub origin: Origin,
    /// The radius of the smallest enclosing ball after scaling about the body's origin; `None`
    /// keeps the mesh's size.
    pub radius: Option<f32>,
    /// The or-DOP's directions.
    pub directions: DirectionSet,
    /// The or-DOP's basis.
    pub axes: Axes,
}

impl Default for ShapeSpec {
    fn default() -> Self {
        Self {
            origin: Origin::File,
            radius: None,
            directions: DirectionSet::K18,
            axes: Axes::Principal,
        }
    }
}

/// A mesh with its bounding volumes: what a culler needs for all bodies of this shape.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// The mesh's name.
    pub name: String,
    /// Vertices in the body frame: scale · (point of the mesh − offset), rounded to f32.
    pub vertices: Vec<[f32; 3]>,
    /// Vertex indices of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// The origin of `vertices` in the file's coordinates: zero for [`Origin::File`], unless the
    /// mesh is far from its origin.
    pub offset: [f64; 3],
    /// The factor by which the mesh was scaled: 1 without a [`ShapeSpec::radius`].
    pub scale: f64,
    /// The origin of `vertices` in the frame that poses place: zero, or scale · offset for a mesh
    /// that is far from its origin with [`Origin::File`]. A pose (q, t) puts the origin of the
    /// vertices at t + R(q)·pose_offset. A [`World`](crate::World) computes that in f64; a culler
    /// with f32 poses rejects such a shape.
    pub pose_offset: [f64; 3],
    /// An upper bound on the distance of the vertices from the f64 points that they were rounded
    /// from: those of [`TriangleMesh::from_f64`], of a far mesh, or of a compound; 0 for any other
    /// mesh. Ball, reach and slabs are grown by it.
    pub rounding: f32,
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
    /// An empty or non-finite mesh, an invalid radius, or a size beyond 2⁶⁰.
    pub fn build(mesh: &TriangleMesh, spec: &ShapeSpec) -> Result<Self, VolumeError> {
        in_default_mode(|| Self::place(mesh, spec))
    }

    fn place(mesh: &TriangleMesh, spec: &ShapeSpec) -> Result<Self, VolumeError> {
        let placement = ShapePlacement::of(mesh, spec)?;
        let vertices: Vec<[f32; 3]> =
            mesh.vertices.iter().map(|v| placement.point(v).as_vec3().to_array()).collect();
        let rounding = placement.rounding(mesh, &vertices);
        let mut ball = match spec.origin {
            Origin::File => Ball::smallest(&vertices),
            Origin::Ball => Ball::about([0.0; 3], &vertices),
        };
        ball.radius = grown(ball.radius, rounding);
        let reach = grown(ball::farthest_distance([0.0; 3], &vertices), rounding);
        let within = reach <= LIMIT; // false for NaN; bounds the centre and the ball's radius too
        if !within {
            return Err(VolumeError::TooLarge { shape: mesh.name.clone(), reach });
        }
        Ok(Self {
            name: mesh.name.clone(),
            triangles: mesh.triangles.clone(),
            offset: placement.offset.to_array(),
            scale: placement.scale,
            pose_offset: placement.pose_offset.to_array(),
            rounding,
            reach,
            ordop: slabs(&vertices, spec.axes.basis(&vertices), spec.directions, rounding),
            ball,
            vertices,
        })
    }

    /// Whether poses refer to a point other than the origin of the vertices.
    #[must_use]
    pub fn is_far(&self) -> bool {
        self.pose_offset != [0.0; 3]
    }

    /// The or-DOP along a basis, grown by the shape's rounding.
    pub(crate) fn slabs(&self, basis: Basis, directions: DirectionSet) -> OrDop {
        in_default_mode(|| slabs(&self.vertices, basis, directions, self.rounding))
    }

    /// The shape with other directions of its or-DOP. Ball, basis and placement stay.
    #[must_use]
    pub fn with_directions(mut self, directions: DirectionSet) -> Self {
        self.ordop = self.slabs(self.ordop.basis, directions);
        self
    }

    /// The or-DOP of these vertices along other axes, with other directions.
    #[must_use]
    pub fn ordop_along(&self, axes: Axes, directions: DirectionSet) -> OrDop {
        in_default_mode(|| self.slabs(axes.basis(&self.vertices), directions))
    }

    /// The oriented bounding box: an or-DOP of three slabs along the principal axes, whatever the
    /// or-DOP's own axes.
    #[must_use]
    pub fn obb(&self, hull: &Hull) -> OrDop {
        in_default_mode(|| self.slabs(Basis::principal(hull, &self.vertices), DirectionSet::K6))
    }
}

/// The or-DOP of vertices, grown by their rounding.
fn slabs(vertices: &[[f32; 3]], basis: Basis, directions: DirectionSet, rounding: f32) -> OrDop {
    let ordop = OrDop::build(vertices, basis, directions);
    if rounding == 0.0 { ordop } else { ordop.grown(rounding) }
}

/// A size, grown by the rounding of vertices.
fn grown(size: f32, rounding: f32) -> f32 {
    if rounding == 0.0 { size } else { up(f64::from(size) + f64::from(rounding)) }
}

/// The origin of the vertices and the scale of the mesh.
struct ShapePlacement {
    /// The centre in the mesh's coordinates, which are relative to the mesh's offset.
    centre: DVec3,
    /// The offset in the file's coordinates.
    offset: DVec3,
    scale: f64,
    pose_offset: DVec3,
}

impl ShapePlacement {
    fn of(mesh: &TriangleMesh, spec: &ShapeSpec) -> Result<Self, VolumeError> {
        let shape = || mesh.name.clone();
        if mesh.vertices.is_empty() {
            return Err(VolumeError::Empty { shape: shape() });
        }
        if let Some(vertex) = mesh.vertices.iter().position(|v| !v.iter().all(|x| x.is_finite())) {
            return Err(VolumeError::NotFinite { shape: shape(), vertex });
        }
        if spec.origin == Origin::File && spec.radius.is_none() {
            return Ok(Self::at(mesh, spec.origin, DVec3::ZERO, 1.0));
        }
        let (centre, size) = ball::smallest_enclosing(&mesh.vertices);
        let scale = match spec.radius {
            None => 1.0,
            Some(radius) if !(radius > 0.0 && radius <= LIMIT) => {
                return Err(VolumeError::Radius { shape: shape(), radius });
            }
            Some(radius) if size == 0.0 => {
                return Err(VolumeError::NoExtent { shape: shape(), radius });
            }
            Some(radius) => f64::from(radius) / size,
        };
        Ok(Self::at(mesh, spec.origin, centre, scale))
    }

    fn at(mesh: &TriangleMesh, origin: Origin, centre: DVec3, scale: f64) -> Self {
        let base = DVec3::from_array(mesh.offset);
        match origin {
            Origin::File => {
                Self { centre: DVec3::ZERO, offset: base, scale, pose_offset: base * scale }
            }
            Origin::Ball => {
                // For a far mesh, the part of the centre that their sum keeps.
                let offset = if mesh.is_far() { base + centre } else { centre };
                let centre = if mesh.is_far() { offset - base } else { centre };
                Self { centre, offset, scale, pose_offset: DVec3::ZERO }
            }
        }
    }

    /// A vertex before it is rounded.
    fn point(&self, vertex: &[f32; 3]) -> DVec3 {
        (in_f64(vertex) - self.centre) * self.scale
    }

    /// An upper bound on the distance of a vertex from scale · (point of the file − offset), or
    /// with the pose's offset from scale · point. It is 0 for a mesh that is not far, whose f32
    /// vertices are what is culled.
    fn rounding(&self, mesh: &TriangleMesh, vertices: &[[f32; 3]]) -> f32 {
        if !mesh.is_far() && mesh.rounding == 0.0 {
            return 0.0;
        }
        let pairs = mesh.vertices.iter().zip(vertices);
        let (mut placed, mut size) = (0.0_f64, 0.0_f64);
        for (vertex, rounded) in pairs {
            placed = placed.max(self.point(vertex).distance(in_f64(rounded)));
            size = size.max(in_f64(vertex).abs().max_element());
        }
        // In f64, the difference and the product round each coordinate twice, and a scaled offset
        // rounds once.
        let size = (size + self.centre.abs().max_element()) * self.scale;
        let scaled = if self.scale == 1.0 { 0.0 } else { self.pose_offset.abs().max_element() };
        let exact = self.centre == DVec3::ZERO && self.scale == 1.0;
        let lost = if exact { 0.0 } else { exp2(-50) * (size + scaled) };
        match f64::from(mesh.rounding) * self.scale + placed + lost {
            0.0 => 0.0,
            moved => up(moved),
        }
    }
}

/// Why a shape can't be built from a mesh.
#[derive(Clone, PartialEq, thiserror::Error)]
pub enum VolumeError {
    /// No vertices.
    #[error("shape `{shape}` has no vertices; {help}", help = self.help())]
    Empty {
        /// The mesh's name.
        shape: String,
    },
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} of shape `{shape}` is not finite; {help}", help = self.help())]
    NotFinite {
        /// The mesh's name.
        shape: String,
        /// The first such vertex, 0-based.
        vertex: usize,
    },
    /// The requested radius is not a positive number within the limit.
    #[error("radius {radius} of shape `{shape}` is not in 0 < radius ≤ 2⁶⁰; {help}", help = self.help())]
    Radius {
        /// The mesh's name.
        shape: String,
        /// The radius as given.
        radius: f32,
    },
    /// The mesh is a single point, which can't be scaled.
    #[error("shape `{shape}` is a single point and can't be scaled to radius {radius}; {help}", help = self.help())]
    NoExtent {
        /// The mesh's name.
        shape: String,
        /// The radius as given.
        radius: f32,
    },
    /// Vertices too far from the body origin for the culler's f32 arithmetic.
    #[error("shape `{shape}` reaches {reach:e} from its origin, beyond the limit of 2⁶⁰ ≈ 1.15e18; {help}", help = self.help())]
    TooLarge {
        /// The mesh's name.
        shape: String,
        /// The largest vertex norm.
        reach: f32,
    },
}

crate::problem::errors!(VolumeError);

impl VolumeError {
    /// How to mend it.
    #[must_use]
    pub fn help(&self) -> &str {
        match self {
            Self::Empty { .. } => "a shape needs at least one vertex: check the mesh file",
            Self::NotFinite { .. } => "coordinates must be finite f32: mend the mesh file",
            Self::Radius { .. } => "give a positive radius, or none to keep the mesh's own size",
            Self::NoExtent { .. } => {
                "leave the radius out: the point is culled as a ball of radius 0"
            }
            Self::TooLarge { .. } => "scale the mesh down, or give a radius",
        }
    }
}
