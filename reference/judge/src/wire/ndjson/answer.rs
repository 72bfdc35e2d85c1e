//! A program's answers as lines of JSON.

use serde::Deserialize;
use serde_json::Value;

use crate::answer::{Answer, AnswerError};
use crate::wire::{ProgramAnswer, malformed};

#[derive(Deserialize)]
struct AnswerLine {
    frame: u64,
    pairs: Vec<[u32; 2]>,
    ns: Option<u64>,
    nu: Option<u64>,
    nv: Option<u64>,
}

/// An answer without pairs: those of the frame before.
#[derive(Deserialize)]
struct SameLine {
    frame: u64,
    same: bool,
}

/// Reads the answer to a frame.
pub(in crate::wire) fn decode(expected: usize, line: &[u8]) -> Result<ProgramAnswer, AnswerError> {
    match serde_json::from_slice::<AnswerLine>(line) {
        Ok(AnswerLine { frame, pairs, ns, nu, nv }) if frame == expected as u64 => {
            Ok(ProgramAnswer::Answer(Answer { pairs, ns, nu, nv }))
        }
        Ok(AnswerLine { frame, .. }) => Err(AnswerError::OutOfTurn { expected, found: frame }),
        Err(error) => diagnose(expected, line, &error),
    }
}

/// Says what is wrong with a line, or that it skips the case.
fn diagnose(
    expected: usize,
    line: &[u8],
    error: &serde_json::Error,
) -> Result<ProgramAnswer, AnswerError> {
    let value: Value = match serde_json::from_slice(line) {
        Ok(value) => value,
        Err(_) if line.windows(3).any(|word| word.eq_ignore_ascii_case(b"nan")) => {
            let why = "JSON has no NaN: `pairs` are numbers of bodies, `ns` is a whole number";
            return Err(malformed(expected, line, why));
        }
        Err(_) if !line.trim_ascii().starts_with(b"{") => {
            let why = "no answer: standard output is for answers alone, other text goes to \
                       standard error";
            return Err(malformed(expected, line, why));
        }
        Err(error) => return Err(malformed(expected, line, format!("no JSON ({error})"))),
    };
    if let Some(ns) = value.get("ns").filter(|ns| !ns.is_u64() && !ns.is_null()) {
        let why = format!("`ns` is {ns}: it is a whole number of nanoseconds, 0 or more");
        return Err(malformed(expected, line, why));
    }
    if let Ok(SameLine { frame, same: true }) = SameLine::deserialize(&value) {
        let found = frame;
        if found == expected as u64 {
            return Ok(ProgramAnswer::Same);
        }
        return Err(AnswerError::OutOfTurn { expected, found });
    }
    if let Some(why) = value.get("skipped") {
        return Ok(ProgramAnswer::Skipped(
            why.as_str().map_or_else(|| why.to_string(), str::to_owned),
        ));
    }
    Err(malformed(
        expected,
        line,
        format!("no answer ({error}); one is {{\"frame\":{expected},\"pairs\":[[i,j],…]}}"),
    ))
}
