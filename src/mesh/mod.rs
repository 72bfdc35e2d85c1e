//! Triangle meshes: validation, readers, writers, topology and procedural shapes.
//!
//! A [`TriangleMesh`] made here keeps the contract that all later stages build on: every coordinate
//! finite and at most 2⁶⁰ in size, every index in range, at least one vertex and one triangle. Degenerate
//! triangles (zero area, repeated indices, a single point as 0 0 0) are legal: they bound, collide and
//! are culled like any other. A mesh without triangles is refused, since no surface of it could intersect
//! anything. Vertices that no triangle uses are kept: they only widen the volumes.

pub mod decimate;
mod error;
#[cfg(feature = "readers")]
mod files;
mod scale;
pub mod shapes;
pub mod topology;

pub use error::{MeshError, Problem};
#[cfg(feature = "readers")]
pub use files::{MeshFormat, ReadOptions, TriFormat, read, read_bytes, write, write_bytes};
pub use scale::Scale;
pub use shapes::ProceduralShape;

use glam::Vec3;

/// The largest coordinate size a mesh may have: 2⁶⁰ (the culler's contract).
pub const MAX_COORDINATE: f32 = (1_u64 << 60) as f32;

/// An indexed triangle mesh. Vertices are in the file's own units and frame (right-handed).
#[derive(Clone, Debug, PartialEq)]
pub struct TriangleMesh {
    /// What messages and tables call the mesh: the file's stem or the procedural shape's name.
    pub name: String,
    /// Vertex positions, all finite.
    pub vertices: Vec<Vec3>,
    /// Vertex indices of each triangle, all in range.
    pub triangles: Vec<[u32; 3]>,
}

impl TriangleMesh {
    /// A mesh of these vertices, and the three vertices of each triangle.
    ///
    /// # Errors
    /// No vertex, no triangle, too many of either, a coordinate that is not finite or larger than 2⁶⁰, or an
    /// index out of range; the error names the mesh, the vertex or triangle, and the remedy.
    pub fn new(
        name: impl Into<String>,
        vertices: Vec<Vec3>,
        triangles: Vec<[u32; 3]>,
    ) -> Result<Self, MeshError> {
        let name = name.into();
        match check(&vertices, &triangles) {
            Ok(()) => Ok(Self {
                name,
                vertices,
                triangles,
            }),
            Err(problem) => Err(problem.at(&name, None)),
        }
    }

    /// The same of vertices that are arrays, or turn into arrays as those of any version of glam do.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn from_arrays(
        name: impl Into<String>,
        vertices: impl IntoIterator<Item = impl Into<[f32; 3]>>,
        triangles: Vec<[u32; 3]>,
    ) -> Result<Self, MeshError> {
        let vertices = vertices.into_iter().map(|v| Vec3::from_array(v.into()));
        Self::new(name, vertices.collect(), triangles)
    }
}

fn check(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<(), Problem> {
    if vertices.is_empty() {
        return Err(Problem::NoVertices);
    }
    if triangles.is_empty() {
        return Err(Problem::NoTriangles);
    }
    for (what, count) in [("vertices", vertices.len()), ("triangles", triangles.len())] {
        if u32::try_from(count).is_err() {
            return Err(Problem::TooMany {
                what,
                count: count as u64,
            });
        }
    }
    for (index, vertex) in vertices.iter().enumerate() {
        check_vertex(index, vertex.to_array().map(f64::from))?;
    }
    for (index, triangle) in triangles.iter().enumerate() {
        check_triangle(index, triangle.map(i64::from), 0, vertices.len())?;
    }
    Ok(())
}

fn check_vertex(vertex: usize, position: [f64; 3]) -> Result<(), Problem> {
    for value in position.map(|x| x as f32) {
        if !value.is_finite() {
            return Err(Problem::NotFinite { vertex, value });
        }
        if value.abs() > MAX_COORDINATE {
            return Err(Problem::TooLarge { vertex, value });
        }
    }
    Ok(())
}

/// Checks one triangle whose indices count from `first`; `vertices` is their number (not zero).
fn check_triangle(
    triangle: usize,
    indices: [i64; 3],
    first: u32,
    vertices: usize,
) -> Result<(), Problem> {
    let last = u64::from(first) + vertices as u64 - 1;
    let allowed =
        |index: i64| u64::try_from(index).is_ok_and(|i| i >= u64::from(first) && i <= last);
    match indices.into_iter().find(|&index| !allowed(index)) {
        None => Ok(()),
        Some(index) => Err(Problem::IndexOutOfRange {
            triangle,
            index,
            first: u64::from(first),
            last,
        }),
    }
}
