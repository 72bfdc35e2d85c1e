//! Wavefront OBJ, parsed by `tobj`.
//!
//! Only the lines `v` and `f` reach `tobj`. That keeps a mesh in one piece (groups and materials would split it, texture
//! seams would double its vertices), gives every parse error its line, and shields from texture and normal
//! indices near 2⁶⁴, on whose arithmetic `tobj` 4.0 can panic. Polygons become fans; faces of one or two
//! vertices become degenerate triangles, so nothing is lost. `tobj` numbers vertices by first use and drops unused ones;
//! a face of one vertex for each of them, put before the others, makes it keep the file's own order.

use std::borrow::Cow;
use std::io::{BufRead, Read};

use tobj::{LoadError, LoadOptions};

use super::read::Parts;
use super::text::{self, Fault, between_f32};
use crate::mesh::{Problem, check_vertex};

/// Reads an OBJ file.
pub(super) fn read(bytes: &[u8]) -> Result<Parts, Fault> {
    let text = text::decode(bytes)?;
    let count = text
        .lines()
        .filter(|line| keyword(line) == Some("v"))
        .count();
    let every_vertex = (1..=count).map(|index| (0, Cow::from(format!("f {index}"))));
    let mut lines = Lines::new(every_vertex.chain(geometry(text)));
    let options = LoadOptions {
        triangulate: true,
        ..LoadOptions::default()
    };
    let no_materials = |_: &std::path::Path| Ok(Default::default());
    let (models, _) = tobj::load_obj_buf(&mut lines, &options, no_materials)
        .map_err(|error| explain(error, text, lines.number))?;
    // Without `o`, `g` and `usemtl` lines there is exactly one model.
    let mesh = models
        .into_iter()
        .next()
        .map(|model| model.mesh)
        .unwrap_or_default();
    let points: Vec<[f64; 3]> = geometry(text)
        .filter_map(|(_, line)| position(&line))
        .collect();
    let triangles = mesh
        .indices
        .as_chunks()
        .0
        .get(count..)
        .unwrap_or_default()
        .to_vec();
    let mut numbered = points.iter().enumerate();
    match numbered.find_map(|(i, v)| check_vertex(i, *v).err()) {
        None => Ok(Parts::indexed(points, triangles)),
        Some(problem) => Err(find_bad_vertex(text).unwrap_or((None, problem))),
    }
}

/// The lines that describe vertices and faces, with their numbers.
fn geometry(text: &str) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let numbered = text
        .lines()
        .enumerate()
        .map(|(index, line)| (index + 1, line));
    numbered
        .filter(|(_, line)| matches!(keyword(line), Some("v" | "f")))
        .map(|(number, line)| (number, without_colour(line)))
}

/// The position of a line `v x y z`, or `v x y z w` for x/w, y/w and z/w: what `tobj` has found sound, in f64.
fn position(line: &str) -> Option<[f64; 3]> {
    let mut words = line.split_whitespace();
    if words.next() != Some("v") {
        return None;
    }
    let mut position = [0.0; 3];
    for (coordinate, word) in position.iter_mut().zip(&mut words) {
        *coordinate = between_f32(word.parse().ok()?, || word.parse::<f32>()).ok()?;
    }
    match words.next() {
        None => Some(position),
        Some(weight) => {
            let weight: f64 = weight.parse().ok()?;
            Some(position.map(|x| x / weight))
        }
    }
}

fn keyword(line: &str) -> Option<&str> {
    line.split_whitespace().next()
}

/// Turns `tobj`'s error into one with a line. Indices out of range come to light after the last line only,
/// so their line is looked up.
fn explain(error: LoadError, text: &str, line: usize) -> Fault {
    match error {
        LoadError::FaceVertexOutOfBounds | LoadError::InvalidPolygon => {
            find_bad_face(text).unwrap_or((None, malformed("a face names a missing vertex")))
        }
        LoadError::PositionParseError => (Some(line), malformed("a vertex should be `v x y z`")),
        LoadError::ColorParseError => (
            Some(line),
            malformed("a vertex should have 3 numbers, 4 with a weight or 6 with a colour"),
        ),
        LoadError::ScalingByZeroError => (Some(line), malformed("the vertex has the weight 0")),
        LoadError::FaceParseError => (
            Some(line),
            malformed("a face should be `f a b c …`, each a/b/c with whole numbers"),
        ),
        other => (Some(line), malformed(&format!("this is not OBJ: {other}"))),
    }
}

fn malformed(message: &str) -> Problem {
    Problem::malformed(
        message,
        "correct the line; OBJ indices start at 1, negative ones count backwards",
    )
}

/// The first vertex whose coordinates no mesh may have, with its line.
fn find_bad_vertex(text: &str) -> Option<Fault> {
    let tokens = text::tokens(text);
    let lines = tokens.chunk_by(|a, b| a.line == b.line);
    let vertices = lines.filter(|line| line[0].text == "v");
    vertices
        .enumerate()
        .find_map(|(index, line)| text::position(index, &line[1..]).err())
}

/// The first face without vertices or with an index that names none: 1 to n count from the file's start, −1 backwards
/// from the face.
fn find_bad_face(text: &str) -> Option<Fault> {
    let total = text
        .lines()
        .filter(|line| keyword(line) == Some("v"))
        .count();
    let (mut so_far, mut triangle) = (0_usize, 0);
    for (number, line) in text.lines().enumerate() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => so_far += 1,
            Some("f") => {
                let indices: Vec<i64> = words
                    .filter_map(|word| word.split('/').next()?.parse().ok())
                    .collect();
                let bad = |i: &i64| {
                    let limit = if *i < 0 { so_far } else { total };
                    *i == 0 || i.unsigned_abs() > limit as u64
                };
                if indices.is_empty() {
                    return Some((Some(number + 1), malformed("the face names no vertices")));
                }
                if let Some(&index) = indices.iter().find(|i| bad(i)) {
                    let (first, last) = (1, total as u64);
                    let problem = Problem::IndexOutOfRange {
                        triangle,
                        index,
                        first,
                        last,
                    };
                    return Some((Some(number + 1), problem));
                }
                triangle += 1;
            }
            _ => {}
        }
    }
    None
}

/// `v x y z` of a line `v x y z r g b`: `tobj` wants a colour for every vertex or for none, exporters mix them.
fn without_colour(line: &str) -> Cow<'_, str> {
    let words: Vec<&str> = line.split_whitespace().collect();
    match words[..] {
        ["v", x, y, z, _, _, _] => format!("v {x} {y} {z}").into(),
        _ => line.into(),
    }
}

/// Lines as a reader, which knows the number of the line it gave out last.
struct Lines<'a, I> {
    lines: I,
    number: usize,
    line: Cow<'a, str>,
    at: usize,
}

impl<'a, I: Iterator<Item = (usize, Cow<'a, str>)>> Lines<'a, I> {
    fn new(lines: I) -> Self {
        Self {
            lines,
            number: 0,
            line: Cow::default(),
            at: 0,
        }
    }
}

impl<'a, I: Iterator<Item = (usize, Cow<'a, str>)>> BufRead for Lines<'a, I> {
    fn fill_buf(&mut self) -> std::io::Result<&[u8]> {
        if self.at == self.line.len()
            && let Some((number, line)) = self.lines.next()
        {
            (self.number, self.line, self.at) = (number, line + "\n", 0);
        }
        Ok(&self.line.as_bytes()[self.at..])
    }

    fn consume(&mut self, amount: usize) {
        self.at += amount;
    }
}

impl<'a, I: Iterator<Item = (usize, Cow<'a, str>)>> Read for Lines<'a, I> {
    fn read(&mut self, out: &mut [u8]) -> std::io::Result<usize> {
        let read = self.fill_buf()?.read(out)?;
        self.consume(read);
        Ok(read)
    }
}
