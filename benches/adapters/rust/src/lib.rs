//! The common part of the adapters in Rust: the judge's encoding of cases and answers.

use std::io::{BufRead, Write};
use std::time::Instant;

use serde::Deserialize;
use serde::de::IgnoredAny;

/// A box: lower corner, upper corner.
pub type Box6 = [f32; 6];

/// A body: its shape, and whether it is static.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct Body {
    #[serde(default)]
    pub shape: usize,
    /// Several shapes, which no adapter here has.
    #[serde(default)]
    parts: Option<IgnoredAny>,
    #[serde(rename = "static")]
    pub fixed: bool,
    /// Its number in the frame before; `None` for a new one.
    #[serde(default)]
    was: Option<usize>,
}

/// A shape: its bounding ball, as centre and radius.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct Shape {
    pub ball: [f32; 4],
}

/// A frame. `ids` are permanent numbers of the bodies, counted from 0; `gone` are the ids of
/// removed bodies.
#[derive(Clone, Debug, Default)]
pub struct Frame {
    pub shapes: Vec<Shape>,
    pub bodies: Vec<Body>,
    pub ids: Vec<usize>,
    pub gone: Vec<usize>,
    pub boxes: Vec<Box6>,
    pub poses: Vec<[f32; 7]>,
    /// The groups and mask of each body, for the claim `filter`.
    pub groups: Option<Vec<[u32; 2]>>,
    /// Pairs of bodies that are not to be reported, by position.
    pub excluded: Vec<[usize; 2]>,
}

/// Pairs of ids, in any order and possibly twice, or the reason why the library can't do this case.
pub type Found = Result<Vec<[usize; 2]>, &'static str>;

#[derive(Deserialize)]
struct Line {
    format: Option<String>,
    shapes: Option<Vec<Shape>>,
    bodies: Option<Vec<Body>>,
    frame: Option<usize>,
    boxes: Option<Vec<Box6>>,
    poses: Option<Vec<[f32; 7]>>,
    groups: Option<Vec<[u32; 2]>>,
    excluded: Option<Vec<[usize; 2]>>,
    periods: Option<IgnoredAny>,
}

/// What no adapter here has.
fn beyond_all(frame: &Frame, repeats: bool) -> Option<&'static str> {
    let has_parts = frame.bodies.iter().any(|body| body.parts.is_some());
    if has_parts {
        return Some("a body has one shape");
    }
    repeats.then_some("space does not repeat")
}

/// Answers cases on standard input until it ends, each with a new culler, or prints the version of
/// a crate.
pub fn serve<C: FnMut(&Frame) -> Found>(package: &str, make: impl Fn() -> C) {
    if std::env::args().any(|argument| argument == "--version") {
        println!("{}", version(package));
        return;
    }
    let (mut frame, mut culler, mut next) = (Frame::default(), None, 0);
    for line in std::io::stdin().lock().lines() {
        let line: Line = serde_json::from_str(&line.expect("a line")).expect("a case");
        if line.format.is_some() {
            let (shapes, bodies) = (
                line.shapes.unwrap_or_default(),
                line.bodies.unwrap_or_default(),
            );
            next = bodies.len();
            frame = Frame {
                shapes,
                ids: (0..next).collect(),
                bodies,
                ..Frame::default()
            };
            culler = Some(make());
            continue;
        }
        let Some(find) = &mut culler else { continue }; // the rest of a case that it has skipped
        frame.gone.clear();
        if let Some(bodies) = line.bodies {
            let fresh = |next: &mut usize| (*next, *next += 1).0;
            let ids = bodies.iter().map(|it| {
                it.was
                    .map_or_else(|| fresh(&mut next), |was| frame.ids[was])
            });
            let ids: Vec<usize> = ids.collect();
            frame.gone = frame
                .ids
                .iter()
                .copied()
                .filter(|id| !ids.contains(id))
                .collect();
            (frame.bodies, frame.ids) = (bodies, ids);
        }
        let beyond = beyond_all(&frame, line.periods.is_some());
        (frame.boxes, frame.poses) = (
            line.boxes.unwrap_or_default(),
            line.poses.unwrap_or_default(),
        );
        (frame.groups, frame.excluded) = (line.groups, line.excluded.unwrap_or_default());
        let start = Instant::now();
        let found = beyond.map_or_else(|| find(&frame), Err);
        let (number, ns) = (
            line.frame.unwrap_or_default(),
            start.elapsed().as_nanos() as u64,
        );
        let answer = match found {
            Ok(found) => {
                serde_json::json!({ "frame": number, "pairs": asked(&frame, &found), "ns": ns })
            }
            Err(why) => {
                culler = None;
                serde_json::json!({ "frame": number, "skipped": why })
            }
        };
        let mut out = std::io::stdout().lock();
        writeln!(out, "{answer}")
            .and_then(|()| out.flush())
            .expect("a reader");
    }
}

/// Converts pairs of ids to the judge's form.
fn asked(frame: &Frame, found: &[[usize; 2]]) -> Vec<[usize; 2]> {
    let mut numbers = vec![usize::MAX; frame.ids.iter().max().map_or(0, |most| most + 1)];
    frame
        .ids
        .iter()
        .enumerate()
        .for_each(|(number, &id)| numbers[id] = number);
    let mut pairs: Vec<[usize; 2]> = found
        .iter()
        .map(|pair| pair.map(|id| numbers[id]))
        .collect();
    pairs.iter_mut().for_each(|pair| pair.sort_unstable());
    pairs.retain(|&[i, j]| i < j && !(frame.bodies[i].fixed && frame.bodies[j].fixed));
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// The version of a crate with which this program was built.
fn version(package: &str) -> &'static str {
    let lock = include_str!("../Cargo.lock");
    let named = lock
        .split("[[package]]")
        .find(|it| it.contains(&format!("name = \"{package}\"\n")));
    named
        .and_then(|it| it.split('"').nth(3))
        .unwrap_or_default()
}
