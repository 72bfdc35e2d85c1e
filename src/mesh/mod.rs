//! Triangle meshes: validation, readers, writers, topology and procedural shapes.
//!
//! A [`TriangleMesh`] satisfies the contract of all later stages: every coordinate is finite and at
//! most 2⁶⁰ in size, every index is in range, and there are at least one vertex and one triangle.
//! Degenerate triangles (zero area, repeated indices, a single point as 0 0 0) are valid and are
//! culled like any other. A mesh without triangles is an error, because it has no surface that
//! could intersect anything. Vertices that no triangle uses are kept; they only enlarge the
//! volumes.

mod error;
mod far;
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

use glam::DVec3;

/// The largest coordinate size a mesh may have: 2⁶⁰ (the culler's contract).
pub const MAX_COORDINATE: f32 = (1_u64 << 60) as f32;

/// An indexed triangle mesh, in the file's own units and axes (right-handed). A point of the file
/// is offset + vertex.
///
/// The promise of this library is about these f32 vertices, within their `rounding`. Usually the
/// offset is zero and coordinates are rounded to f32; what a file says is what it says in f32. If
/// that would move a vertex by more than 2⁻²⁰ of the mesh's largest extent, the mesh is far from
/// its origin, and its vertices are stored relative to a point near it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// The mesh's name in messages and tables: the file's stem or the procedural shape's name.
    pub name: String,
    /// Vertex positions relative to `offset`, all finite.
    pub vertices: Vec<[f32; 3]>,
    /// Vertex indices of each triangle, all in range.
    pub triangles: Vec<[u32; 3]>,
    /// The origin of `vertices` in the file's coordinates: zero unless the mesh is far from its
    /// origin.
    pub offset: [f64; 3],
    /// An upper bound on the distance of the vertices from f64 points that they were rounded from:
    /// those of [`Self::from_f64`], of a far mesh, or of several meshes as one. Volumes are grown
    /// by it.
    pub rounding: f32,
    /// What a reader had to ignore or to guess, with file and line; worth showing to the user. It
    /// guesses the triangles of faces that cross themselves or are far from flat, which means that
    /// their corners' heights over the mean plane differ by more than an eighth of their extent.
    pub warnings: Vec<String>,
}

impl TriangleMesh {
    /// Makes a mesh from vertices and the three vertex indices of each triangle. Vertices are
    /// arrays or convert into arrays, as those of every version of glam do.
    ///
    /// # Errors
    /// No vertices or triangles, too many of either, a coordinate that is not finite or larger than
    /// 2⁶⁰, or an index out of range. The error names the mesh, the vertex or triangle, and the
    /// remedy.
    pub fn new(
        name: impl Into<String>,
        vertices: impl IntoIterator<Item = impl Into<[f32; 3]>>,
        triangles: Vec<[u32; 3]>,
    ) -> Result<Self, MeshError> {
        let name = name.into();
        let vertices: Vec<[f32; 3]> = vertices.into_iter().map(Into::into).collect();
        let points: Vec<[f64; 3]> = vertices.iter().map(|v| v.map(f64::from)).collect();
        match check(&points, &triangles) {
            Ok(()) => Ok(Self { name, vertices, triangles, ..Self::default() }),
            Err(problem) => Err(problem.at(&name, None)),
        }
    }

    /// Makes a mesh, without a name, from borrowed vertices and triangles.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn from_f32(vertices: &[[f32; 3]], triangles: &[[u32; 3]]) -> Result<Self, MeshError> {
        let mesh = Self::new("mesh", vertices.iter().copied(), triangles.to_vec())?;
        Ok(mesh.named(""))
    }

    /// Makes a mesh, without a name, from borrowed vertices in f64. They are rounded to f32, about
    /// an offset if the mesh is far from its origin, and its volumes are grown by a bound on what
    /// that moves, its `rounding`: no pair of the f64 meshes is missed.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn from_f64(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<Self, MeshError> {
        let mut mesh = Self::rounded(vertices, triangles)?;
        mesh.rounding = far::rounding(vertices, mesh.offset);
        Ok(mesh)
    }

    /// Makes a mesh as a file has it: its vertices are the rounded ones, except that a far mesh
    /// keeps the bound of its rounding.
    fn rounded(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<Self, MeshError> {
        match check(vertices, triangles) {
            Ok(()) => Ok(Self::placed(far::place(vertices), triangles.to_vec())),
            Err(problem) => Err(problem.at("mesh", None)),
        }
    }

    /// Makes a mesh from three points per triangle. Points at equal positions become one vertex.
    #[cfg(feature = "readers")]
    fn from_soup(points: &[[f64; 3]]) -> Result<Self, Problem> {
        let corners: Vec<[u32; 3]> =
            (0..points.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        check(points, &corners)?;
        let mut placed = far::place(points);
        let triangles = files::weld(&mut placed.vertices);
        Ok(Self::placed(placed, triangles))
    }

    fn placed(placed: far::PlacedPoints, triangles: Vec<[u32; 3]>) -> Self {
        Self {
            name: String::new(),
            vertices: placed.vertices,
            triangles,
            offset: placed.offset,
            rounding: placed.rounding,
            warnings: Vec::new(),
        }
    }

    /// The mesh with a name.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self
    }

    /// The vertices in the file's coordinates. This is exact, because an offset has few bits.
    pub fn points(&self) -> impl ExactSizeIterator<Item = [f64; 3]> + '_ {
        let coordinate = |offset: f64, x: f32| match offset {
            0.0 => f64::from(x), // 0 + −0 would be 0
            _ => offset + f64::from(x),
        };
        let point = move |v: &[f32; 3]| std::array::from_fn(|i| coordinate(self.offset[i], v[i]));
        self.vertices.iter().map(point)
    }

    /// Whether the vertices are relative to a point other than the file's origin.
    #[must_use]
    pub fn is_far(&self) -> bool {
        self.offset != [0.0; 3]
    }
}

/// A vertex in f64.
pub(crate) fn in_f64(vertex: &[f32; 3]) -> DVec3 {
    DVec3::from_array(vertex.map(f64::from))
}

fn check(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<(), Problem> {
    if vertices.is_empty() {
        return Err(Problem::NoVertices);
    }
    if triangles.is_empty() {
        return Err(Problem::NoTriangles);
    }
    for (what, count) in [("vertices", vertices.len()), ("triangles", triangles.len())] {
        if u32::try_from(count).is_err() {
            return Err(Problem::TooMany { what, count: count as u64 });
        }
    }
    for (index, vertex) in vertices.iter().enumerate() {
        check_vertex(index, *vertex)?;
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

/// Checks one triangle whose indices count from `first`; `vertices` is the number of vertices (not
/// zero).
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
        Some(index) => {
            Err(Problem::IndexOutOfRange { triangle, index, first: u64::from(first), last })
        }
    }
}
