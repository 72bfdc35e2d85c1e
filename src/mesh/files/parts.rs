//! What each format's reader finds in a file; validation makes the mesh of it.

/// What a format's reader finds.
pub(super) struct Parts {
    /// Positions in f64, each of which rounds to the f32 nearest to what the file says.
    pub points: Vec<[f64; 3]>,
    /// The three vertices of each triangle; `None` where each three points are one.
    pub triangles: Option<Vec<[u32; 3]>>,
}

impl Parts {
    /// Vertices and what triangles name of them.
    pub fn indexed(points: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> Self {
        let triangles = Some(triangles);
        Self { points, triangles }
    }

    /// Three points a triangle.
    pub fn soup(points: Vec<[f64; 3]>) -> Self {
        let triangles = None;
        Self { points, triangles }
    }
}
