//! STL, text and binary; equal corners are welded into shared vertices.
//!
//! Binary files may start with `solid` as text files do, so the length decides first: a binary file
//! has exactly 84 + 50·n bytes. If it has more and is not text, the rest is ignored with a warning.
//! In a text file, the names after `solid` and `endsolid` and the normals are ignored, and there
//! may be many solids. A facet is `facet normal`, `outer loop`, its
//! vertices, `endloop`, `endfacet`, in upper or lower case and with any line breaks. Anything else
//! between facets is an error, except comments. Other words after the last `endsolid` are ignored
//! with a warning.

use super::parts::RawMesh;
use super::polygons::Polygon;
use super::text::{self, LineProblem, Token, put, wide};
use crate::mesh::{Problem, TriangleMesh, check_vertex, in_f64};

const HEADER_BYTES: usize = 84;
const TRIANGLE_BYTES: usize = 50;

/// Reads a text or binary STL file.
pub(super) fn read(bytes: &[u8]) -> Result<RawMesh, LineProblem> {
    if bytes.is_empty() {
        return Err((None, Problem::NoVertices));
    }
    let count =
        bytes.get(80..HEADER_BYTES).and_then(|count| count.try_into().ok()).map(u32::from_le_bytes);
    let size = count.map(|n| HEADER_BYTES as u64 + TRIANGLE_BYTES as u64 * u64::from(n));
    if size == Some(bytes.len() as u64) {
        return binary(&bytes[HEADER_BYTES..]);
    }
    // The count of triangles in a binary file below 800 megabytes has a byte 0 here, which text
    // does not have, except UTF-16.
    if bytes.get(83) != Some(&0) || text::utf16(bytes).is_some() {
        let text = text::decode(bytes);
        let tokens = text::tokens(&text);
        if let Some(facets) = start_of_text(&tokens) {
            return facets.read();
        }
    }
    if let (Some(1..), Some(size)) = (count, size)
        && size < bytes.len() as u64
    {
        let mut mesh = binary(&bytes[HEADER_BYTES..size as usize])?;
        let excess = bytes.len() as u64 - size;
        mesh.warnings.push((None, format!("ignored {excess} bytes after the last triangle")));
        return Ok(mesh);
    }
    let message = match (count, size) {
        (Some(n), Some(size)) => format!(
            "a binary STL file of {n} triangles has {size} bytes, this one has {}",
            bytes.len()
        ),
        _ => "this is neither text STL (no `solid`) nor binary STL (under 84 bytes)".to_owned(),
    };
    let help = "the file is cut off, has other data after its end, or is not an STL file";
    Err((None, Problem::malformed(message, help)))
}

/// Reads the triangles of a binary file: a normal, three corners and two more bytes each.
fn binary(bytes: &[u8]) -> Result<RawMesh, LineProblem> {
    let mut points = Vec::with_capacity(3 * bytes.len() / TRIANGLE_BYTES);
    for triangle in bytes.as_chunks::<TRIANGLE_BYTES>().0 {
        let numbers = triangle.as_chunks::<4>().0;
        for corner in numbers[3..12].as_chunks::<3>().0 {
            let position = corner.map(|bytes| f32::from_le_bytes(bytes).into());
            check_vertex(points.len(), position).map_err(|problem| (None, problem))?;
            points.push(position);
        }
    }
    Ok(RawMesh::soup(points))
}

/// The words of a text file, if it begins with a solid or a facet.
fn start_of_text<'t, 'a>(tokens: &'t [Token<'a>]) -> Option<Facets<'t, 'a>> {
    let mut facets = Facets { tokens, points: Vec::new(), polygons: Vec::new() };
    while facets.skip_comment() {}
    let first = facets.tokens.first()?;
    (first.is("solid") || first.is("facet")).then_some(facets)
}

/// The rest of a text file, and the corners read so far, three per triangle.
struct Facets<'t, 'a> {
    tokens: &'t [Token<'a>],
    points: Vec<[f64; 3]>,
    polygons: Vec<Polygon>,
}

impl Facets<'_, '_> {
    fn read(mut self) -> Result<RawMesh, LineProblem> {
        let mut warnings = Vec::new();
        let (mut open, last) = (false, self.tokens.last().map(|token| token.line));
        while !self.tokens.is_empty() {
            if self.skip_comment() {
                continue;
            }
            if self.starts_with(&["endsolid"]) || self.starts_with(&["end", "solid"]) {
                open = false;
                self.skip_line();
            } else if self.starts_with(&["solid"]) {
                open = true;
                self.skip_line();
            } else if !open
                && !self.points.is_empty()
                && !self.tokens.iter().any(|token| token.is("facet"))
            {
                let message = format!("ignored {} words after the last facet", self.tokens.len());
                warnings.push((self.tokens.first().map(|token| token.line), message));
                break;
            } else {
                self.facet()?;
            }
        }
        if open {
            return Err((last, malformed("the file ends before `endsolid`".to_owned())));
        }
        Ok(RawMesh { polygons: self.polygons, warnings, ..RawMesh::soup(self.points) })
    }

    fn starts_with(&self, keywords: &[&str]) -> bool {
        self.tokens.len() >= keywords.len()
            && keywords.iter().zip(self.tokens).all(|(word, token)| token.is(word))
    }

    /// Reads a keyword that may be spelled in two ways.
    fn take(&mut self, keyword: &[&str], other: &[&str]) -> Result<(), LineProblem> {
        for words in [keyword, other] {
            if self.starts_with(words) {
                self.tokens = &self.tokens[words.len()..];
                return Ok(());
            }
        }
        Err(self.missing(&format!("`{}`", keyword.join(" "))))
    }

    fn missing(&self, what: &str) -> LineProblem {
        match self.tokens.first() {
            Some(token) => {
                let message =
                    format!("{what} should stand here, found {}", text::excerpt(token.text));
                (Some(token.line), malformed(message))
            }
            None => (None, malformed(format!("the file ends where {what} should stand"))),
        }
    }

    /// Skips a comment, which ends with its line; returns whether there was one.
    fn skip_comment(&mut self) -> bool {
        let comment =
            |token: &Token| ["#", ";", "//"].iter().any(|mark| token.text.starts_with(mark));
        let found = self.tokens.first().is_some_and(comment);
        if found {
            self.skip_line();
        }
        found
    }

    fn skip_line(&mut self) {
        let line = self.tokens.first().map(|token| token.line);
        let rest = self.tokens.iter().position(|token| Some(token.line) != line);
        self.tokens = &self.tokens[rest.unwrap_or(self.tokens.len())..];
    }

    fn facet(&mut self) -> Result<(), LineProblem> {
        let line = self.tokens.first().map(|token| token.line);
        self.take(&["facet"], &["facet"])?;
        let structure = ["outer", "facet", "vertex", "endfacet", "endsolid"];
        while self.tokens.first().is_some_and(|token| !structure.iter().any(|word| token.is(word)))
        {
            self.tokens = &self.tokens[1..]; // the word `normal` and what follows it
        }
        self.take(&["outer", "loop"], &["outerloop"])?;
        let mut corners = Vec::new();
        while self.starts_with(&["vertex"]) {
            let Some(numbers) = self.tokens.get(1..4) else {
                self.tokens = &[];
                return Err(self.missing("three coordinates"));
            };
            corners.push(text::position(self.points.len() + corners.len(), numbers)?);
            self.tokens = &self.tokens[4..];
        }
        if corners.len() < 3 {
            return Err(self.missing("a facet's `vertex x y z`"));
        }
        self.take(&["endloop"], &["end", "loop"])?;
        self.take(&["endfacet"], &["end", "facet"])?;
        if corners.len() > 3 {
            let first_triangle = self.points.len() / 3;
            self.polygons.push(Polygon { first_triangle, corners: corners.len(), line });
        }
        for edge in corners[1..].windows(2) {
            self.points.extend([corners[0], edge[0], edge[1]]);
        }
        Ok(())
    }
}

fn malformed(message: String) -> Problem {
    let help = "text STL has seven lines per facet: facet normal, outer loop, three times vertex, endloop, endfacet";
    Problem::malformed(message, help)
}

/// The mesh as an STL file: binary, or text if the mesh is far from its origin, because binary STL
/// stores f32. Shared indices and unused vertices are lost; positions are kept to the bit.
pub(super) fn bytes(mesh: &TriangleMesh) -> Vec<u8> {
    if mesh.is_far() {
        return text(mesh).into_bytes();
    }
    let mut bytes = vec![0; HEADER_BYTES - 4];
    // At most u32::MAX triangles: the contract of a mesh.
    bytes.extend((mesh.triangles.len() as u32).to_le_bytes());
    for triangle in &mesh.triangles {
        let corners = triangle.map(|i| mesh.vertices[i as usize]);
        let [a, b, c] = corners;
        for point in [normal(corners), a, b, c] {
            bytes.extend(point.iter().flat_map(|x| x.to_le_bytes()));
        }
        bytes.extend([0; 2]);
    }
    bytes
}

/// The mesh as a text STL file.
fn text(mesh: &TriangleMesh) -> String {
    let points: Vec<[f64; 3]> = mesh.points().collect();
    let mut text = "solid mesh\n".to_owned();
    for triangle in &mesh.triangles {
        let [x, y, z] = normal(triangle.map(|i| mesh.vertices[i as usize]));
        put(&mut text, format_args!("facet normal {x} {y} {z}\nouter loop\n"));
        for corner in triangle {
            let [x, y, z] = points[*corner as usize].map(wide);
            put(&mut text, format_args!("vertex {x} {y} {z}\n"));
        }
        text += "endloop\nendfacet\n";
    }
    text + "endsolid mesh\n"
}

/// A triangle's unit normal; zero where it has none.
fn normal(corners: [[f32; 3]; 3]) -> [f32; 3] {
    let [a, b, c] = corners.each_ref().map(in_f64);
    let normal = (b - a).cross(c - a).normalize_or_zero();
    normal.as_vec3().to_array()
}
