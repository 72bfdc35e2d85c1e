//! The meshes to draw: each shape in levels of detail, for bodies near and far.

use sdop::mesh::TriangleMesh;
use sdop::volume::{Hull, Shape};

use crate::decimate::decimate;

/// Triangles of the levels, at most. A software renderer draws about 60,000 triangles in the time
/// of a frame.
const LEVELS: [usize; 4] = [3000, 500, 120, 40];

/// One shape, prepared for drawing.
#[derive(Debug)]
pub struct DrawnShape {
    /// The finest first; each has fewer triangles than the one before.
    pub levels: Vec<TriangleMesh>,
    /// The convex hull's vertices, for boxes fitted to the posed body.
    pub hull: Vec<[f32; 3]>,
}

impl DrawnShape {
    /// Decimates a shape's mesh. Only the picture is coarser: numbers and truth are those of the
    /// whole mesh.
    pub fn of(shape: &Shape) -> Self {
        let whole = TriangleMesh {
            name: shape.name.clone(),
            vertices: shape.vertices.clone(),
            triangles: shape.triangles.clone(),
            ..TriangleMesh::default()
        };
        let mut levels = vec![decimate(&whole, LEVELS[0])];
        for most in &LEVELS[1..] {
            let finer = &levels[levels.len() - 1];
            let coarser = decimate(finer, *most);
            // An open boundary may keep a mesh from getting much smaller.
            if 4 * coarser.triangles.len() < 3 * finer.triangles.len() {
                levels.push(coarser);
            }
        }
        let hull = Hull::of(&shape.vertices).points(&shape.vertices);
        Self { levels, hull }
    }
}
