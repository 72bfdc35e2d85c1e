//! A case of the judge to be shown, with what a program reported.

use std::ops::Range;
use std::path::Path;

use super::shown_run::{Focus, ShownRun, file_name};
use sdop::bodies::Bodies;
use sdop::mesh::TriangleMesh;
use sdop::settings::{CullSettings, Strategy};
use sdop::volume::{Origin, Shape, ShapeSpec};
use sdop_judge::case::posed_parts;
use sdop_judge::record::{BodyLine, FrameLine, Header};
use sdop_judge::{Case, Frame, truth::Truth};

impl ShownRun {
    /// A case of the judge, and the pairs that a program reported in each frame, sorted; `None` if
    /// no program was run. A pair meets if the claim holds for it. If the set of bodies changes,
    /// only the frames with the set of the first miss are shown.
    ///
    /// # Errors
    /// A text: there are no frames, or the exact reference rejects a number.
    pub fn case(
        case: &Case,
        reported: Option<Vec<Vec<[u32; 2]>>>,
        source: &Path,
    ) -> Result<Self, String> {
        if case.frames.is_empty() {
            return Err("it has no frames".to_owned());
        }
        let asked = reported.is_some();
        let (mut frames, focus) = judged(case, reported)?;
        let shown = with_one_set(case, focus.as_ref().map_or(0, |focus| focus.frame));
        let (shapes, bodies) = drawn(case, &case.frames[shown.start])?;
        let mut header = Header::new(&case.name, 0, &shapes, BodyLine::all(&bodies));
        header.program = Some("the program".to_owned());
        if !asked {
            // No program was run, so nothing is missed.
            header.cull =
                Some(CullSettings { strategy: Strategy::None, ..CullSettings::default() });
        }
        let mut messages = Vec::new();
        if !case.flag.is_empty() {
            messages.push(format!("This case is also meant to catch: {}.", case.flag));
        }
        if shown.len() < case.frames.len() {
            let (first, last) = (shown.start, shown.end - 1);
            messages.push(format!(
                "The set of bodies changes; these are frames {first} to {last} of {}.",
                case.frames.len()
            ));
        }
        let given = &case.frames[shown.clone()];
        let boxes = || given.iter().map(|frame| frame.boxes.clone());
        Ok(Self {
            source: file_name(source),
            header,
            shapes,
            bodies,
            frames: frames.drain(shown.clone()).collect(),
            claim: case.claim,
            boxes: case.claim.is_of_boxes().then(|| boxes().collect()),
            periods: given.iter().map(|frame| frame.periods).collect(),
            focus: focus.map(|focus| Focus { frame: focus.frame - shown.start, ..focus }),
            messages,
        })
    }
}

/// The frames with the pairs that were reported and those that meet, and the first missed pair.
fn judged(
    case: &Case,
    reported: Option<Vec<Vec<[u32; 2]>>>,
) -> Result<(Vec<FrameLine>, Option<Focus>), String> {
    let truth = Truth::new(case.claim, &case.shapes).map_err(|error| error.to_string())?;
    let asked = reported.is_some();
    let mut reported = reported.into_iter().flatten();
    let (mut frames, mut focus) = (Vec::new(), None);
    for (number, frame) in case.frames.iter().enumerate() {
        let pairs = reported.next().unwrap_or_default();
        let meets = truth.pairs(frame).map_err(|error| error.to_string())?;
        let missed = meets.iter().find(|pair| asked && !pairs.contains(pair));
        if let (None, Some(&bodies)) = (&focus, missed) {
            let point = truth.common_point(frame, bodies);
            focus =
                Some(Focus { frame: number, bodies, point: point.map(|point| point.decimals()) });
        }
        frames.push(FrameLine {
            frame: number as u32,
            poses: FrameLine::poses(&frame.bodies),
            translations: None,
            pairs,
            counters: None,
            meets: Some(meets),
        });
    }
    Ok((frames, focus))
}

/// The frames around `frame` that have the same set of bodies.
fn with_one_set(case: &Case, frame: usize) -> Range<usize> {
    let changes = |n: &usize| case.frames[*n].was.is_some();
    let all = case.frames.len();
    let start = (0..=frame).rev().find(changes).unwrap_or(0);
    start..(frame + 1..all).find(changes).unwrap_or(all)
}

/// The shapes and bodies of a frame to be drawn: a body with parts becomes one shape, with vertices
/// rounded to f32.
fn drawn(case: &Case, frame: &Frame) -> Result<(Vec<Shape>, Bodies), String> {
    let (mut shapes, mut bodies) = (case.shapes.clone(), frame.bodies.clone());
    let mut at_origin = Bodies::default();
    at_origin.push(0, true, [0.0, 0.0, 0.0, 1.0], [0.0; 3]);
    let spec = ShapeSpec { origin: Origin::File, ..ShapeSpec::default() };
    for (i, parts) in frame.parts.iter().flatten().enumerate() {
        if parts.is_empty() {
            continue;
        }
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for (shape, pose) in posed_parts(&at_origin, 0, parts).map_err(|e| e.to_string())? {
            let (shape, first) = (&case.shapes[shape as usize], vertices.len() as u32);
            triangles.extend(shape.triangles.iter().map(|t| t.map(|v| v + first)));
            let own = shape.vertices.iter().map(|v| pose.point(&v.map(f64::from)));
            vertices.extend(own.map(|point| point.map(|x| x as f32)));
        }
        let mesh = TriangleMesh::new("parts", vertices, triangles).map_err(|e| e.to_string())?;
        bodies.shape[i] = shapes.len() as u32;
        shapes.push(Shape::build(&mesh, &spec).map_err(|e| e.to_string())?);
    }
    Ok((shapes, bodies))
}
