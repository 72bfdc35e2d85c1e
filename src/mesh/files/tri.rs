//! `.tri` files: one extension for several formats, which are distinguished by structure and
//! counts.
//!
//! | name | header | vertex | face | described by |
//! |---|---|---|---|---|
//! | `bourke` | `nv nt` | position, normal, colour | 3 indices from 0 | P. Bourke, "TRI file format", 2001 |
//! | `indexed` | `nv nt` | position | 3 indices from 0 | SINTEF parametrization, NOTES_DATA_FORMAT |
//! | `cart3d` | `nv nt` | position | 3 indices from 1, then perhaps nt component numbers | NASA Cart3D triangulations |
//! | `labelled`, `labelled-1` | `nv nt` | position | count or label, 3 indices from 0 (from 1) | no description found; a leading count or number as in OFF and FreeSurfer |
//! | `openmeeg` | `- nv` | position, normal | after a line `- nt nt nt`: 3 indices from 0 | OpenMEEG, BrainVISA |
//! | `soup` | none | | 9 coordinates, perhaps a colour 0x… | POV-Ray raw triangles; AC3D as OpenFOAM reads it |
//!
//! A dialect *fits* if every number is valid, every index is in range and nothing is left over.
//! Dialects are tried with one record per line first. Only if none of them reads a triangle may
//! records continue over line ends, as Fortran's list-directed output and the raw format allow.
//! Each section must start on a new line even then; otherwise a truncated file could be taken for
//! one of another dialect. If exactly one dialect fits, it is used; if two fit, the error names
//! both. If none fits, the error is that of the dialect that got furthest into the file.

use super::parts::RawMesh;
use super::text::{self, Cursor, LineProblem, Token};
use crate::choice::choices;
use crate::mesh::{Problem, check_triangle};

choices! {
    /// A `.tri` dialect.
    TriFormat, ".tri dialect", {
        /// Position, normal and colour per vertex; indices from 0.
        Bourke = "bourke",
        /// Positions; faces of three indices from 0.
        Indexed = "indexed",
        /// Positions; faces of three indices from 1, perhaps followed by a component number for
        /// each face.
        Cart3d = "cart3d",
        /// Positions; faces of a count or label and three indices from 0.
        Labelled = "labelled",
        /// Positions; faces of a count or label and three indices from 1.
        LabelledFromOne = "labelled-1",
        /// Headers that start with a dash; position and normal per vertex; indices from 0.
        OpenMeeg = "openmeeg",
        /// No header; nine coordinates per triangle.
        Soup = "soup",
    }
}

/// The layout of a dialect that begins with counts.
struct TriLayout {
    dashed: bool,
    vertex_numbers: usize,
    face_numbers: usize,
    first_index: u32,
    components: bool,
}

impl TriFormat {
    /// A description of the dialect.
    pub fn description(self) -> &'static str {
        match self {
            Self::Bourke => "Bourke's format (position, normal and colour a vertex)",
            Self::Indexed => "indexed (faces of three indices from 0)",
            Self::Cart3d => "Cart3D (faces of three indices from 1)",
            Self::Labelled => "labelled (faces of a count or label and three indices from 0)",
            Self::LabelledFromOne => {
                "labelled (faces of a count or label and three indices from 1)"
            }
            Self::OpenMeeg => "OpenMEEG (headers that start with a dash)",
            Self::Soup => "triangle soup (nine coordinates a triangle, no header)",
        }
    }

    fn layout(self) -> Option<TriLayout> {
        let (vertex_numbers, face_numbers, first_index) = match self {
            Self::Bourke => (9, 3, 0),
            Self::Indexed => (3, 3, 0),
            Self::Cart3d => (3, 3, 1),
            Self::Labelled => (3, 4, 0),
            Self::LabelledFromOne => (3, 4, 1),
            Self::OpenMeeg => (6, 3, 0),
            Self::Soup => return None,
        };
        let (dashed, components) = (self == Self::OpenMeeg, self == Self::Cart3d);
        Some(TriLayout { dashed, vertex_numbers, face_numbers, first_index, components })
    }
}

/// Reads a `.tri` file of the given dialect, or of the one that fits.
pub(super) fn read(bytes: &[u8], format: Option<TriFormat>) -> Result<RawMesh, LineProblem> {
    let text = text::decode(bytes);
    let tokens = text::tokens(&text);
    if tokens.is_empty() {
        return Err((None, Problem::NoVertices));
    }
    let mut furthest: Option<(usize, LineProblem)> = None;
    let mut seen_triangle = false;
    for by_line in [true, false] {
        if !by_line && seen_triangle && format.is_none() {
            break;
        }
        let mut fits = Vec::new();
        for candidate in candidates(format, &tokens, by_line) {
            let mut cursor = Cursor::new(&tokens, by_line);
            let parsed = parse(candidate, &mut cursor);
            seen_triangle |= cursor.seen_triangle;
            match parsed {
                Ok(parts) => fits.push((candidate, parts)),
                Err(fault)
                    if by_line && furthest.as_ref().is_none_or(|(at, _)| cursor.at > *at) =>
                {
                    furthest = Some((cursor.at, fault));
                }
                Err(_) => {}
            }
        }
        if fits.len() > 1 {
            return Err((None, ambiguous(&fits)));
        }
        if let Some((_, parts)) = fits.pop() {
            return Ok(parts);
        }
    }
    match furthest {
        Some((at, fault)) if at > HEADER_TOKENS || format.is_some() => Err(fault),
        _ => Err((Some(tokens[0].line), unknown_dialect())),
    }
}

/// The dialects to try. Any nine numbers are a triangle of the dialect `soup`, so that a truncated
/// file of another dialect would fit it when line ends are ignored. In that case a first line like
/// `nv nt` excludes `soup`.
fn candidates(format: Option<TriFormat>, tokens: &[Token], by_line: bool) -> Vec<TriFormat> {
    let first_line: Vec<_> =
        tokens.iter().take_while(|token| token.line == tokens[0].line).collect();
    let counted = first_line.len() == 2 && first_line.iter().all(|token| count(token).is_ok());
    let possible = |candidate: &TriFormat| by_line || !counted || *candidate != TriFormat::Soup;
    match format {
        Some(format) => vec![format],
        None => TriFormat::ALL.iter().copied().filter(possible).collect(),
    }
}

/// The longest header, in words: a dialect that got further has read a vertex or a triangle.
const HEADER_TOKENS: usize = 2;

fn ambiguous(fits: &[(TriFormat, RawMesh)]) -> Problem {
    Problem::Ambiguous {
        readings: fits.iter().map(|(format, _)| format.description()).collect(),
        names: fits.iter().map(|(format, _)| format.name()).collect(),
    }
}

fn unknown_dialect() -> Problem {
    let help = "a .tri file starts with `nv nt` and then vertices of 9 or 3 numbers, with `- nv` and then vertices of \
                6 numbers, or has 9 coordinates on every line";
    Problem::malformed("this is none of the known .tri dialects", help)
}

/// Reads one dialect to the end of the file.
fn parse(format: TriFormat, cursor: &mut Cursor) -> Result<RawMesh, LineProblem> {
    let Some(layout) = format.layout() else {
        return soup(cursor);
    };
    let header = if layout.dashed { "the header `- nv`" } else { "the header `nv nt`" };
    let header = cursor.record(2, header)?;
    let vertex_count = if layout.dashed {
        dash(&header[0])?;
        count(&header[1])?
    } else {
        count(&header[0])?
    };
    cursor.start_section()?;
    let vertices = vertices(cursor, vertex_count, layout.vertex_numbers)?;
    cursor.start_section()?;
    let triangle_count = if layout.dashed {
        let second = cursor.record(4, "the second header `- nt nt nt`")?;
        dash(&second[0])?;
        let nt = count(&second[1])?;
        if count(&second[2])? != nt || count(&second[3])? != nt {
            let message = "the second header `- nt nt nt` has three different counts";
            let help = "write the number of triangles three times";
            return Err((Some(second[1].line), Problem::malformed(message, help)));
        }
        cursor.start_section()?;
        nt
    } else {
        count(&header[1])?
    };
    let triangles = triangles(cursor, triangle_count, &layout, vertices.len())?;
    if layout.components && !cursor.rest().is_empty() {
        cursor.start_section()?;
        component_numbers(cursor, triangle_count)?;
    }
    match cursor.rest().first() {
        None => Ok(RawMesh::indexed(vertices, triangles)),
        Some(token) => {
            let message = format!("{} after the last triangle", excess(cursor.rest().len()));
            let help = "remove what follows, or correct the counts in the header";
            Err((Some(token.line), Problem::malformed(message, help)))
        }
    }
}

fn excess(count: usize) -> String {
    if count == 1 { "1 number too many".to_owned() } else { format!("{count} numbers too many") }
}

fn vertices(
    cursor: &mut Cursor,
    count: usize,
    numbers: usize,
) -> Result<Vec<[f64; 3]>, LineProblem> {
    if count == 0 {
        return Err((None, Problem::NoVertices));
    }
    let mut vertices = Vec::with_capacity(count.min(cursor.tokens.len() / numbers));
    for index in 0..count {
        let record = cursor.record(numbers, &format!("vertex {index} of {count}"))?;
        // Normals and colours are not used; a degenerate mesh has NaN normals. They only have to be
        // numbers.
        for token in &record[3..] {
            token.number("a normal or colour")?;
        }
        vertices.push(text::position(index, record)?);
    }
    Ok(vertices)
}

fn triangles(
    cursor: &mut Cursor,
    count: usize,
    layout: &TriLayout,
    vertices: usize,
) -> Result<Vec<[u32; 3]>, LineProblem> {
    let TriLayout { face_numbers, first_index, .. } = *layout;
    if count == 0 {
        return Err((None, Problem::NoTriangles));
    }
    let mut triangles = Vec::with_capacity(count.min(cursor.tokens.len() / face_numbers));
    for index in 0..count {
        let record = cursor.record(face_numbers, &format!("triangle {index} of {count}"))?;
        let mut numbers = [0; 4];
        for (number, token) in numbers.iter_mut().zip(record) {
            *number = token.integer("an index")?;
        }
        let [a, b, c] = if face_numbers == 4 {
            [numbers[1], numbers[2], numbers[3]]
        } else {
            [numbers[0], numbers[1], numbers[2]]
        };
        check_triangle(index, [a, b, c], first_index, vertices)
            .map_err(|problem| (Some(record[0].line), problem))?;
        triangles.push([a, b, c].map(|i| (i - i64::from(first_index)) as u32));
        cursor.seen_triangle = true;
    }
    Ok(triangles)
}

/// Reads Cart3D's component number per triangle, with any line breaks.
fn component_numbers(cursor: &mut Cursor, triangles: usize) -> Result<(), LineProblem> {
    let numbers = cursor.rest();
    cursor.at = cursor.tokens.len();
    if numbers.len() != triangles {
        let message = format!("{} component numbers for {triangles} triangles", numbers.len());
        let help = "give one component number for each triangle, or none at all";
        return Err((Some(numbers[0].line), Problem::malformed(message, help)));
    }
    numbers.iter().try_for_each(|token| token.integer("a component number").map(|_| ()))
}

fn soup(cursor: &mut Cursor) -> Result<RawMesh, LineProblem> {
    let coordinates = without_colours(cursor.tokens);
    let mut inner = Cursor::new(&coordinates, cursor.by_line);
    let mut points = Vec::new();
    let result = (|| {
        while !inner.rest().is_empty() {
            let record = inner.record(9, "a triangle of three points")?;
            for corner in record.as_chunks::<3>().0 {
                points.push(text::position(points.len(), corner)?);
            }
            cursor.seen_triangle = true;
        }
        Ok(())
    })();
    cursor.at = inner.at;
    result.map(|()| RawMesh::soup(points))
}

/// The tokens without the colours (0xRRGGBB) after each triangle's nine numbers.
fn without_colours<'a>(tokens: &[Token<'a>]) -> Vec<Token<'a>> {
    let mut kept: Vec<Token<'a>> = Vec::with_capacity(tokens.len());
    let mut after_colour = true;
    for token in tokens {
        let closes_triangle = kept.len().is_multiple_of(9) && !after_colour;
        after_colour = closes_triangle && token.text.starts_with("0x");
        if !after_colour {
            kept.push(*token);
        }
    }
    kept
}

fn count(token: &Token) -> Result<usize, LineProblem> {
    token.text.parse().map_err(|_| {
        let message =
            format!("a count should be a whole number, found {}", text::excerpt(token.text));
        let help = "the header names the number of vertices and of triangles";
        (Some(token.line), Problem::malformed(message, help))
    })
}

fn dash(token: &Token) -> Result<(), LineProblem> {
    if token.text == "-" {
        return Ok(());
    }
    let message =
        format!("the header should start with a dash, found {}", text::excerpt(token.text));
    let help = "OpenMEEG writes `- nv` before the vertices and `- nt nt nt` before the triangles";
    Err((Some(token.line), Problem::malformed(message, help)))
}
