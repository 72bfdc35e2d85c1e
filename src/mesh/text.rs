//! Numbers in text files, each with the line it stands on.

use glam::Vec3;

use super::{Problem, check_vertex};

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
pub(super) fn position(vertex: usize, tokens: &[Token]) -> Result<Vec3, Fault> {
    let mut coordinates = [0.0; 3];
    for (coordinate, token) in coordinates.iter_mut().zip(tokens) {
        *coordinate = token.number("a coordinate")?;
    }
    let position = Vec3::from_array(coordinates);
    let line = tokens.first().map(|token| token.line);
    check_vertex(vertex, position).map_err(|problem| (line, problem))?;
    Ok(position)
}
