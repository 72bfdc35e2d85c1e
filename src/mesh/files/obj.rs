//! Wavefront OBJ: the lines `v` and `f`, all into one mesh.
//!
//! Groups, objects, materials and texture coordinates are not read: the first three would split the
//! mesh, the last would double vertices along seams. A line that ends with a backslash continues on
//! the next one, `#` starts a comment anywhere, and a face may refer to later vertices. Polygons
//! become triangle fans. Faces of one or two vertices become degenerate triangles, so that nothing
//! is lost.

use super::parts::RawMesh;
use super::text::{self, LineProblem, Token};
use crate::mesh::{Problem, check_triangle, check_vertex};

/// Reads an OBJ file.
pub(super) fn read(bytes: &[u8]) -> Result<RawMesh, LineProblem> {
    let text = text::decode(bytes);
    let mut file = ObjReader::default();
    let mut words: Vec<Token> = Vec::new();
    for (number, line) in text::lines(&text) {
        let statement = line.split('#').next().unwrap_or_default();
        let continued = statement.trim_end().strip_suffix('\\');
        words.extend(text::words((number, continued.unwrap_or(statement))));
        if continued.is_none() {
            file.add(&words)?;
            words.clear();
        }
    }
    file.add(&words)?;
    if file.points.is_empty()
        && let Some(fault) = text::not_text(bytes)
    {
        return Err(fault);
    }
    file.into_parts()
}

#[derive(Default)]
struct ObjReader {
    points: Vec<[f64; 3]>,
    /// 1-based indices; those out of range as the file has them.
    triangles: Vec<[i64; 3]>,
    /// The line of each triangle.
    lines: Vec<usize>,
}

impl ObjReader {
    fn add(&mut self, words: &[Token]) -> Result<(), LineProblem> {
        match words {
            [keyword, numbers @ ..] if keyword.is("v") => self.add_vertex(keyword.line, numbers),
            [keyword, corners @ ..] if keyword.is("f") || keyword.is("fo") => {
                self.add_face(keyword.line, corners)
            }
            _ => Ok(()),
        }
    }

    /// `v x y z`, perhaps with a weight, by which the coordinates are divided, or with a colour.
    fn add_vertex(&mut self, line: usize, numbers: &[Token]) -> Result<(), LineProblem> {
        if numbers.len() < 3 {
            return Err((Some(line), malformed("a vertex should be `v x y z`")));
        }
        let vertex = self.points.len();
        let mut position = text::position(vertex, numbers)?;
        if let [_, _, _, weight] = numbers {
            let weight = weight.number("a weight")?;
            if weight == 0.0 {
                return Err((Some(line), malformed("the vertex has the weight 0")));
            }
            position = position.map(|x| x / weight);
            check_vertex(vertex, position).map_err(|problem| (Some(line), problem))?;
        }
        self.points.push(position);
        Ok(())
    }

    /// `f a b c …` with corners a, a/b, a//c or a/b/c, of which only a is used. −1 is the last
    /// vertex read so far.
    fn add_face(&mut self, line: usize, words: &[Token]) -> Result<(), LineProblem> {
        if words.is_empty() {
            return Err((Some(line), malformed("the face names no vertices")));
        }
        let so_far = self.points.len() as i64;
        let corner = |word: &Token| {
            let index: i64 = word.text.split('/').next()?.parse().ok()?;
            let from_start = index.saturating_add(so_far + 1);
            Some(if index < 0 && from_start > 0 { from_start } else { index })
        };
        let corners: Option<Vec<i64>> = words.iter().map(corner).collect();
        let Some(corners) = corners else {
            let message = "a face should be `f a b c …`, each a/b/c with whole numbers";
            return Err((Some(line), malformed(message)));
        };
        self.triangles.extend(text::fan(&corners));
        self.lines.resize(self.triangles.len(), line);
        Ok(())
    }

    fn into_parts(self) -> Result<RawMesh, LineProblem> {
        if self.points.is_empty() {
            return Err((None, Problem::NoVertices));
        }
        for (index, (triangle, line)) in self.triangles.iter().zip(&self.lines).enumerate() {
            check_triangle(index, *triangle, 1, self.points.len())
                .map_err(|problem| (Some(*line), problem))?;
        }
        let from_zero = |triangle: &[i64; 3]| triangle.map(|index| (index - 1) as u32);
        let triangles = self.triangles.iter().map(from_zero).collect();
        Ok(RawMesh::indexed(self.points, triangles))
    }
}

fn malformed(message: &str) -> Problem {
    let help = "correct the line; OBJ indices start at 1, negative ones count backwards";
    Problem::malformed(message, help)
}
