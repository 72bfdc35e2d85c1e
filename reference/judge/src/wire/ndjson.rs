//! Cases as lines of JSON: `sdop-record`, version 1, with the additional data of a case. Readers
//! ignore unknown keys.
//!
//! Line 1 may have `flag`, `source` and `claims`; a frame has `boxes` for the claims about given
//! boxes, and `bodies` when the set changes, each with its former number as `was` (null for a new
//! body). For some claims it also has `groups` and `excluded`, or `margins`, or `save` and
//! `restore`, or `periods`, which alone are f64 (null for an axis without one). A body of several
//! shapes has `parts` in place of `shape`, so that a reader that knows single shapes alone reports
//! an error.

use std::io::BufRead;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{ProgramAnswer, malformed};
use crate::answer::{Answer, AnswerError};
use crate::case::{Case, Frame};
use crate::claim::Claim;
use crate::contestant::{BodyPart, Filter, WorldBox};
use crate::json;
use crate::record::{FORMAT, FrameLine, Header, ShapeLine, VERSION};
use sdop::bodies::Bodies;
use sdop::bodies::contract::{check_bodies, check_pose};
use sdop::files::read_line;
use sdop::volume::Shape;

/// A record's first line with the additional fields of a case.
#[derive(Serialize)]
struct CaseHeader {
    #[serde(flatten)]
    record: Header<CaseBody>,
    #[serde(flatten)]
    about: CaseFields,
}

/// The data of a case's first line that a record's doesn't have. It is read separately, because a
/// number of a flattened structure would be rounded twice, to f64 and then to f32.
#[derive(Serialize, Deserialize)]
struct CaseFields {
    #[serde(default, skip_serializing_if = "String::is_empty")]
    flag: String,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    source: String,
    /// The judged claim, then the other claims of the case.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    claims: Vec<Claim>,
}

/// A body: a [`BodyLine`](crate::record::BodyLine), or one of several parts, with its former number
/// in a changed set.
#[derive(Serialize, Deserialize)]
struct CaseBody {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    shape: Option<u32>,
    #[serde(rename = "static")]
    fixed: bool,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    parts: Vec<BodyPart>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    was: Option<u32>,
}

impl CaseBody {
    /// The bodies of a frame, each with its former number if the set changes.
    fn all(frame: &Frame) -> Vec<Self> {
        let body = |i: usize| {
            let parts = frame
                .parts
                .as_ref()
                .map_or(Vec::new(), |parts| parts[i].clone());
            Self {
                shape: parts.is_empty().then_some(frame.bodies.shape[i]),
                fixed: !frame.bodies.dynamic[i],
                parts,
                was: frame.was.as_ref().and_then(|was| was[i]),
            }
        };
        (0..frame.bodies.len()).map(body).collect()
    }

    /// Checks that it has a shape or valid parts, and not both. The shape number is otherwise
    /// checked with the bodies' poses.
    fn check(&self, number: usize, shapes: usize) -> Result<(), String> {
        if self.shape.is_some() != self.parts.is_empty() {
            return Err(format!("body {number} needs either `shape` or `parts`"));
        }
        let at = |part: usize, problem: String| format!("body {number}, part {part}: {problem}");
        for (n, part) in self.parts.iter().enumerate() {
            if part.shape as usize >= shapes {
                return Err(at(n, format!("shape {} of {shapes}", part.shape)));
            }
            let (rotation, translation) = part.rotation_and_translation();
            check_pose(n, &rotation, &translation)
                .map_err(|e| at(n, format!("{} {}; {}", e.quantity, e.value, e.hint)))?;
        }
        Ok(())
    }
}

#[derive(Serialize, Deserialize)]
struct CaseFrame {
    frame: u32,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    bodies: Option<Vec<CaseBody>>,
    poses: Vec<[f32; 7]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    boxes: Option<Vec<WorldBox>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    groups: Option<Vec<[u32; 2]>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    excluded: Option<Vec<[u32; 2]>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    margins: Option<Vec<f32>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    periods: Option<[Option<f64>; 3]>,
    #[serde(default, skip_serializing_if = "is_false")]
    restore: bool,
    #[serde(default, skip_serializing_if = "is_false")]
    save: bool,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pairs: Option<Vec<[u32; 2]>>,
}

fn is_false(value: &bool) -> bool {
    !value
}

/// A whole case for one claim; with the pairs that were reported of each frame, where there are
/// any.
pub(crate) fn encode(case: &Case, reported: &[Vec<[u32; 2]>]) -> serde_json::Result<Vec<u8>> {
    let claim = case.claim;
    let mut first = case.frames.first().map_or(Vec::new(), CaseBody::all);
    first.iter_mut().for_each(|body| body.was = None);
    let others = case.claims.iter().copied().filter(|other| *other != claim);
    let header = CaseHeader {
        record: Header {
            frames: Some(case.frames.len() as u32),
            ..Header::new(&case.name, 0, &case.shapes, first)
        },
        about: CaseFields {
            flag: case.flag.clone(),
            source: case.source.clone(),
            claims: std::iter::once(claim).chain(others).collect(),
        },
    };
    let mut bytes = Vec::new();
    json::to_writer(&mut bytes, &header)?;
    bytes.push(b'\n');
    for (number, frame) in case.frames.iter().enumerate() {
        let line = CaseFrame {
            frame: number as u32,
            bodies: frame.was.as_ref().map(|_| CaseBody::all(frame)),
            poses: FrameLine::poses(&frame.bodies),
            boxes: claim.is_of_boxes().then(|| frame.boxes.clone()),
            groups: frame.filter.as_ref().map(|filter| filter.groups.clone()),
            excluded: frame.filter.as_ref().map(|filter| filter.excluded.clone()),
            margins: frame.margins.clone(),
            periods: frame.periods,
            restore: frame.restore,
            save: frame.save,
            pairs: reported.get(number).cloned(),
        };
        json::to_writer(&mut bytes, &line)?;
        bytes.push(b'\n');
    }
    Ok(bytes)
}

/// A case as read from a file, with the pairs that its frames have.
pub struct StoredCase {
    /// The case.
    pub case: Case,
    /// The pairs of each frame that has some.
    pub pairs: Vec<Option<Vec<[u32; 2]>>>,
    /// Which frames are missing, in words, if some are.
    pub lacks: Option<String>,
}

/// Reads a case or a record whose lines have at most `most` bytes.
///
/// # Errors
/// An invalid line, with its number and what is wrong.
pub fn read(mut input: impl BufRead, most: u64) -> Result<StoredCase, String> {
    let lines = std::iter::from_fn(|| {
        let mut line = Vec::new();
        match read_line(&mut input, most, &mut line) {
            Ok(0) => None,
            read => Some(read.map(|_| line)),
        }
    });
    let mut lines = (1..)
        .zip(lines)
        .filter(|(_, line)| !matches!(line, Ok(line) if line.trim_ascii().is_empty()));
    let Some((_, first)) = lines.next() else {
        return Err("no line in it: the first has the shapes and bodies".to_owned());
    };
    let first = first.map_err(|e| format!("line 1: {e}"))?;
    let header: Header<CaseBody> = parse(1, &first)?;
    let CaseFields {
        flag,
        source,
        claims,
    } = parse(1, &first)?;
    if header.format != FORMAT || header.version != VERSION {
        return Err(format!(
            "line 1: {} {} is not {FORMAT} {VERSION}",
            header.format, header.version
        ));
    }
    let shapes: Vec<Shape> = header
        .shapes
        .iter()
        .map(ShapeLine::built)
        .collect::<Result<_, _>>()
        .map_err(|e| format!("line 1: {e}"))?;
    let (mut bodies, mut frames, mut pairs) = (header.bodies, Vec::new(), Vec::new());
    let mut next = 0;
    for (number, line) in lines {
        let at = |problem: String| format!("line {number}: {problem}");
        let line: CaseFrame = parse(number, &line.map_err(|e| at(e.to_string()))?)?;
        if line.frame < next {
            return Err(at(format!(
                "frame {} follows frame {}",
                line.frame,
                next - 1
            )));
        }
        next = line.frame.saturating_add(1);
        let was = line.bodies.map(|changed| {
            bodies = changed;
            bodies.iter().map(|body| body.was).collect()
        });
        if line.poses.len() != bodies.len() {
            return Err(at(format!(
                "{} poses for {} bodies",
                line.poses.len(),
                bodies.len()
            )));
        }
        let mut posed = Bodies::default();
        for (n, (body, &[x, y, z, w, tx, ty, tz])) in bodies.iter().zip(&line.poses).enumerate() {
            body.check(n, shapes.len()).map_err(at)?;
            let shape = body.shape.or(body.parts.first().map(|part| part.shape));
            posed.push(shape.unwrap_or(0), !body.fixed, [x, y, z, w], [tx, ty, tz]);
        }
        check_bodies(&posed, &shapes).map_err(|e| at(format!("{e}; {}", e.hint)))?;
        let parts = bodies.iter().map(|body| body.parts.clone()).collect();
        let frame = Frame::of_parts(posed, parts, &shapes);
        let mut frame = frame.map_err(|e| at(e.to_string()))?;
        if let Some(boxes) = line.boxes {
            frame.boxes = checked(boxes, bodies.len()).map_err(at)?;
        }
        frame.was = was;
        (frame.restore, frame.save) = (line.restore, line.save);
        frame.periods = line.periods;
        let checked = frame.check_periods();
        checked.map_err(|e| at(format!("{e}; {}", e.help())))?;
        frame.margins = line
            .margins
            .map(|margins| sized(margins, &bodies, "margins"))
            .transpose()
            .map_err(at)?;
        let groups = line
            .groups
            .map(|groups| sized(groups, &bodies, "groups"))
            .transpose()
            .map_err(at)?;
        frame.filter = groups.map(|groups| {
            let mut excluded = line.excluded.unwrap_or_default();
            excluded.sort_unstable();
            Filter { groups, excluded }
        });
        frames.push(frame);
        pairs.push(line.pairs);
    }
    let has_parts = frames.iter().any(|frame: &Frame| frame.parts.is_some());
    let (claim, all) = match has_parts {
        true => (Claim::Parts, &[Claim::Parts][..]),
        false => (Claim::Mesh, Claim::PLAIN),
    };
    let case = Case {
        name: header.scene,
        flag,
        source,
        claim: claims.first().copied().unwrap_or(claim),
        claims: if claims.is_empty() {
            all.to_vec()
        } else {
            claims
        },
        shapes,
        frames,
    };
    let (there, wanted) = (
        case.frames.len(),
        header.frames.unwrap_or(0).max(next) as usize,
    );
    let lacks = (there == 0 || there < wanted)
        .then(|| format!("the record has {there} of its {} frames", wanted.max(1)));
    Ok(StoredCase { case, pairs, lacks })
}

fn parse<T: for<'a> Deserialize<'a>>(number: usize, line: &[u8]) -> Result<T, String> {
    serde_json::from_slice(line).map_err(|e| format!("line {number}: {e}"))
}

/// What a frame has for each body.
fn sized<T>(all: Vec<T>, bodies: &[CaseBody], what: &str) -> Result<Vec<T>, String> {
    if all.len() == bodies.len() {
        return Ok(all);
    }
    Err(format!("{} {what} for {} bodies", all.len(), bodies.len()))
}

fn checked(boxes: Vec<WorldBox>, bodies: usize) -> Result<Vec<WorldBox>, String> {
    if boxes.len() != bodies {
        return Err(format!("{} boxes for {bodies} bodies", boxes.len()));
    }
    let sound = |ends: &WorldBox| {
        ends.iter().all(|x| x.is_finite()) && (0..3).all(|axis| ends[axis] <= ends[axis + 3])
    };
    match boxes.iter().position(|ends| !sound(ends)) {
        Some(at) => Err(format!(
            "box {at}, {:?}, isn't finite with lower ends first",
            boxes[at]
        )),
        None => Ok(boxes),
    }
}

#[derive(Deserialize)]
struct AnswerLine {
    frame: u64,
    pairs: Vec<[u32; 2]>,
    #[serde(default)]
    ns: Option<u64>,
}

/// An answer without pairs: those of the frame before.
#[derive(Deserialize)]
struct SameLine {
    frame: u64,
    same: bool,
}

pub(super) fn decode(expected: usize, line: &[u8]) -> Result<ProgramAnswer, AnswerError> {
    match serde_json::from_slice::<AnswerLine>(line) {
        Ok(AnswerLine { frame, pairs, ns }) if frame == expected as u64 => {
            Ok(ProgramAnswer::Answer(Answer { pairs, ns }))
        }
        Ok(AnswerLine { frame, .. }) => Err(AnswerError::OutOfTurn {
            expected,
            found: frame,
        }),
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
        Err(_)
            if line
                .windows(3)
                .any(|word| word.eq_ignore_ascii_case(b"nan")) =>
        {
            return Err(malformed(expected, line, "NaN is no number of a body"));
        }
        Err(error) => return Err(malformed(expected, line, format!("no JSON ({error})"))),
    };
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;
    use crate::catalogue::groups;

    /// All numbers of a value but groups, which are 32 bits each, and periods, which are f64.
    fn numbers(value: &Value, found: &mut Vec<f64>) {
        match value {
            Value::Number(number) => found.extend(number.as_f64()),
            Value::Array(items) => items.iter().for_each(|item| numbers(item, found)),
            Value::Object(items) => items
                .iter()
                .filter(|(key, _)| !["groups", "periods"].contains(&key.as_str()))
                .for_each(|(_, item)| numbers(item, found)),
            _ => {}
        }
    }

    /// Whatever a program reads as a double is an f32: the number that the reference decides by.
    #[test]
    fn cases_have_exact_numbers() {
        for group in groups().unwrap() {
            let case = group.case(0, None).unwrap();
            let text = encode(&case, &[]).unwrap();
            let mut found = Vec::new();
            for line in text.split(|byte| *byte == b'\n').filter(|l| !l.is_empty()) {
                numbers(&serde_json::from_slice(line).unwrap(), &mut found);
            }
            let rounded = found.iter().find(|x| f64::from(**x as f32) != **x);
            assert_eq!(rounded, None, "{}", case.name);
        }
    }

    /// Old text may have 7.038531e-26, which is the f32 0x15ae43fd. By way of an f64 it would be
    /// the next one.
    #[test]
    fn old_cases_are_rounded_once() {
        let group = groups()
            .unwrap()
            .into_iter()
            .find(|g| g.name == "exact/tip-to-tip");
        let case = group.unwrap().case(0, None).unwrap();
        let new = String::from_utf8(encode(&case, &[]).unwrap()).unwrap();
        let x = f64::from(case.shapes[0].ball.radius);
        let old = new.replacen(&format!("{x:?}]"), "7.038531e-26]", 1);
        assert_ne!(old, new);
        let read = |text: &str| {
            read(text.as_bytes(), 1 << 30)
                .map(|read| read.case)
                .unwrap()
        };
        assert_eq!(read(&old).shapes[0].ball.radius.to_bits(), 0x15ae_43fd);
        assert_eq!(read(&new).frames, case.frames);
        let lines = |case: &Case| case.shapes.iter().map(ShapeLine::of).collect::<Vec<_>>();
        assert_eq!(lines(&read(&new)), lines(&case));
    }
}
