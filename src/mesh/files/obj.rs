//! Wavefront OBJ: the lines `v` and `f`, all into one mesh.
//!
//! Groups, objects, materials and texture coordinates are not read: the first three would split the
//! mesh, the last would double vertices along seams. A line that ends with a backslash continues on
//! the next one, `#` starts a comment anywhere, and a face may refer to later vertices. Polygons
//! are cut into triangles. Faces of one or two vertices become degenerate triangles, so that
//! nothing is lost. What follows x, y and z in a vertex is not read: a colour, or a weight w, which
//! belongs to rational curves and which other programs ignore, too.

use super::parts::{Faces, RawMesh};
use super::text::{self, LineProblem, Token};
use crate::mesh::Problem;

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
    file.faces.into_mesh(file.points, 1)
}

#[derive(Default)]
struct ObjReader {
    points: Vec<[f64; 3]>,
    /// 1-based indices; those out of range as the file has them.
    faces: Faces,
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

    /// `v x y z`, perhaps with a weight or a colour.
    fn add_vertex(&mut self, line: usize, numbers: &[Token]) -> Result<(), LineProblem> {
        if numbers.len() < 3 {
            return Err((Some(line), malformed("a vertex should be `v x y z`")));
        }
        self.points.push(text::position(self.points.len(), numbers)?);
        Ok(())
    }

    /// `f a b c …` with corners a, a/b, a//c or a/b/c, of which only a is used. −1 is the last
    /// vertex read so far.
    fn add_face(&mut self, line: usize, words: &[Token]) -> Result<(), LineProblem> {
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
        self.faces.add(&corners, Some(line));
        Ok(())
    }
}

fn malformed(message: &str) -> Problem {
    let help = "correct the line; OBJ indices start at 1, negative ones count backwards";
    Problem::malformed(message, help)
}
