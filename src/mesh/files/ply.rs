//! PLY, text and binary: vertices, and faces as polygons or as strips.
//!
//! The header lists elements and their properties. Everything is skipped except the vertices' x, y,
//! z and the lists of indices. Skipped values are not parsed, so a NaN or a word in an unused
//! property is not an error. Polygons are cut into triangles, faces of one or two vertices
//! become degenerate triangles, and strips are unrolled. In text, an element is one line; extra
//! words after its properties are skipped only if the file can't be read otherwise. What follows
//! the last element is ignored with a warning.

use std::iter::Peekable;

use super::parts::{Faces, RawMesh};
use super::ply_header::{Element, Encoding, Header, PropertyUse, Scalar, malformed};
use super::text::{self, LineProblem, LineWarning, Token};
use crate::mesh::{Problem, check_vertex};

/// Reads a PLY file.
pub(super) fn read(bytes: &[u8]) -> Result<RawMesh, LineProblem> {
    if bytes.is_empty() {
        return Err((None, Problem::NoVertices));
    }
    let header = Header::read(bytes)?;
    let data = &bytes[header.size..];
    let mut mesh = match header.encoding {
        Encoding::Binary { big_endian } => {
            read_body(&header, PlyBody::Binary { rest: data, big_endian })
        }
        Encoding::Text => read_text(&header, &text::decode(data)),
    }?;
    mesh.warnings.extend(header.warning());
    Ok(mesh)
}

fn read_text(header: &Header, text: &str) -> Result<RawMesh, LineProblem> {
    let body = |by_line| PlyBody::Text { tokens: tokens(text, header.lines).peekable(), by_line };
    let exact = read_body(header, body(false));
    if exact.as_ref().is_ok_and(|mesh| mesh.warnings.is_empty()) {
        return exact;
    }
    read_body(header, body(true)).map_err(|fault| exact.err().unwrap_or(fault))
}

fn read_body(header: &Header, mut body: PlyBody) -> Result<RawMesh, LineProblem> {
    let mut mesh = PlyMesh::default();
    for element in &header.elements {
        mesh.add(element, &mut body)?;
    }
    let mut mesh = mesh.faces.into_mesh(mesh.points, 0)?;
    mesh.warnings.extend(body.excess());
    Ok(mesh)
}

/// The words of a text that starts after `lines_before` lines.
fn tokens(text: &str, lines_before: usize) -> Box<dyn Iterator<Item = Token<'_>> + '_> {
    let later = move |(line, text): (usize, _)| (line + lines_before, text);
    Box::new(text::lines(text).map(later).flat_map(text::words))
}

/// The data that is not yet read.
enum PlyBody<'a> {
    Text {
        tokens: Peekable<Box<dyn Iterator<Item = Token<'a>> + 'a>>,
        /// Whether extra words on an element's last line are skipped.
        by_line: bool,
    },
    Binary {
        rest: &'a [u8],
        big_endian: bool,
    },
}

/// A value and its line, if the file is text.
struct PlyValue {
    number: f64,
    line: Option<usize>,
}

impl PlyBody<'_> {
    /// The next value, parsed only if it is used; `None` at the end of the file.
    fn next(&mut self, scalar: Scalar, used: bool) -> Option<Result<PlyValue, LineProblem>> {
        match self {
            Self::Text { tokens, .. } => {
                let token = tokens.next()?;
                let line = Some(token.line);
                if !used {
                    return Some(Ok(PlyValue { number: 0.0, line }));
                }
                let number = match scalar {
                    Scalar::F32 | Scalar::F64 => token.number("a value"),
                    // Every integer type is exact in f64, and larger numbers are no valid indices.
                    _ => token.integer("a value").map(|whole| whole as f64),
                };
                Some(number.map(|number| PlyValue { number, line }))
            }
            Self::Binary { rest, big_endian } => {
                let (bytes, after) = rest.split_at_checked(scalar.size())?;
                *rest = after;
                let mut word = [0; 8];
                word[..bytes.len()].copy_from_slice(bytes);
                if *big_endian {
                    word[..bytes.len()].reverse();
                }
                let number = scalar.number(word);
                Some(Ok(PlyValue { number, line: None }))
            }
        }
    }

    /// Reads the next value and stores its line in `line`.
    fn take(
        &mut self,
        scalar: Scalar,
        used: bool,
        line: &mut Option<usize>,
        what: impl Fn() -> String,
    ) -> Result<f64, LineProblem> {
        let value = self.next(scalar, used).ok_or_else(|| {
            let message = format!("the file ends in {}", what());
            (*line, malformed(message))
        })??;
        *line = value.line;
        Ok(value.number)
    }

    /// Ends an element whose last value is on this line.
    fn end_element(&mut self, line: Option<usize>) {
        if let Self::Text { tokens, by_line: true } = self {
            while tokens.next_if(|token| Some(token.line) == line).is_some() {}
        }
    }

    /// A warning about what follows the last element.
    fn excess(&mut self) -> Option<LineWarning> {
        let (line, count, what) = match self {
            Self::Text { tokens, .. } => {
                let line = tokens.peek().map(|token| token.line);
                (line, tokens.count(), "words")
            }
            Self::Binary { rest, .. } => (None, rest.len(), "bytes"),
        };
        (count > 0).then(|| (line, format!("ignored {count} {what} after the last element")))
    }
}

/// The parts of the mesh that were read so far.
#[derive(Default)]
struct PlyMesh {
    points: Vec<[f64; 3]>,
    faces: Faces,
}

impl PlyMesh {
    /// Reads all elements of one kind.
    fn add(&mut self, element: &Element, body: &mut PlyBody) -> Result<(), LineProblem> {
        if element.properties.is_empty() {
            return Ok(()); // takes no bytes, however many the header declares
        }
        for index in 0..element.count {
            let what = || format!("{} {index} of {}", element.name, element.count);
            let mut position = [0.0; 3];
            let mut line = None;
            for property in &element.properties {
                let used = property.used_as != PropertyUse::Nothing;
                let Some(length) = property.length else {
                    let number = body.take(property.scalar, used, &mut line, what)?;
                    if let PropertyUse::Coordinate(axis) = property.used_as {
                        position[axis] = number;
                    }
                    continue;
                };
                let length = body.take(length, true, &mut line, what)?;
                let mut list = Vec::new();
                for _ in 0..length as u64 {
                    let number = body.take(property.scalar, used, &mut line, what)?;
                    if used {
                        list.push(whole(number).ok_or_else(|| {
                            let message = format!("{} has the index {number}", what());
                            (line, malformed(message))
                        })?);
                    }
                }
                self.add_corners(property.used_as, &list, line);
            }
            body.end_element(line);
            if element.name == "vertex" {
                check_vertex(index, position).map_err(|problem| (line, problem))?;
                self.points.push(position);
            }
        }
        Ok(())
    }

    fn add_corners(&mut self, used_as: PropertyUse, corners: &[i64], line: Option<usize>) {
        match used_as {
            PropertyUse::Polygon => self.faces.add(corners, line),
            PropertyUse::Strips => {
                for strip in corners.split(|&corner| corner == -1) {
                    // Every second triangle of a strip has its first two corners exchanged.
                    let turned = |(i, corners): (usize, &[i64])| match (i % 2, corners) {
                        (1, &[a, b, c]) => [b, a, c],
                        (_, corners) => [corners[0], corners[1], corners[2]],
                    };
                    let triangles = strip.windows(3).enumerate().map(turned);
                    triangles.for_each(|triangle| self.faces.add(&triangle, line));
                }
            }
            PropertyUse::Coordinate(_) | PropertyUse::Nothing => {}
        }
    }
}

/// A number as an index, if it is a whole one.
fn whole(number: f64) -> Option<i64> {
    (number == number.trunc() && number.abs() < 2_f64.powi(53)).then_some(number as i64)
}
