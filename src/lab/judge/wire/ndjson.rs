//! Cases as lines of JSON: `sdop-record`, version 1, with what a case has on top. Unknown keys are ignored by readers.
//!
//! Line 1 may have `case`, `flag`, `source` and `claims`; a frame has `boxes` for the claim `aabb`, and `bodies` when the set
//! changes, each with its former number as `was` (null for a new body).

use std::io::BufRead;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{Said, malformed};
use crate::bodies::Bodies;
use crate::bodies::contract::check_bodies;
use crate::files::read_line;
use crate::lab::judge::answer::{Answer, Trouble};
use crate::lab::judge::case::{Case, Frame};
use crate::lab::judge::claim::Claim;
use crate::lab::measure::contestant::WorldBox;
use crate::mesh::TriangleMesh;
use crate::rounding::LIMIT;
use crate::volume::{Ball, Basis, DirectionSet, OrDop, Shape, ShapeSpec, VolumeError};

#[derive(Serialize, Deserialize)]
struct Header {
    format: String,
    version: u32,
    scene: String,
    seed: u64,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    flag: String,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    source: String,
    /// The claim that is asked about, then the others that the case is about.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    claims: Vec<Claim>,
    shapes: Vec<ShapeLine>,
    bodies: Vec<BodyLine>,
}

/// A shape's numbers.
#[derive(Serialize, Deserialize)]
pub struct ShapeLine {
    name: String,
    vertices: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    ball: [f32; 4],
    ordop: OrDopLine,
}

#[derive(Serialize, Deserialize)]
struct OrDopLine {
    k: usize,
    basis: [f32; 9],
    lo: Vec<f32>,
    hi: Vec<f32>,
}

#[derive(Serialize, Deserialize)]
struct BodyLine {
    shape: u32,
    #[serde(rename = "static")]
    fixed: bool,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    was: Option<u32>,
}

#[derive(Serialize, Deserialize)]
struct FrameLine {
    frame: u32,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    bodies: Option<Vec<BodyLine>>,
    poses: Vec<[f32; 7]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    boxes: Option<Vec<WorldBox>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pairs: Option<Vec<[u32; 2]>>,
}

/// A whole case for one claim; with the pairs that were reported of each frame, where there are any.
pub(in crate::lab::judge) fn encode(
    case: &Case,
    claim: Claim,
    reported: &[Vec<[u32; 2]>],
) -> serde_json::Result<Vec<u8>> {
    let empty = Bodies::default();
    let first = case.frames.first().map_or(&empty, |frame| &frame.bodies);
    let others = case.claims.iter().copied().filter(|other| *other != claim);
    let header = Header {
        format: "sdop-record".to_owned(),
        version: 1,
        scene: case.name.clone(),
        seed: 0,
        flag: case.flag.clone(),
        source: case.source.clone(),
        claims: std::iter::once(claim).chain(others).collect(),
        shapes: case.shapes.iter().map(ShapeLine::of).collect(),
        bodies: body_lines(first, None),
    };
    let mut bytes = serde_json::to_vec(&header)?;
    bytes.push(b'\n');
    for (number, frame) in case.frames.iter().enumerate() {
        let poses = frame.bodies.rotation.iter().zip(&frame.bodies.translation);
        let line = FrameLine {
            frame: number as u32,
            bodies: frame
                .was
                .as_deref()
                .map(|was| body_lines(&frame.bodies, Some(was))),
            poses: poses
                .map(|(&[x, y, z, w], &[tx, ty, tz])| [x, y, z, w, tx, ty, tz])
                .collect(),
            boxes: (claim == Claim::Aabb).then(|| frame.boxes.clone()),
            pairs: reported.get(number).cloned(),
        };
        serde_json::to_writer(&mut bytes, &line)?;
        bytes.push(b'\n');
    }
    Ok(bytes)
}

fn body_lines(bodies: &Bodies, was: Option<&[Option<u32>]>) -> Vec<BodyLine> {
    let line = |i: usize| BodyLine {
        shape: bodies.shape[i],
        fixed: !bodies.dynamic[i],
        was: was.and_then(|was| was[i]),
    };
    (0..bodies.len()).map(line).collect()
}

impl ShapeLine {
    /// The numbers of a shape.
    #[must_use]
    pub fn of(shape: &Shape) -> Self {
        let [x, y, z] = shape.ball.centre.to_array();
        let [a, b, c] = shape.ordop.basis.columns.map(|column| column.to_array());
        Self {
            name: shape.name.clone(),
            vertices: shape.vertices.iter().map(|v| v.to_array()).collect(),
            triangles: shape.triangles.clone(),
            ball: [x, y, z, shape.ball.radius],
            ordop: OrDopLine {
                k: shape.ordop.directions.k(),
                basis: [a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2]],
                lo: shape.ordop.lo.clone(),
                hi: shape.ordop.hi.clone(),
            },
        }
    }

    fn shape(self) -> Result<Shape, String> {
        let vertices: Vec<glam::Vec3> = self
            .vertices
            .iter()
            .copied()
            .map(glam::Vec3::from)
            .collect();
        let mesh =
            TriangleMesh::new(self.name, vertices, self.triangles).map_err(|e| e.to_string())?;
        let spec = ShapeSpec {
            origin: crate::volume::Origin::File,
            ..ShapeSpec::default()
        };
        // Built for its reach; ball and or-DOP are the file's.
        let built = Shape::build(&mesh, &spec).map_err(|e: VolumeError| e.to_string())?;
        let directions = DirectionSet::ALL.iter().find(|set| set.k() == self.ordop.k);
        let directions =
            *directions.ok_or_else(|| format!("no or-DOP has k = {}", self.ordop.k))?;
        let [cx, cy, cz, radius] = self.ball;
        let within = |x: &f32| x.abs() <= LIMIT;
        if !(self.ball.iter().all(within) && radius >= 0.0) {
            return Err(format!(
                "the ball {:?} has a number that is negative, not finite or above 2^60",
                self.ball
            ));
        }
        let column = |i: usize| {
            glam::Vec3::new(
                self.ordop.basis[i],
                self.ordop.basis[i + 1],
                self.ordop.basis[i + 2],
            )
        };
        Ok(Shape {
            ball: Ball {
                centre: glam::Vec3::new(cx, cy, cz),
                radius,
            },
            ordop: OrDop {
                directions,
                basis: Basis {
                    columns: [column(0), column(3), column(6)],
                },
                lo: self.ordop.lo,
                hi: self.ordop.hi,
            },
            ..built
        })
    }
}

/// A case as read from a file, with the pairs that its frames have.
pub struct Read {
    /// The case.
    pub case: Case,
    /// The pairs of each frame that has some.
    pub pairs: Vec<Option<Vec<[u32; 2]>>>,
}

/// Reads a case or a record whose lines have at most `most` bytes.
///
/// # Errors
/// A line that is none, with its number and what is wrong.
pub fn read(mut input: impl BufRead, most: u64) -> Result<Read, String> {
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
    let header: Header = parse(1, first)?;
    if header.format != "sdop-record" || header.version != 1 {
        return Err(format!(
            "line 1: {} {} is not sdop-record 1",
            header.format, header.version
        ));
    }
    let shapes: Vec<Shape> = header
        .shapes
        .into_iter()
        .map(ShapeLine::shape)
        .collect::<Result<_, _>>()
        .map_err(|e| format!("line 1: {e}"))?;
    let (mut bodies, mut frames, mut pairs) = (header.bodies, Vec::new(), Vec::new());
    for (number, line) in lines {
        let at = |problem: String| format!("line {number}: {problem}");
        let line: FrameLine = parse(number, line)?;
        let was = line.bodies.is_some();
        bodies = line.bodies.unwrap_or(bodies);
        if line.poses.len() != bodies.len() {
            return Err(at(format!(
                "{} poses for {} bodies",
                line.poses.len(),
                bodies.len()
            )));
        }
        let mut posed = Bodies::default();
        for (body, &[x, y, z, w, tx, ty, tz]) in bodies.iter().zip(&line.poses) {
            posed.push(body.shape, !body.fixed, [x, y, z, w], [tx, ty, tz]);
        }
        check_bodies(&posed, &shapes).map_err(|e| at(format!("{e}; {}", e.hint)))?;
        let mut frame = Frame::fitted(posed, &shapes);
        if let Some(boxes) = line.boxes {
            frame.boxes = checked(boxes, bodies.len()).map_err(at)?;
        }
        frame.was = was.then(|| bodies.iter().map(|body| body.was).collect());
        frames.push(frame);
        pairs.push(line.pairs);
    }
    let case = Case {
        name: header.scene,
        flag: header.flag,
        source: header.source,
        claims: if header.claims.is_empty() {
            Claim::ALL.to_vec()
        } else {
            header.claims
        },
        shapes,
        frames,
    };
    Ok(Read { case, pairs })
}

fn parse<T: for<'a> Deserialize<'a>>(
    number: usize,
    line: std::io::Result<Vec<u8>>,
) -> Result<T, String> {
    let line = line.map_err(|e| format!("line {number}: {e}"))?;
    serde_json::from_slice(&line).map_err(|e| format!("line {number}: {e}"))
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

pub(super) fn decode(expected: usize, line: &[u8]) -> Result<Said, Trouble> {
    match serde_json::from_slice::<AnswerLine>(line) {
        Ok(AnswerLine { frame, pairs, ns }) => match frame == expected as u64 {
            true => Ok(Said::Answer(Answer { pairs, ns })),
            false => Err(Trouble::OutOfTurn {
                expected,
                found: frame,
            }),
        },
        Err(error) => diagnose(expected, line, &error),
    }
}

/// Says what is wrong with a line, or that it skips the case.
fn diagnose(expected: usize, line: &[u8], error: &serde_json::Error) -> Result<Said, Trouble> {
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
    if let Some(why) = value.get("skipped") {
        return Ok(Said::Skipped(
            why.as_str().map_or_else(|| why.to_string(), str::to_owned),
        ));
    }
    Err(malformed(
        expected,
        line,
        format!("no answer ({error}); one is {{\"frame\":{expected},\"pairs\":[[i,j],…]}}"),
    ))
}
