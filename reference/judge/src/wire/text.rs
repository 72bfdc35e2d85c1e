//! Cases as words between white space: every count precedes what it counts, every f32 is its bits
//! in eight hexadecimal digits, and every f64 in sixteen. The page in `examples/judge` has the
//! grammar.

use std::fmt::Write as _;

use super::{ProgramAnswer, malformed};
use crate::answer::{Answer, AnswerError};
use crate::case::{Case, Frame};
use crate::claim::Claim;
use crate::contestant::{BodyPart, Filter};
use sdop::volume::Shape;

/// A whole case for one claim. Formatting into a String cannot fail.
pub(super) fn encode(case: &Case) -> String {
    let claim = case.claim;
    let mut text = format!("sdop 1 claim {claim} case {}\n", word(&case.name));
    let _ = writeln!(text, "shapes {}", case.shapes.len());
    for shape in &case.shapes {
        write_shape(&mut text, shape);
    }
    let empty = Frame::default();
    let first = case.frames.first().unwrap_or(&empty);
    let _ = writeln!(text, "bodies {}", first.bodies.len());
    for i in 0..first.bodies.len() {
        write_body(&mut text, claim, first, i, None);
    }
    for (number, frame) in case.frames.iter().enumerate() {
        write_frame(&mut text, claim, number, frame);
    }
    text
}

fn write_shape(text: &mut String, shape: &Shape) {
    let (vertices, triangles, slabs) = (&shape.vertices, &shape.triangles, &shape.ordop);
    let _ = writeln!(
        text,
        "shape {} {} {} {}",
        word(&shape.name),
        vertices.len(),
        triangles.len(),
        slabs.lo.len()
    );
    let mut line = |name: &str, numbers: &[f32]| {
        text.push_str(name);
        hex(text, numbers);
    };
    let [x, y, z] = shape.ball.centre;
    line("ball", &[x, y, z, shape.ball.radius]);
    line("basis", slabs.basis.columns.as_flattened());
    line("lo", &slabs.lo);
    line("hi", &slabs.hi);
    for vertex in vertices {
        line("v", vertex);
    }
    for [a, b, c] in triangles {
        let _ = writeln!(text, "t {a} {b} {c}");
    }
}

/// Numbers after a word, to the end of the line.
fn hex(text: &mut String, numbers: &[f32]) {
    words(text, numbers.iter().map(|x| x.to_bits()));
}

fn words(text: &mut String, bits: impl Iterator<Item = u32>) {
    for bits in bits {
        let _ = write!(text, " {bits:08x}");
    }
    text.push('\n');
}

/// A body, with its former number in a changed set, and its parts for the claim that is about them.
fn write_body(text: &mut String, claim: Claim, frame: &Frame, i: usize, was: Option<i64>) {
    let parts = frame.parts.as_ref().map_or(&[][..], |parts| &parts[i]);
    let shape = if parts.is_empty() { i64::from(frame.bodies.shape[i]) } else { -1 };
    let _ = write!(text, "{shape} {}", u32::from(!frame.bodies.dynamic[i]));
    if let Some(was) = was {
        let _ = write!(text, " {was}");
    }
    if claim == Claim::Parts {
        let _ = write!(text, " {}", parts.len());
    }
    text.push('\n');
    for BodyPart { shape, pose } in parts {
        let _ = write!(text, "part {shape}");
        hex(text, pose);
    }
}

fn write_frame(text: &mut String, claim: Claim, number: usize, frame: &Frame) {
    let bodies = &frame.bodies;
    if frame.restore {
        text.push_str("restore\n");
    }
    if let Some(was) = &frame.was {
        let _ = writeln!(text, "change {}", bodies.len());
        for (i, was) in was.iter().enumerate() {
            write_body(text, claim, frame, i, Some(was.map_or(-1, i64::from)));
        }
    }
    if let Some(periods) = frame.periods {
        let [x, y, z] = periods.map(|period| period.unwrap_or(0.0).to_bits());
        let _ = writeln!(text, "periods {x:016x} {y:016x} {z:016x}");
    }
    let _ = writeln!(text, "frame {number} {}", bodies.len());
    for i in 0..bodies.len() {
        text.push('p');
        let mut numbers = [&bodies.rotation[i][..], &bodies.translation[i]].concat();
        if claim.is_of_boxes() {
            numbers.extend(frame.boxes[i]);
        }
        numbers.extend(frame.margins.iter().map(|margins| margins[i]));
        let groups = frame.filter.iter().flat_map(|filter| filter.groups[i]);
        words(text, numbers.iter().map(|x| x.to_bits()).chain(groups));
    }
    if let Some(Filter { excluded, .. }) = &frame.filter {
        let _ = writeln!(text, "excluded {}", excluded.len());
        for [i, j] in excluded {
            let _ = writeln!(text, "{i} {j}");
        }
    }
    if frame.save {
        text.push_str("save\n");
    }
}

/// A name as one word.
fn word(name: &str) -> String {
    let fill = |c: char| if c.is_whitespace() { '_' } else { c };
    if name.is_empty() { "_".to_owned() } else { name.chars().map(fill).collect() }
}

/// `frame N COUNT I J …`, with `ns TIME`, `nu UPDATES` and `nv TESTS` at the end if it likes, or
/// `skip REASON`.
pub(super) fn decode(expected: usize, line: &[u8]) -> Result<ProgramAnswer, AnswerError> {
    let wrong = |why: String| malformed(expected, line, why);
    let text = str::from_utf8(line).map_err(|e| wrong(e.to_string()))?;
    let mut words = text.split_whitespace();
    match words.next() {
        Some("skip") => return Ok(ProgramAnswer::Skipped(words.collect::<Vec<_>>().join(" "))),
        Some("frame" | "same") => {}
        _ => {
            return Err(wrong(format!("no answer; one is `frame {expected} COUNT I J …`")));
        }
    }
    let mut number = |what: &str| -> Result<u64, AnswerError> {
        let word = words.next().ok_or_else(|| wrong(format!("ends before {what}")))?;
        word.parse().map_err(|_| wrong(format!("`{word}` is no {what}")))
    };
    let found = number("frame number")?;
    if found != expected as u64 {
        return Err(AnswerError::OutOfTurn { expected, found });
    }
    if text.trim_start().starts_with("same") {
        return Ok(ProgramAnswer::Same);
    }
    let count = number("count of pairs")?;
    let mut pairs = Vec::new();
    for _ in 0..count {
        let mut body = || -> Result<u32, AnswerError> {
            let id = number("body")?;
            u32::try_from(id).map_err(|_| wrong(format!("`{id}` is no body")))
        };
        pairs.push([body()?, body()?]);
    }
    let mut answer = Answer { pairs, ..Answer::default() };
    while let Some(word) = words.next() {
        let number = match word {
            "ns" => &mut answer.ns,
            "nu" => &mut answer.nu,
            "nv" => &mut answer.nv,
            _ => return Err(wrong(format!("`{word}` follows the {count} pairs"))),
        };
        *number = words.next().and_then(|word| word.parse().ok());
    }
    Ok(ProgramAnswer::Answer(answer))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Answers are read, and what is not an answer is refused.
    #[test]
    fn invalid_answers_are_refused() {
        let pairs = |line: &str| decode(3, line.as_bytes());
        let answer = |pairs: &[[u32; 2]], ns| {
            Ok(ProgramAnswer::Answer(Answer { pairs: pairs.to_vec(), ns, ..Answer::default() }))
        };
        assert_eq!(pairs("frame 3 0"), answer(&[], None));
        assert_eq!(pairs("frame 3 2 0 1 4 5 ns 77\n"), answer(&[[0, 1], [4, 5]], Some(77)));
        let counted = Answer { nu: Some(5), nv: Some(9), ..Answer::default() };
        assert_eq!(pairs("frame 3 0 nv 9 nu 5"), Ok(ProgramAnswer::Answer(counted)));
        assert_eq!(
            [pairs("same 3"), pairs("same 2")],
            [Ok(ProgramAnswer::Same), Err(AnswerError::OutOfTurn { expected: 3, found: 2 })]
        );
        assert_eq!(
            pairs("skip no such thing"),
            Ok(ProgramAnswer::Skipped("no such thing".to_owned()))
        );
        assert_eq!(pairs("frame 2 0"), Err(AnswerError::OutOfTurn { expected: 3, found: 2 }));
        for line in [
            "",
            "frame",
            "frame 3",
            "frame 3 1 0",
            "frame 3 1 0 -1",
            "frame 3 1 nan 1",
            "frame 3 0 1 2",
            "pairs 3 0",
            "frame 3 1 0 99999999999",
        ] {
            assert!(matches!(pairs(line), Err(AnswerError::Malformed { frame: 3, .. })), "{line}");
        }
    }
}
