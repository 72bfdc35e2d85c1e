//! Cases as lines of JSON: `sdop-record`, version 1, with the additional data of a case. Readers
//! ignore unknown keys.
//!
//! Line 1 may have `flag`, `source` and `claims`; a frame has `boxes` for the claims about given
//! boxes, and `bodies` when the set changes, each with its former number as `was` (null for a new
//! body). For some claims it also has `groups` and `excluded`, or `margins`, or `save` and
//! `restore`, or `periods`, which alone are f64 (null for an axis without one). A body of several
//! shapes has `parts` in place of `shape`, so that a reader that knows single shapes alone reports
//! an error.

mod answer;
mod read;

pub(super) use answer::decode;
pub use read::{StoredCase, read};

use serde::{Deserialize, Serialize};

use crate::case::{Case, Frame};
use crate::claim::Claim;
use crate::contestant::{BodyPart, WorldBox};
use crate::json;
use crate::record::{FrameLine, Header};

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
            let parts = frame.parts.as_ref().map_or(Vec::new(), |parts| parts[i].clone());
            Self {
                shape: parts.is_empty().then_some(frame.bodies.shape[i]),
                fixed: !frame.bodies.dynamic[i],
                parts,
                was: frame.was.as_ref().and_then(|was| was[i]),
            }
        };
        (0..frame.bodies.len()).map(body).collect()
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use serde_json::Value;

    use super::*;
    use crate::catalogue::groups;
    use crate::record::ShapeLine;

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
        let group = groups().unwrap().into_iter().find(|g| g.name == "exact/tip-to-tip");
        let case = group.unwrap().case(0, None).unwrap();
        let new = String::from_utf8(encode(&case, &[]).unwrap()).unwrap();
        let x = f64::from(case.shapes[0].ball.radius);
        let old = new.replacen(&format!("{x:?}]"), "7.038531e-26]", 1);
        assert_ne!(old, new);
        let read = |text: &str| read(text.as_bytes(), 1 << 30).map(|read| read.case).unwrap();
        assert_eq!(read(&old).shapes[0].ball.radius.to_bits(), 0x15ae_43fd);
        assert_eq!(read(&new).frames, case.frames);
        let lines = |case: &Case| case.shapes.iter().map(ShapeLine::of).collect::<Vec<_>>();
        assert_eq!(lines(&read(&new)), lines(&case));
    }
}
