//! STL, parsed by `stl_io`; equal corners are welded into shared vertices.
//!
//! Two habits of real files are settled before `stl_io` sees the bytes. Its test for text is the word `solid`, with which
//! binary headers start too: here the length decides, since a binary file has exactly 84 + 50·n bytes. And it stops at
//! the first `endsolid`, while a text file may hold many solids: each is passed to it by itself.

use std::io::Cursor;

use glam::Vec3;
use stl_io::Triangle;

use super::read::Parts;
use super::text::{self, Fault, between_f32};
use super::write::{put, wide};
use crate::mesh::{Problem, TriangleMesh, check_vertex};

const HEADER_BYTES: usize = 84;
const TRIANGLE_BYTES: u64 = 50;

/// Reads a text or binary STL file.
pub(super) fn read(bytes: &[u8]) -> Result<Parts, Fault> {
    let mut soup = Soup::default();
    if is_binary(bytes)? {
        // The header's text means nothing; blanked, it cannot look like a text file.
        let mut file = bytes.to_vec();
        file[..80].fill(b' ');
        for triangle in triangles(&file).map_err(|error| (None, unreadable(&error)))? {
            let triangle = triangle.map_err(|error| (None, unreadable(&error)))?;
            let corners = triangle.vertices.map(|corner| corner.0.map(f64::from));
            soup.add(corners, None)?;
        }
    } else {
        for (first_line, solid) in solids(text::decode(bytes)?) {
            soup.add_solid(first_line, &solid)?;
        }
    }
    Ok(Parts::soup(soup.points))
}

fn is_binary(bytes: &[u8]) -> Result<bool, Fault> {
    let count = bytes
        .get(80..HEADER_BYTES)
        .and_then(|count| count.try_into().ok())
        .map(u32::from_le_bytes);
    let expected = count.map(|n| HEADER_BYTES as u64 + TRIANGLE_BYTES * u64::from(n));
    if expected == Some(bytes.len() as u64) {
        return Ok(true);
    }
    if bytes.trim_ascii_start().starts_with(b"solid") || bytes.is_empty() {
        return Ok(false);
    }
    let message = match (count, expected) {
        (Some(n), Some(size)) => {
            format!(
                "a binary STL file of {n} triangles has {size} bytes, this one has {}",
                bytes.len()
            )
        }
        _ => "this is neither text STL (no `solid`) nor binary STL (under 84 bytes)".to_owned(),
    };
    Err((
        None,
        Problem::malformed(
            message,
            "the file is cut off, has something appended, or is no STL file",
        ),
    ))
}

/// The solids of a text file with the line each starts on, its first line made what `stl_io` asks for: `solid` and a blank.
fn solids(text: &str) -> Vec<(usize, String)> {
    let mut solids: Vec<(usize, String)> = Vec::new();
    let mut open = false;
    for (index, line) in text.lines().enumerate() {
        let line = line.trim();
        if open {
            if let Some((_, solid)) = solids.last_mut() {
                *solid += line;
                *solid += "\n";
            }
            open = !line.starts_with("endsolid");
        } else if !line.is_empty() {
            solids.push((index + 1, format!("{line} \n")));
            open = true;
        }
    }
    solids
}

fn triangles(file: &[u8]) -> std::io::Result<Vec<std::io::Result<Triangle>>> {
    let mut cursor = Cursor::new(file);
    let reader = stl_io::create_stl_reader(&mut cursor)?;
    let mut triangles = Vec::new();
    // After an error the iterator would go on failing for ever.
    for triangle in reader {
        let failed = triangle.is_err();
        triangles.push(triangle);
        if failed {
            break;
        }
    }
    Ok(triangles)
}

fn unreadable(error: &std::io::Error) -> Problem {
    let help = "text STL has seven lines a facet: facet normal, outer loop, three times vertex, endloop, endfacet";
    Problem::malformed(format!("this is not STL: {error}"), help)
}

#[derive(Default)]
struct Soup {
    /// Three a triangle.
    points: Vec<[f64; 3]>,
}

impl Soup {
    fn add(&mut self, corners: [[f64; 3]; 3], line: Option<usize>) -> Result<(), Fault> {
        for position in corners {
            check_vertex(self.points.len(), position).map_err(|problem| (line, problem))?;
            self.points.push(position);
        }
        Ok(())
    }

    /// Adds the solid that starts on the given line. `stl_io` names no lines, but a facet is seven lines of text.
    fn add_solid(&mut self, first_line: usize, solid: &str) -> Result<(), Fault> {
        if !solid.starts_with("solid ") {
            let message = format!(
                "a solid should start here, found {}",
                text::excerpt(solid.trim_end())
            );
            let help = "remove what follows the last endsolid, or correct the line";
            return Err((Some(first_line), Problem::malformed(message, help)));
        }
        let filled: Vec<usize> = solid
            .lines()
            .enumerate()
            .filter(|(_, line)| !line.trim().is_empty())
            .map(|(index, _)| first_line + index)
            .collect();
        let facet_line = |facet: usize| filled.get(1 + 7 * facet).or(filled.last()).copied();
        let triangles =
            triangles(solid.as_bytes()).map_err(|error| (Some(first_line), unreadable(&error)))?;
        let mut corners = solid.lines().filter_map(corner);
        for (facet, triangle) in triangles.into_iter().enumerate() {
            let line = facet_line(facet);
            let triangle = triangle.map_err(|error| (line, unreadable(&error)))?;
            let rounded = triangle.vertices.map(|corner| corner.0.map(f64::from));
            let corners = rounded.map(|rounded| corners.next().unwrap_or(rounded));
            self.add(corners, line)?;
        }
        Ok(())
    }
}

/// The position of a line `vertex x y z`: what `stl_io` has found sound, in f64.
fn corner(line: &str) -> Option<[f64; 3]> {
    let mut words = line.split_whitespace();
    if words.next() != Some("vertex") {
        return None;
    }
    let mut position = [0.0; 3];
    for coordinate in &mut position {
        let word = words.next()?;
        *coordinate = between_f32(word.parse().ok()?, || word.parse::<f32>()).ok()?;
    }
    Some(position)
}

/// The mesh as an STL file: binary, or text where it is far from its origin, since binary STL has f32. Sharing of vertices is
/// lost, and so are unused ones; positions are kept to the bit.
pub(super) fn bytes(mesh: &TriangleMesh) -> Vec<u8> {
    if mesh.is_far() {
        return text(mesh).into_bytes();
    }
    let facets: Vec<Triangle> = mesh
        .triangles
        .iter()
        .map(|triangle| {
            let [a, b, c] = triangle.map(|i| mesh.vertices[i as usize]);
            Triangle {
                normal: stl_io::Normal::new(normal([a, b, c])),
                vertices: [a, b, c].map(|corner| stl_io::Vertex::new(corner.to_array())),
            }
        })
        .collect();
    let mut bytes = Vec::new();
    // Writing to memory cannot fail.
    let _ = stl_io::write_stl(&mut bytes, facets.iter());
    bytes
}

/// The mesh as a text STL file.
fn text(mesh: &TriangleMesh) -> String {
    let points: Vec<[f64; 3]> = mesh.points().collect();
    let mut text = "solid mesh\n".to_owned();
    for triangle in &mesh.triangles {
        let [x, y, z] = normal(triangle.map(|i| mesh.vertices[i as usize]));
        put(
            &mut text,
            format_args!("facet normal {x} {y} {z}\nouter loop\n"),
        );
        for corner in triangle {
            let [x, y, z] = points[*corner as usize].map(wide);
            put(&mut text, format_args!("vertex {x} {y} {z}\n"));
        }
        text += "endloop\nendfacet\n";
    }
    text + "endsolid mesh\n"
}

/// A triangle's unit normal; zero where it has none.
fn normal(corners: [Vec3; 3]) -> [f32; 3] {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let normal = (b - a).cross(c - a).normalize_or_zero();
    normal.as_vec3().to_array()
}
