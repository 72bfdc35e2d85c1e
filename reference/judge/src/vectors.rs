//! Small cases as data: two bodies each, with the exact answer to every claim, for test suites that
//! don't run this program.
//!
//! `data/vectors/schema.json` describes the files, `sdop cases --vectors data/vectors` makes them.

use serde::Serialize;
use serde_json::Value;

use super::catalogue::{CaseGroup, CatalogueError, groups};
use super::report::NamedFile;
use super::truth::Truth;
use crate::json;
use crate::record::ShapeLine;
use crate::truth::reference_shapes::InvalidInput;

/// What the files' versions count.
pub const VERSION: u32 = 1;
/// Cases a group.
const CASES: u32 = 14;

/// A case.
#[derive(Serialize)]
struct Vector {
    name: String,
    shapes: Vec<ShapeLine>,
    bodies: [BodyLine; 2],
    /// Whether the two bodies meet, by each claim that the case is about.
    meet: serde_json::Map<String, Value>,
}

#[derive(Serialize)]
struct BodyLine {
    shape: u32,
    pose: [f32; 7],
    pose_hex: [String; 7],
    #[serde(rename = "box")]
    ends: [f32; 6],
    box_hex: [String; 6],
}

/// Why there are no vectors.
#[derive(Debug, thiserror::Error)]
pub enum VectorError {
    /// A case that can't be drawn.
    #[error(transparent)]
    Catalogue(#[from] CatalogueError),
    /// A case that the reference refuses.
    #[error(transparent)]
    Input(#[from] InvalidInput),
    /// A number that JSON can't hold: none is drawn.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
}

/// Every file.
///
/// # Errors
/// None that the catalogue's own groups cause.
pub fn files() -> Result<Vec<NamedFile>, VectorError> {
    let mut files = Vec::new();
    for group in groups()? {
        let cases = (0..CASES)
            .filter_map(|n| vector(&group, n).transpose())
            .collect::<Result<Vec<_>, _>>()?;
        if !cases.is_empty() {
            files.push((
                format!("{}.json", group.name.replace('/', "-")),
                text(&group, &cases)?.into_bytes(),
            ));
        }
    }
    Ok(files)
}

fn vector(group: &CaseGroup, number: u32) -> Result<Option<Vector>, VectorError> {
    let Some(case) = group.pair_case(number)? else {
        return Ok(None);
    };
    let frame = &case.frames[0];
    let mut meet = serde_json::Map::new();
    for &claim in &case.claims {
        let truth = Truth::new(claim, &case.shapes)?;
        meet.insert(claim.to_string(), truth.pair(frame, [0, 1])?.into());
    }
    let hex = |x: f32| format!("{:08x}", x.to_bits());
    let body = |i: usize| {
        let ([x, y, z, w], [tx, ty, tz]) = (frame.bodies.rotation[i], frame.bodies.translation[i]);
        let pose = [x, y, z, w, tx, ty, tz];
        BodyLine {
            shape: frame.bodies.shape[i],
            pose,
            pose_hex: pose.map(hex),
            ends: frame.boxes[i],
            box_hex: frame.boxes[i].map(hex),
        }
    };
    Ok(Some(Vector {
        name: case.name.clone(),
        shapes: case.shapes.iter().map(ShapeLine::of).collect(),
        bodies: [body(0), body(1)],
        meet,
    }))
}

/// The file's text: its head, then one case per line.
fn text(group: &CaseGroup, cases: &[Vector]) -> serde_json::Result<String> {
    let quoted = serde_json::to_string;
    let mut text = format!(
        "{{\n\"format\": \"sdop-vectors\", \"version\": {VERSION}, \"group\": {}, \"flag\": {}, \"source\": {},\n\"cases\": [\n",
        quoted(group.name)?,
        quoted(group.flag)?,
        quoted(group.source)?
    );
    for (n, case) in cases.iter().enumerate() {
        let comma = if n + 1 < cases.len() { "," } else { "" };
        text += &format!("{}{comma}\n", json::to_string(case)?);
    }
    text.push_str("]\n}\n");
    Ok(text)
}
