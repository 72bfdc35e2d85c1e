//! Triangle meshes as read from a file: f32 vertices, 0-based index triples.

use glam::Vec3;

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
