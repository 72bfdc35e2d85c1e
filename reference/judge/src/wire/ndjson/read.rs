//! Reads cases and records.

use std::io::BufRead;

use serde::Deserialize;

use super::{CaseBody, CaseFields, CaseFrame};
use crate::case::{Case, Frame};
use crate::claim::Claim;
use crate::contestant::{Filter, WorldBox};
use crate::record::{FORMAT, Header, ShapeLine, VERSION};
use sdop::bodies::Bodies;
use sdop::bodies::contract::check_pose;
use sdop::files::read_line;
use sdop::periodic::PeriodicError;
use sdop::volume::Shape;
use sdop::volume::check_bodies;

/// A case as read from a file, with the pairs that its frames have.
pub struct StoredCase {
    /// The case.
    pub case: Case,
    /// The pairs of each frame that has some.
    pub pairs: Vec<Option<Vec<[u32; 2]>>>,
    /// Which frames are missing, in words, if some are.
    pub lacks: Option<String>,
    /// Claims about volumes that its shapes lack.
    pub without: Vec<Claim>,
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
    let (header, fields) = first_line(&first.map_err(|e| format!("line 1: {e}"))?)?;
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
        let mut line: CaseFrame = parse(number, &line.map_err(|e| at(e.to_string()))?)?;
        if line.frame < next {
            return Err(at(format!("frame {} follows frame {}", line.frame, next - 1)));
        }
        next = line.frame.saturating_add(1);
        let was = line.bodies.take().map(|changed| {
            bodies = changed;
            bodies.iter().map(|body| body.was).collect()
        });
        pairs.push(line.pairs.take());
        let frame = line.of(&bodies, &shapes).map_err(at)?;
        frames.push(Frame { was, ..frame });
    }
    let (there, wanted) = (frames.len(), header.frames.unwrap_or(0).max(next) as usize);
    let lacks = (there == 0 || there < wanted)
        .then(|| format!("the record has {there} of its {} frames", wanted.max(1)));
    let case = fields.case(header.scene, shapes, frames);
    let mut without = Vec::new();
    without.extend(header.shapes.iter().any(|shape| shape.ball.is_none()).then_some(Claim::Sphere));
    without.extend(header.shapes.iter().any(|shape| shape.ordop.is_none()).then_some(Claim::OrDop));
    Ok(StoredCase { case, pairs, lacks, without })
}

fn parse<T: for<'a> Deserialize<'a>>(number: usize, line: &[u8]) -> Result<T, String> {
    serde_json::from_slice(line).map_err(|e| format!("line {number}: {e}"))
}

fn first_line(line: &[u8]) -> Result<(Header<CaseBody>, CaseFields), String> {
    let header: Header<CaseBody> = parse(1, line)?;
    let fields = parse(1, line)?;
    if header.format != FORMAT || header.version != VERSION {
        return Err(format!(
            "line 1: {} {} is not {FORMAT} {VERSION}",
            header.format, header.version
        ));
    }
    Ok((header, fields))
}

impl CaseFields {
    /// The case of these frames. Without claims, it is judged by those of any record.
    fn case(self, name: String, shapes: Vec<Shape>, frames: Vec<Frame>) -> Case {
        let (claim, all) = match frames.iter().any(|frame| frame.parts.is_some()) {
            true => (Claim::Parts, &[Claim::Parts][..]),
            false => (Claim::Mesh, Claim::PLAIN),
        };
        Case {
            name,
            flag: self.flag,
            source: self.source,
            claim: self.claims.first().copied().unwrap_or(claim),
            claims: match self.claims.is_empty() {
                true => all.to_vec(),
                false => self.claims,
            },
            shapes,
            frames,
        }
    }
}

impl CaseFrame {
    /// The frame of these bodies, checked.
    fn of(self, bodies: &[CaseBody], shapes: &[Shape]) -> Result<Frame, String> {
        let posed = posed(bodies, &self.poses, shapes)?;
        let parts = bodies.iter().map(|body| body.parts.clone()).collect();
        let mut frame = Frame::of_parts(posed, parts, shapes).map_err(|e| e.to_string())?;
        if let Some(boxes) = self.boxes {
            frame.boxes = checked(boxes, bodies.len())?;
        }
        (frame.restore, frame.save) = (self.restore, self.save);
        frame.periods = self.periods;
        let checked = frame.check_periods();
        checked.map_err(|e| format!("{}; {}", e.problem(), remedy(&e)))?;
        let margins = self.margins.map(|all| sized(all, bodies, "margins"));
        frame.margins = margins.transpose()?;
        let groups = self.groups.map(|all| sized(all, bodies, "groups"));
        frame.filter = groups.transpose()?.map(|groups| {
            let mut excluded = self.excluded.unwrap_or_default();
            excluded.sort_unstable();
            Filter { groups, excluded }
        });
        Ok(frame)
    }
}

/// The bodies at these poses. The shape of one with parts is replaced by that of its first part.
fn posed(bodies: &[CaseBody], poses: &[[f32; 7]], shapes: &[Shape]) -> Result<Bodies, String> {
    if poses.len() != bodies.len() {
        return Err(format!("{} poses for {} bodies", poses.len(), bodies.len()));
    }
    let mut posed = Bodies::default();
    for (n, (body, &[x, y, z, w, tx, ty, tz])) in bodies.iter().zip(poses).enumerate() {
        body.check(n, shapes.len())?;
        let shape = body.shape.or(body.parts.first().map(|part| part.shape));
        posed.push(shape.unwrap_or(0), !body.fixed, [x, y, z, w], [tx, ty, tz]);
    }
    check_bodies(&posed, shapes).map_err(|e| e.to_string())?;
    Ok(posed)
}

impl CaseBody {
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

/// How to mend periods, or a body that they don't suit, in a file.
fn remedy(error: &PeriodicError) -> String {
    error.help().replace("`None`", "`null`")
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
        Some(at) => Err(format!("box {at}, {:?}, isn't finite with lower ends first", boxes[at])),
        None => Ok(boxes),
    }
}
