//! OFF, the format of Geomview and CGAL: a header, the counts, one line per vertex and one per
//! face.
//!
//! The header's letters say what a vertex has in addition to its position: `ST` texture
//! coordinates, `C` a colour, `N` a normal, `4` a weight, by which the position is divided. A face
//! has its number of corners, their 0-based indices, and perhaps a colour. `#` starts a comment.
//! Files without a header are read too. A record is one line; a file that does not fit this is read
//! without regard to line ends, as Geomview does. Words after the last face are ignored with a
//! warning.

use super::parts::{Faces, RawMesh};
use super::text::{self, LineProblem, Token};
use crate::mesh::{Problem, check_vertex};

/// Reads an OFF file.
pub(super) fn read(bytes: &[u8]) -> Result<RawMesh, LineProblem> {
    let text = text::decode(bytes);
    let without_comment =
        |(number, line): (usize, _)| (number, str::split(line, '#').next().unwrap_or_default());
    let tokens: Vec<Token> =
        text::lines(&text).map(without_comment).flat_map(text::words).collect();
    let (layout, rest) = header(&tokens)?;
    let by_line = OffBody { rest, line: 0, by_line: true }.read(&layout);
    if by_line.as_ref().is_ok_and(|mesh| mesh.warnings.is_empty()) {
        return by_line;
    }
    let free = OffBody { rest, line: 0, by_line: false }.read(&layout);
    free.ok().filter(|mesh| mesh.warnings.is_empty()).map_or(by_line, Ok)
}

/// The numbers that a vertex has.
struct OffLayout {
    weight: bool,
    /// How many numbers follow the position (and the weight), if known.
    extra: Option<usize>,
}

/// Reads the header: letters, and `OFF`.
fn header<'t, 'a>(tokens: &'t [Token<'a>]) -> Result<(OffLayout, &'t [Token<'a>]), LineProblem> {
    let Some((first, rest)) = tokens.split_first() else {
        return Err((None, Problem::NoVertices));
    };
    let refused =
        |message: String, help: &str| Err((Some(first.line), Problem::malformed(message, help)));
    if rest.first().is_some_and(|second| second.is("BINARY")) {
        return refused("this is a binary OFF file".to_owned(), "convert it to text");
    }
    if text::number(first.text).is_some() {
        let layout = OffLayout { weight: false, extra: Some(0) };
        return Ok((layout, tokens)); // no header
    }
    let upper = first.text.to_ascii_uppercase();
    let help = "an OFF file starts with OFF, COFF, NOFF, CNOFF, STOFF or 4OFF";
    let Some(letters) = upper.strip_suffix("OFF") else {
        return refused(format!("this is not OFF: found {}", text::excerpt(first.text)), help);
    };
    let after_texture = letters.strip_prefix("ST");
    let after_colour = after_texture.unwrap_or(letters).trim_start_matches('C');
    let after_normal = after_colour.trim_start_matches('N');
    if !matches!(after_normal, "" | "4") || first.text.ends_with("nOFF") {
        return refused(
            format!("vertices of {} have another number of dimensions", first.text),
            help,
        );
    }
    let normal = if after_colour == after_normal { 0 } else { 3 };
    let texture = if after_texture.is_some() { 2 } else { 0 };
    let colour = letters.contains('C');
    let layout = OffLayout {
        weight: after_normal == "4",
        extra: (!colour).then_some(normal + texture), // colours have three numbers or four
    };
    Ok((layout, rest))
}

/// What is left of the file.
struct OffBody<'t, 'a> {
    rest: &'t [Token<'a>],
    /// The line of the last word that was read.
    line: usize,
    by_line: bool,
}

impl<'t, 'a> OffBody<'t, 'a> {
    fn read(mut self, layout: &OffLayout) -> Result<RawMesh, LineProblem> {
        let counts = self.take(2, || "the numbers of vertices and faces".to_owned())?;
        let [vertices, faces] = [count(&counts[0])?, count(&counts[1])?];
        // The number of edges follows. Some programs omit it, and none uses it.
        let same_line = self.rest.first().is_some_and(|token| token.line == self.line);
        if same_line {
            self.take(1, || "the number of edges".to_owned())?;
        }
        if vertices == 0 {
            return Err((Some(counts[0].line), Problem::NoVertices));
        }
        let mut points = Vec::new();
        for index in 0..vertices {
            points.push(self.vertex(index, vertices, layout)?);
        }
        let mut found = Faces::default();
        for index in 0..faces {
            self.face(index, faces, &mut found)?;
        }
        let mut mesh = found.into_mesh(points, 0)?;
        if let Some(token) = self.rest.first() {
            let message = format!("ignored {} words after the last face", self.rest.len());
            mesh.warnings.push((Some(token.line), message));
        }
        Ok(mesh)
    }

    fn vertex(
        &mut self,
        index: usize,
        count: usize,
        layout: &OffLayout,
    ) -> Result<[f64; 3], LineProblem> {
        let numbers = 3 + usize::from(layout.weight);
        let record = self.take(numbers, || format!("vertex {index} of {count}"))?;
        let mut position = text::position(index, record)?;
        if let Some(weight) = record.get(3) {
            let weight = weight.number("a weight")?;
            position = position.map(|x| x / weight);
            check_vertex(index, position).map_err(|problem| (Some(record[3].line), problem))?;
        }
        match layout.extra {
            _ if self.by_line => self.skip_line(),
            Some(extra) => {
                self.take(extra, || format!("vertex {index} of {count}"))?;
            }
            None => {
                let message = "lines can't be left out where vertices have colours".to_owned();
                return Err((
                    Some(self.line),
                    Problem::malformed(message, "write a line for each vertex"),
                ));
            }
        }
        Ok(position)
    }

    fn face(&mut self, index: usize, faces: usize, found: &mut Faces) -> Result<(), LineProblem> {
        let what = || format!("face {index} of {faces}");
        let size = &self.take(1, what)?[0];
        let corners = self.take(count(size)?, what)?;
        let corners: Vec<i64> =
            corners.iter().map(|corner| corner.integer("an index")).collect::<Result<_, _>>()?;
        found.add(&corners, Some(size.line));
        if self.by_line {
            self.skip_line();
        }
        Ok(())
    }

    fn take(
        &mut self,
        words: usize,
        what: impl Fn() -> String,
    ) -> Result<&'t [Token<'a>], LineProblem> {
        let Some((taken, rest)) = self.rest.split_at_checked(words) else {
            let last = self.rest.last().map_or(self.line, |token| token.line);
            let message = format!("the file ends where {} should be", what());
            let help = "the file is cut off, or the counts in its header are too high";
            return Err((Some(last), Problem::malformed(message, help)));
        };
        self.line = taken.last().map_or(self.line, |token| token.line);
        self.rest = rest;
        Ok(taken)
    }

    fn skip_line(&mut self) {
        let rest = self.rest.iter().position(|token| token.line != self.line);
        self.rest = &self.rest[rest.unwrap_or(self.rest.len())..];
    }
}

fn count(token: &Token) -> Result<usize, LineProblem> {
    let count = token.integer("a count")?;
    usize::try_from(count).map_err(|_| {
        let message = format!("a count should not be negative, found {count}");
        (Some(token.line), Problem::malformed(message, "correct the count"))
    })
}
