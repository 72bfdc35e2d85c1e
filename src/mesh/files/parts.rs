//! What each format's reader returns, before validation makes a mesh of it.

use super::polygons::Polygon;
use super::text::{LineProblem, LineWarning};
use crate::mesh::{Problem, check_triangle};

/// Points and triangles from a file, not yet validated.
#[derive(Default)]
pub(super) struct RawMesh {
    /// Positions in f64, each of which rounds to the f32 nearest to the number in the file.
    pub points: Vec<[f64; 3]>,
    /// The vertices of each triangle; `None` if every three consecutive points are a triangle.
    pub triangles: Option<Vec<[u32; 3]>>,
    /// The faces of more than three corners.
    pub polygons: Vec<Polygon>,
    /// What in the file breaks its format but could be read or ignored.
    pub warnings: Vec<LineWarning>,
}

impl RawMesh {
    /// Vertices, and triangles as indices into them.
    pub fn indexed(points: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> Self {
        Self { points, triangles: Some(triangles), ..Self::default() }
    }

    /// Three points per triangle, without indices.
    pub fn soup(points: Vec<[f64; 3]>) -> Self {
        Self { points, ..Self::default() }
    }
}

/// The faces of a file, as triangles that are not yet validated.
#[derive(Default)]
pub(super) struct Faces {
    /// Indices as the file counts them.
    triangles: Vec<[i64; 3]>,
    /// The line of each triangle.
    lines: Vec<Option<usize>>,
    polygons: Vec<Polygon>,
    /// The lines of faces without corners.
    empty: Vec<Option<usize>>,
}

impl Faces {
    /// Adds a polygon, as a fan of triangles about its first corner. One or two corners give a
    /// degenerate triangle, so that nothing is lost.
    pub fn add(&mut self, corners: &[i64], line: Option<usize>) {
        if corners.len() > 3 {
            let first_triangle = self.triangles.len();
            self.polygons.push(Polygon { first_triangle, corners: corners.len(), line });
        }
        match *corners {
            [] => self.empty.push(line),
            [a] => self.triangles.push([a, a, a]),
            [a, b] => self.triangles.push([a, b, b]),
            [a, ref rest @ ..] => {
                self.triangles.extend(rest.windows(2).map(|edge| [a, edge[0], edge[1]]));
            }
        }
        self.lines.resize(self.triangles.len(), line);
    }

    /// The mesh of these faces, whose indices count from `first_index`.
    pub fn into_mesh(
        self,
        points: Vec<[f64; 3]>,
        first_index: u32,
    ) -> Result<RawMesh, LineProblem> {
        if points.is_empty() {
            return Err((None, Problem::NoVertices));
        }
        for (index, (triangle, line)) in self.triangles.iter().zip(&self.lines).enumerate() {
            check_triangle(index, *triangle, first_index, points.len())
                .map_err(|problem| (*line, problem))?;
        }
        let from_zero =
            |triangle: &[i64; 3]| triangle.map(|index| (index - i64::from(first_index)) as u32);
        let triangles = self.triangles.iter().map(from_zero).collect();
        let empty = |&line| (line, format!("ignored {} faces without corners", self.empty.len()));
        let warnings = self.empty.first().map(empty).into_iter().collect();
        Ok(RawMesh { polygons: self.polygons, warnings, ..RawMesh::indexed(points, triangles) })
    }
}
