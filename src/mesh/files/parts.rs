//! What each format's reader returns, before validation makes a mesh of it.

/// Points and triangles from a file, not yet validated.
pub(super) struct RawMesh {
    /// Positions in f64, each of which rounds to the f32 nearest to the number in the file.
    pub points: Vec<[f64; 3]>,
    /// The vertices of each triangle; `None` if every three consecutive points are a triangle.
    pub triangles: Option<Vec<[u32; 3]>>,
}

impl RawMesh {
    /// Vertices, and triangles as indices into them.
    pub fn indexed(points: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> Self {
        let triangles = Some(triangles);
        Self { points, triangles }
    }

    /// Three points per triangle, without indices.
    pub fn soup(points: Vec<[f64; 3]>) -> Self {
        let triangles = None;
        Self { points, triangles }
    }
}
