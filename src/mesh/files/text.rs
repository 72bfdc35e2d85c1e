//! The text layer of all readers: lines, words and numbers, read as tolerantly as other programs
//! read them.
//!
//! | what | how |
//! |---|---|
//! | bytes | UTF-8, or UTF-16 after its byte-order mark, lossily: other encodings occur only in names and comments, which are ignored |
//! | lines | end with LF, CR LF or CR |
//! | words | are separated by blanks and tabs; keywords in either case |
//! | numbers | as C and Fortran print them: `1.`, `.5`, `+1e3`, `1.0D+05`, `inf`, `-nan(ind)`, `1.#QNAN` |
//! | unused columns | are not read at all |
//!
//! Each format has its own comment sign.

use std::borrow::Cow;
use std::fmt::{Display, LowerExp, Write};

use crate::mesh::{Problem, check_vertex};

/// A problem with its 1-based line, if it has one.
pub(super) type LineProblem = (Option<usize>, Problem);

/// A warning with its 1-based line, if it has one.
pub(super) type LineWarning = (Option<usize>, String);

/// A word and its 1-based line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Token<'a> {
    pub(super) text: &'a str,
    pub(super) line: usize,
}

impl Token<'_> {
    /// Whether this is the keyword, in upper or lower case.
    pub(super) fn is(&self, keyword: &str) -> bool {
        self.text.eq_ignore_ascii_case(keyword)
    }

    /// Parses a number: an f64 that rounds to the f32 nearest to the text.
    pub(super) fn number(&self, what: &str) -> Result<f64, LineProblem> {
        number(self.text).ok_or_else(|| {
            let message = format!("{what} should be a number, found {}", excerpt(self.text));
            let help = "correct the number or the line's layout";
            (Some(self.line), Problem::malformed(message, help))
        })
    }

    /// A whole number.
    pub(super) fn integer(&self, what: &str) -> Result<i64, LineProblem> {
        self.text.parse().map_err(|_| {
            let message = format!("{what} should be a whole number, found {}", excerpt(self.text));
            let help = "counts and indices have no decimal point";
            (Some(self.line), Problem::malformed(message, help))
        })
    }
}

/// At most 24 characters of a text, quoted and escaped, for messages.
pub(super) fn excerpt(text: &str) -> String {
    let short: String = text.chars().take(24).collect();
    let dots = if short.len() < text.len() { "…" } else { "" };
    format!("{short:?}{dots}")
}

/// The bytes as text, without a byte-order mark. Invalid bytes become U+FFFD, which is in no number
/// and no keyword.
pub(super) fn decode(bytes: &[u8]) -> Cow<'_, str> {
    match utf16(bytes) {
        Some(units) => String::from_utf16_lossy(&units).into(),
        None => String::from_utf8_lossy(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)),
    }
}

/// The units of UTF-16, if the bytes begin with its byte-order mark.
pub(super) fn utf16(bytes: &[u8]) -> Option<Vec<u16>> {
    let (unit, text): (fn([u8; 2]) -> u16, _) = match bytes {
        [0xfe, 0xff, text @ ..] => (u16::from_be_bytes, text),
        [0xff, 0xfe, text @ ..] => (u16::from_le_bytes, text),
        _ => return None,
    };
    Some(text.as_chunks().0.iter().map(|&pair| unit(pair)).collect())
}

/// The error for a file in which a text format's reader found nothing and that has a byte which
/// text never has.
pub(super) fn not_text(bytes: &[u8]) -> Option<LineProblem> {
    let offset = bytes.iter().position(|&byte| byte == 0)?;
    let message = format!("this is not text: byte 0x00 at offset {offset}");
    let help = "the file is binary or damaged; does its extension name the right format?";
    Some((None, Problem::malformed(message, help)))
}

/// The lines without their ends, numbered from 1.
pub(super) fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut rest = Some(text);
    let lines = std::iter::from_fn(move || {
        let text = rest?;
        let (line, after) = match text.find(['\n', '\r']) {
            Some(end) => text.split_at(end),
            None => (text, ""),
        };
        rest = after.strip_prefix("\r\n").or_else(|| after.strip_prefix(['\n', '\r']));
        Some(line)
    });
    lines.enumerate().map(|(index, line)| (index + 1, line))
}

/// The words of one line.
pub(super) fn words((line, text): (usize, &str)) -> impl Iterator<Item = Token<'_>> {
    text.split_whitespace().map(move |text| Token { text, line })
}

/// The words of all lines.
pub(super) fn tokens(text: &str) -> Vec<Token<'_>> {
    lines(text).flat_map(words).collect()
}

/// A number in any of the forms that C and Fortran print, as an f64 that rounds to the f32 nearest
/// to the text.
pub(super) fn number(text: &str) -> Option<f64> {
    if let Ok(number) = text.parse() {
        return between_f32(number, || text.parse::<f32>()).ok();
    }
    let lower = text.to_ascii_lowercase();
    let digits = lower.trim_start_matches(['+', '-']);
    if digits.starts_with("nan(") || digits.starts_with("1.#") {
        return Some(f64::NAN); // MSVC's infinities too: neither is a coordinate
    }
    // In a word that starts with a digit, d can only be an exponent.
    let fortran = lower.replacen('d', "e", 1);
    if fortran == lower {
        return None;
    }
    let number = fortran.parse().ok()?;
    between_f32(number, || fortran.parse::<f32>()).ok()
}

/// The vertex written in the first three tokens.
pub(super) fn position(vertex: usize, tokens: &[Token]) -> Result<[f64; 3], LineProblem> {
    let mut position = [0.0; 3];
    for (coordinate, token) in position.iter_mut().zip(tokens) {
        *coordinate = token.number("a coordinate")?;
    }
    let line = tokens.first().map(|token| token.line);
    check_vertex(vertex, position).map_err(|problem| (line, problem))?;
    Ok(position)
}

/// A number as an f64 that rounds to the f32 nearest to the text. If the f64 is exactly between two
/// f32, the text may be on either side of it, and `nearest` parses it again.
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

/// The shortest text that reads back to the same f64, even if that is exactly between two f32.
pub(super) fn wide(x: f64) -> String {
    let text = shortest(x);
    if between_f32(x, || text.parse()) == Ok(x) {
        return text;
    }
    let all_digits = format!("{x:.1074}");
    all_digits.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Appends to a text.
pub(super) fn put(text: &mut String, line: std::fmt::Arguments) {
    // Writing to a String cannot fail.
    let _ = text.write_fmt(line);
}

/// The shorter of the plain and the exponent form that reads back to the same number.
pub(super) fn shortest(value: impl Display + LowerExp) -> String {
    let (plain, exponent) = (format!("{value}"), format!("{value:e}"));
    if exponent.len() < plain.len() { exponent } else { plain }
}

/// A position in the tokens. Reading a record by line requires that it fills exactly one line.
pub(super) struct Cursor<'t, 'a> {
    pub(super) tokens: &'t [Token<'a>],
    pub(super) by_line: bool,
    /// How many tokens have been read.
    pub(super) at: usize,
    /// Whether a triangle has been read.
    pub(super) seen_triangle: bool,
}

impl<'t, 'a> Cursor<'t, 'a> {
    pub(super) fn new(tokens: &'t [Token<'a>], by_line: bool) -> Self {
        Self { tokens, by_line, at: 0, seen_triangle: false }
    }

    pub(super) fn rest(&self) -> &'t [Token<'a>] {
        &self.tokens[self.at..]
    }

    /// Checks that a section starts on a new line, which is required however records are broken
    /// into lines.
    pub(super) fn start_section(&self) -> Result<(), LineProblem> {
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

    pub(super) fn record(
        &mut self,
        numbers: usize,
        what: &str,
    ) -> Result<&'t [Token<'a>], LineProblem> {
        let rest = self.rest();
        let line = rest.first().or(self.tokens.last()).map(|token| token.line);
        let found = if self.by_line {
            rest.iter().take_while(|token| Some(token.line) == line).count()
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
