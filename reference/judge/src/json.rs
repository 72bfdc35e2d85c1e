//! JSON in which a number means the same to every reader: an f32 is written as the shortest text of
//! the f64 that equals it.
//!
//! The shortest text that reads back to the same f32 would be shorter, but readers that use
//! doubles, such as Python and JavaScript, would then compute with another number, up to half an
//! f32 ulp away. Our readers accept both.

use std::io;

use serde::Serialize;
use serde_json::ser::{Formatter, Serializer};

/// Writes compact JSON with exact numbers.
struct ExactNumbers;

impl Formatter for ExactNumbers {
    fn write_f32<W: ?Sized + io::Write>(&mut self, writer: &mut W, value: f32) -> io::Result<()> {
        self.write_f64(writer, f64::from(value))
    }
}

/// Writes a value as compact JSON.
///
/// # Errors
/// A writer that fails, or a map whose keys aren't text.
pub fn to_writer(writer: impl io::Write, value: &impl Serialize) -> serde_json::Result<()> {
    value.serialize(&mut Serializer::with_formatter(writer, ExactNumbers))
}

/// A value as compact JSON.
///
/// # Errors
/// A map whose keys aren't text.
pub fn to_string(value: &impl Serialize) -> serde_json::Result<String> {
    let mut bytes = Vec::new();
    to_writer(&mut bytes, value)?;
    String::from_utf8(bytes).map_err(serde::ser::Error::custom)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;

    /// Ordinary, tiny, huge, and the number that a correct Python culler stumbled over.
    const NUMBERS: [f32; 9] = [
        0.1,
        0.048_339_844,
        -0.0,
        1.0,
        16_777_216.0,
        f32::MIN_POSITIVE,
        1e-45,
        f32::MAX,
        -1.234_567_9e-7,
    ];

    #[test]
    fn doubles_read_the_same_number() {
        let text = to_string(&NUMBERS).unwrap();
        let read: Vec<f64> = serde_json::from_str(&text).unwrap();
        let exact = NUMBERS.map(|x| f64::from(x).to_bits());
        assert_eq!(read.iter().map(|x| x.to_bits()).collect::<Vec<_>>(), exact);
        assert!(text.contains("0.04833984375,"), "{text}");
    }

    #[test]
    fn floats_read_old_and_new_text() {
        for text in [to_string(&NUMBERS).unwrap(), serde_json::to_string(&NUMBERS).unwrap()] {
            let read: Vec<f32> = serde_json::from_str(&text).unwrap();
            assert_eq!(read, NUMBERS, "{text}");
        }
    }
}
