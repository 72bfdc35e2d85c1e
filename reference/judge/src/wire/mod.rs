//! Cases as bytes for programs, and their answers. Two encodings of one content: lines of JSON, and
//! words.
//!
//! A program reads a header and then frames until its input ends, and answers each frame with one
//! line.

pub mod ndjson;
pub mod text;

use super::answer::{Answer, AnswerError, StopReason};
use super::case::Case;
use sdop::choice::choices;

choices! {
    /// How cases are written for a program.
    Wire, "wire", {
        /// A JSON object a line, as `sdop run --record` writes them.
        Ndjson = "ndjson",
        /// Words and counts, every f32 as eight hexadecimal digits: read by scanf.
        Text = "text",
    }
}

/// A program's answer to a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ProgramAnswer {
    /// Its pairs.
    Answer(Answer),
    /// The pairs of the previous frame still hold.
    Same,
    /// It skips this case, with its reason.
    Skipped(String),
}

impl Wire {
    /// A whole case.
    ///
    /// # Errors
    /// None that the case's numbers can cause.
    pub fn encode(self, case: &Case) -> serde_json::Result<Vec<u8>> {
        match self {
            Self::Ndjson => ndjson::encode(case, &[]),
            Self::Text => Ok(text::encode(case).into_bytes()),
        }
    }

    /// Reads the answer to a frame.
    ///
    /// # Errors
    /// An invalid line, or one about another frame.
    pub fn decode(self, expected: usize, line: &[u8]) -> Result<ProgramAnswer, AnswerError> {
        match self {
            Self::Ndjson => ndjson::decode(expected, line),
            Self::Text => text::decode(expected, line),
        }
    }
}

/// Records what a program answers to a frame.
///
/// # Errors
/// The program skips the case, or repeats an answer before it has given one.
pub fn book(answers: &mut Vec<Answer>, said: ProgramAnswer, line: &[u8]) -> Result<(), StopReason> {
    match said {
        ProgramAnswer::Answer(answer) => answers.push(answer),
        ProgramAnswer::Same => {
            let last = answers.last().cloned();
            let last = last.ok_or_else(|| malformed(0, line, "no frame comes before the first"))?;
            answers.push(Answer { pairs: last.pairs, ..Answer::default() });
        }
        ProgramAnswer::Skipped(why) => {
            let answered = std::mem::take(answers);
            return Err(StopReason::Skipped { why, answered });
        }
    }
    Ok(())
}

/// The beginning of a line, for messages.
pub(super) fn beginning(line: &[u8]) -> String {
    let text = String::from_utf8_lossy(&line[..line.len().min(240)]);
    let short: String = text.trim_end().chars().take(80).collect();
    if short.len() < line.trim_ascii_end().len() { format!("{short}…") } else { short }
}

/// A line that is no answer.
pub(super) fn malformed(frame: usize, line: &[u8], why: impl Into<String>) -> AnswerError {
    AnswerError::Malformed { frame, why: why.into(), line: beginning(line) }
}
