//! Reads a record line by line, so that it need not fit into memory. Errors name the line.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use serde::Deserialize;

use super::{BodyLine, FORMAT, FrameLine, Header, OrDopLine, RecordError, ShapeLine, VERSION};
use sdop::bodies::Bodies;
use sdop::bodies::contract::{ContractError, check_pose, check_poses};
use sdop::files::{MAX_BYTES, read_line};
use sdop::mesh::TriangleMesh;
use sdop::volume::check_bodies;
use sdop::volume::{Ball, Basis, DirectionSet, OrDop, Origin, Shape, ShapeSpec};

/// A record being read.
#[derive(Debug)]
pub struct Reader<R> {
    name: String,
    source: R,
    header: Header,
    shapes: Vec<Shape>,
    bodies: Bodies,
    /// The line read last, counted from 1.
    line: u64,
    /// The last frame's number.
    frame: Option<u32>,
}

/// What distinguishes a record from other files.
#[derive(Deserialize)]
struct FormatMark {
    format: String,
    version: u64,
}

impl Reader<BufReader<File>> {
    /// Opens a record and reads its first line.
    ///
    /// # Errors
    /// A file that can't be read, is no record, or has another version; a first line that
    /// contradicts itself.
    pub fn open(path: &Path) -> Result<Self, RecordError> {
        let name = path.display().to_string();
        match File::open(path) {
            Ok(file) => Self::new(BufReader::new(file), &name),
            Err(cause) => Err(RecordError::Unreadable { file: name, cause }),
        }
    }
}

impl<R: BufRead> Reader<R> {
    /// Reads the first line. `name` is what errors call the source.
    ///
    /// # Errors
    /// As [`Reader::open`].
    pub fn new(mut source: R, name: &str) -> Result<Self, RecordError> {
        let mut text = Vec::new();
        let read = read_line(&mut source, MAX_BYTES, &mut text);
        read.map_err(|cause| RecordError::Unreadable { file: name.to_owned(), cause })?;
        let header = parse_header(&text, name)?;
        let wrong = |problem: String, hint: &str| line_error(name, 1, problem, hint);
        let shapes = header.shapes.iter().map(|line| {
            line.built().map_err(|problem| {
                let problem = format!("shape {}: {problem}", line.name);
                wrong(problem, "write the body-frame numbers exactly as built")
            })
        });
        let shapes = shapes.collect::<Result<Vec<_>, _>>()?;
        let bodies = bodies_of(&header.bodies);
        check_bodies(&bodies, &shapes).map_err(|error| wrong(error.problem(), error.hint))?;
        Ok(Self { name: name.to_owned(), source, header, shapes, bodies, line: 1, frame: None })
    }

    /// The first line.
    #[must_use]
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// The shapes, with the numbers of the record.
    #[must_use]
    pub fn shapes(&self) -> &[Shape] {
        &self.shapes
    }

    /// The bodies, in the frame read last (before the first: at the origin).
    #[must_use]
    pub fn bodies(&self) -> &Bodies {
        &self.bodies
    }

    /// Reads the next frame and moves the bodies to it; `None` at the end. After an error nothing
    /// more can be read.
    ///
    /// # Errors
    /// A line that is no frame, or one that contradicts the first line: with its number and how to
    /// mend it.
    pub fn next_frame(&mut self) -> Result<Option<FrameLine>, RecordError> {
        let mut text = Vec::new();
        loop {
            let read = read_line(&mut self.source, MAX_BYTES, &mut text);
            let read =
                read.map_err(|cause| RecordError::Unreadable { file: self.name.clone(), cause })?;
            if read == 0 {
                return Ok(None);
            }
            self.line += 1;
            if !text.trim_ascii().is_empty() {
                break;
            }
        }
        let frame = self.parse(&text)?;
        self.check(&frame)?;
        self.frame = Some(frame.frame);
        Ok(Some(frame))
    }

    fn parse(&self, text: &[u8]) -> Result<FrameLine, RecordError> {
        serde_json::from_slice(text).map_err(|error| {
            if error.is_eof() && !text.ends_with(b"\n") {
                let problem = "the file ends inside this line".to_owned();
                let hint = "its program was interrupted: write it again, or cut the line off to keep the frames before it";
                return self.wrong(problem, hint);
            }
            let hint = "a frame is {\"frame\":n,\"poses\":[[qx,qy,qz,qw,tx,ty,tz],…],\"pairs\":[[i,j],…]}";
            self.wrong(said(&error), hint)
        })
    }

    fn check(&mut self, frame: &FrameLine) -> Result<(), RecordError> {
        if self.frame.is_some_and(|last| frame.frame <= last) {
            let last = self.frame.unwrap_or_default();
            let problem = format!("frame {} follows frame {last}", frame.frame);
            return Err(self.wrong(problem, "number the frames upwards"));
        }
        if frame.poses.len() != self.bodies.len() {
            let (poses, bodies) = (frame.poses.len(), self.bodies.len());
            let problem = format!("frame {} has {poses} poses for {bodies} bodies", frame.frame);
            return Err(
                self.wrong(problem, "give every body of the first line a pose, in its order")
            );
        }
        frame.pose(&mut self.bodies);
        let posed = check_poses(&self.bodies, 0..self.bodies.len());
        posed.map_err(|error| self.outside(frame, &error))?;
        if let Some(translations) = &frame.translations {
            self.check_translations(frame, translations)?;
        }
        for (name, pairs) in [("pairs", Some(&frame.pairs)), ("meets", frame.meets.as_ref())] {
            if let Some(problem) = pairs.and_then(|pairs| self.flaw(pairs)) {
                let problem = format!("frame {}, {name}: {problem}", frame.frame);
                let hint = "list each pair of bodies, not both static, once, the smaller number first, in ascending order";
                return Err(self.wrong(problem, hint));
            }
        }
        Ok(())
    }

    /// Checks a frame's f64 translations, of which its poses have the nearest f32.
    fn check_translations(&self, frame: &FrameLine, all: &[[f64; 3]]) -> Result<(), RecordError> {
        let Bodies { rotation, translation, .. } = &self.bodies;
        let hint = "give every body its f64 translation, and its pose the nearest f32";
        if all.len() != translation.len() {
            let (given, bodies) = (all.len(), translation.len());
            let problem =
                format!("frame {} has {given} translations for {bodies} bodies", frame.frame);
            return Err(self.wrong(problem, hint));
        }
        for (body, t) in all.iter().enumerate() {
            check_pose(body, &rotation[body], t).map_err(|error| self.outside(frame, &error))?;
            if t.map(|x| x as f32) != translation[body] {
                let problem = format!(
                    "frame {}: body {body} has the translation {t:?} and the pose's {:?}",
                    frame.frame, translation[body]
                );
                return Err(self.wrong(problem, hint));
            }
        }
        Ok(())
    }

    /// The error for a body outside of the contract.
    fn outside(&self, frame: &FrameLine, error: &ContractError) -> RecordError {
        self.wrong(format!("frame {}: {}", frame.frame, error.problem()), error.hint)
    }

    /// What is wrong with a list of pairs.
    fn flaw(&self, pairs: &[[u32; 2]]) -> Option<String> {
        let n = self.bodies.len();
        let dynamic = |body: u32| self.bodies.dynamic[body as usize];
        for (at, &[i, j]) in pairs.iter().enumerate() {
            if i >= j {
                return Some(format!("[{i},{j}] doesn't have the smaller number first"));
            }
            if j as usize >= n {
                return Some(format!("[{i},{j}] of {n} bodies"));
            }
            if !dynamic(i) && !dynamic(j) {
                return Some(format!("[{i},{j}] are both static"));
            }
            if at > 0 && pairs[at - 1] >= [i, j] {
                let [a, b] = pairs[at - 1];
                return Some(format!("[{i},{j}] follows [{a},{b}]"));
            }
        }
        None
    }

    fn wrong(&self, problem: String, hint: &str) -> RecordError {
        line_error(&self.name, self.line, problem, hint)
    }
}

fn line_error(name: &str, line: u64, problem: String, hint: &str) -> RecordError {
    RecordError::Line { file: name.to_owned(), line, problem, hint: hint.to_owned() }
}

/// The parser's message without its line number: it parses each line separately.
fn said(error: &serde_json::Error) -> String {
    let text = error.to_string();
    let place = format!(" at line {} column {}", error.line(), error.column());
    let what = text.strip_suffix(&place).unwrap_or(&text);
    format!("column {}: {what}", error.column())
}

fn parse_header(text: &[u8], name: &str) -> Result<Header, RecordError> {
    let stranger = |problem: String| RecordError::Stranger { file: name.to_owned(), problem };
    if text.trim_ascii().is_empty() {
        return Err(stranger("the first line is empty".to_owned()));
    }
    let mark: FormatMark = serde_json::from_slice(text).map_err(|error| stranger(said(&error)))?;
    if mark.format != FORMAT {
        return Err(stranger(format!("its format is {:?}", mark.format)));
    }
    if mark.version != u64::from(VERSION) {
        return Err(RecordError::Version { file: name.to_owned(), found: mark.version });
    }
    serde_json::from_slice(text).map_err(|error| {
        let hint = "compare the line with the format's description: `sdop run SCENE --record FILE` writes one like it";
        line_error(name, 1, said(&error), hint)
    })
}

impl ShapeLine {
    /// The shape with these numbers, or what is wrong with them.
    pub(crate) fn built(&self) -> Result<Shape, String> {
        let line = self;
        if line.vertices.is_empty() {
            return Err("it has no vertices".to_owned());
        }
        let finite = |numbers: &[f32]| numbers.iter().all(|x| x.is_finite());
        if let Some(at) = line.vertices.iter().position(|v| !finite(v)) {
            return Err(format!("vertex {at} is {:?}", line.vertices[at]));
        }
        let count = line.vertices.len();
        let outside = |t: &[u32; 3]| t.iter().any(|&v| v as usize >= count);
        if let Some(at) = line.triangles.iter().position(outside) {
            let corners = line.triangles[at];
            return Err(format!("triangle {at} is {corners:?} of {count} vertices"));
        }
        let ball = match line.ball {
            Some(ball @ [x, y, z, radius]) if finite(&ball) && radius >= 0.0 => {
                Some(Ball { centre: [x, y, z], radius })
            }
            Some(ball) => return Err(format!("its ball is {ball:?}")),
            None => None,
        };
        let ordop = line.ordop.as_ref().map(OrDopLine::built).transpose()?;
        let vertices = line.vertices.clone();
        let (ball, ordop) = match (ball, ordop) {
            (Some(ball), Some(ordop)) => (ball, ordop),
            // No claim is about what isn't given; a shape has it all the same.
            (ball, ordop) => {
                let mesh = TriangleMesh::new(&line.name, vertices.clone(), line.triangles.clone());
                let mesh = mesh.map_err(|e| e.problem())?;
                let spec = ShapeSpec { origin: Origin::File, ..ShapeSpec::default() };
                let shape = Shape::build(&mesh, &spec).map_err(|e| e.problem())?;
                (ball.unwrap_or(shape.ball), ordop.unwrap_or(shape.ordop))
            }
        };
        Ok(Shape {
            name: line.name.clone(),
            offset: [0.0; 3], // a record has the vertices as culled
            scale: 1.0,
            pose_offset: [0.0; 3],
            rounding: 0.0,
            reach: Ball::about([0.0; 3], &vertices).radius,
            ball,
            ordop,
            triangles: line.triangles.clone(),
            vertices,
        })
    }
}

impl OrDopLine {
    fn built(&self) -> Result<OrDop, String> {
        let Self { k, basis, lo, hi } = self;
        if [&basis[..], lo, hi].iter().any(|all| all.iter().any(|x| !x.is_finite())) {
            return Err("its or-DOP is not finite".to_owned());
        }
        let directions = DirectionSet::ALL.iter().find(|set| set.k() == *k);
        let directions = *directions.ok_or_else(|| format!("no or-DOP has k = {k}"))?;
        let slabs = directions.slabs();
        if (lo.len(), hi.len()) != (slabs, slabs) {
            let (lo, hi) = (lo.len(), hi.len());
            return Err(format!(
                "k = {k} takes {slabs} slabs; it has {lo} lower and {hi} upper ends"
            ));
        }
        let columns = [0, 3, 6].map(|at| std::array::from_fn(|i| basis[at + i]));
        let (lo, hi) = (lo.clone(), hi.clone());
        Ok(OrDop { directions, basis: Basis { columns }, lo, hi })
    }
}

fn bodies_of(lines: &[BodyLine]) -> Bodies {
    let mut bodies = Bodies::default();
    for &BodyLine { shape, fixed } in lines {
        bodies.push(shape, !fixed, [0.0, 0.0, 0.0, 1.0], [0.0; 3]);
    }
    bodies
}
