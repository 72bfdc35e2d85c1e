//! Numbers in text files, each with the line it stands on, and records of them.

use crate::mesh::{Problem, check_vertex};

/// A problem with the 1-based line where it shows, if it has one.
pub(super) type Fault = (Option<usize>, Problem);

/// A whitespace-separated word and its 1-based line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Token<'a> {
    pub(super) text: &'a str,
    pub(super) line: usize,
}

impl Token<'_> {
    /// The number written here, rounded to the nearest value of its type.
    pub(super) fn number<T: std::str::FromStr>(&self, what: &str) -> Result<T, Fault> {
        self.text.parse().map_err(|_| {
            let message = format!("{what} should be a number, found {}", excerpt(self.text));
            (
                Some(self.line),
                Problem::malformed(message, "correct the number or the line's layout"),
            )
        })
    }

    /// A whole number.
    pub(super) fn integer(&self, what: &str) -> Result<i64, Fault> {
        self.text.parse().map_err(|_| {
            let message = format!(
                "{what} should be a whole number, found {}",
                excerpt(self.text)
            );
            (
                Some(self.line),
                Problem::malformed(message, "counts and indices have no decimal point"),
            )
        })
    }
}

/// At most 24 characters, quoted and escaped, so that garbage cannot flood a message.
pub(super) fn excerpt(text: &str) -> String {
    let short: String = text.chars().take(24).collect();
    let dots = if short.len() < text.len() { "…" } else { "" };
    format!("{short:?}{dots}")
}

/// The bytes as text without a byte-order mark.
pub(super) fn decode(bytes: &[u8]) -> Result<&str, Fault> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Ok(text.strip_prefix('\u{feff}').unwrap_or(text)),
        Err(error) => {
            let offset = error.valid_up_to();
            let line = bytes[..offset]
                .iter()
                .filter(|&&byte| byte == b'\n')
                .count()
                + 1;
            let message = format!(
                "this is not text: byte {:#04x} at offset {offset}",
                bytes[offset]
            );
            let help = "the file is binary or damaged; does its extension name the right format?";
            Err((Some(line), Problem::malformed(message, help)))
        }
    }
}

/// Splits text into tokens.
pub(super) fn tokens(text: &str) -> Vec<Token<'_>> {
    let words = |(index, line): (usize, _)| {
        str::split_whitespace(line).map(move |text| Token {
            text,
            line: index + 1,
        })
    };
    text.lines().enumerate().flat_map(words).collect()
}

/// The vertex written in the first three tokens.
pub(super) fn position(vertex: usize, tokens: &[Token]) -> Result<[f64; 3], Fault> {
    let mut position = [0.0; 3];
    for (coordinate, token) in position.iter_mut().zip(tokens) {
        *coordinate = between_f32(token.number("a coordinate")?, || {
            token.number("a coordinate")
        })?;
    }
    let line = tokens.first().map(|token| token.line);
    check_vertex(vertex, position).map_err(|problem| (line, problem))?;
    Ok(position)
}

/// The number as an f64 that rounds to the f32 that is nearest to the text. Where an f64 lies in the middle of two f32, the
/// text may lie on either side of it, and is read once more, by `nearest`.
pub(super) fn between_f32<E>(
    number: f64,
    nearest: impl FnOnce() -> Result<f32, E>,
) -> Result<f64, E> {
    let rounded = number as f32;
    let [below, above] = [rounded.next_down(), rounded.next_up()];
    let middle = |other: f32| f64::from(rounded) + f64::from(other) == 2.0 * number;
    if !(middle(below) || middle(above)) {
        return Ok(number);
    }
    let nearest = f64::from(nearest()?);
    Ok(if nearest == f64::from(rounded) {
        number
    } else if nearest > number {
        number.next_up()
    } else {
        number.next_down()
    })
}

/// A place in the tokens. Taking a record by line asks that it fill exactly one line.
pub(super) struct Cursor<'t, 'a> {
    pub(super) tokens: &'t [Token<'a>],
    pub(super) by_line: bool,
    /// How many tokens have been taken.
    pub(super) at: usize,
    /// Whether a triangle has been read.
    pub(super) seen_triangle: bool,
}

impl<'t, 'a> Cursor<'t, 'a> {
    pub(super) fn new(tokens: &'t [Token<'a>], by_line: bool) -> Self {
        Self {
            tokens,
            by_line,
            at: 0,
            seen_triangle: false,
        }
    }

    pub(super) fn rest(&self) -> &'t [Token<'a>] {
        &self.tokens[self.at..]
    }

    /// Vertices and triangles start on lines of their own, however their records are laid out.
    pub(super) fn start_section(&self) -> Result<(), Fault> {
        let (before, after) = (self.at.checked_sub(1), self.rest().first());
        match (before.map(|at| self.tokens[at].line), after) {
            (Some(line), Some(token)) if token.line == line => {
                let message = "a section should start on a line of its own";
                let help = "break the line between the header, the vertices and the triangles";
                Err((Some(line), Problem::malformed(message, help)))
            }
            _ => Ok(()),
        }
    }

    pub(super) fn record(&mut self, numbers: usize, what: &str) -> Result<&'t [Token<'a>], Fault> {
        let rest = self.rest();
        let line = rest.first().or(self.tokens.last()).map(|token| token.line);
        let found = if self.by_line {
            rest.iter()
                .take_while(|token| Some(token.line) == line)
                .count()
        } else {
            rest.len().min(numbers)
        };
        if rest.is_empty() || (found < numbers && !self.by_line) {
            let message = format!("the file ends where {what} should be");
            let help = "the file is cut off, or the counts in its header are too high";
            return Err((line, Problem::malformed(message, help)));
        }
        if found != numbers {
            let message = format!("{what} should be {numbers} numbers on a line, found {found}");
            let help = "correct the line, or the counts in the header";
            return Err((line, Problem::malformed(message, help)));
        }
        self.at += numbers;
        Ok(&rest[..numbers])
    }
}
