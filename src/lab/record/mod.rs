//! `sdop-record`, version 1: a run as lines of JSON, enough for a stranger's oracle to judge the pairs.
//!
//! Line 1 holds shapes and bodies, every further line a frame with its poses and sorted pairs. Vertices, balls and slabs
//! are the body-frame numbers exactly as built, before any inflation for rounding; floats are the shortest decimals that
//! read back to the same f32.

use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};

use crate::lab::scene::Scene;
use crate::lab::simulate::Frame;
use crate::volume::Shape;
use miette::{IntoDiagnostic as _, WrapErr as _};
use serde::Serialize;

/// The first line.
#[derive(Serialize)]
struct Header<'a> {
    format: &'static str,
    version: u32,
    scene: &'a str,
    seed: u64,
    shapes: Vec<ShapeLine<'a>>,
    bodies: Vec<BodyLine>,
}

#[derive(Serialize)]
struct ShapeLine<'a> {
    name: &'a str,
    vertices: Vec<[f32; 3]>,
    triangles: &'a [[u32; 3]],
    /// Centre and radius.
    ball: [f32; 4],
    ordop: OrDopLine<'a>,
}

#[derive(Serialize)]
struct OrDopLine<'a> {
    k: usize,
    /// The three basis vectors, one after the other.
    basis: [f32; 9],
    lo: &'a [f32],
    hi: &'a [f32],
}

#[derive(Serialize)]
struct BodyLine {
    shape: u32,
    #[serde(rename = "static")]
    fixed: bool,
}

/// Every further line.
#[derive(Serialize)]
struct FrameLine {
    frame: u32,
    /// q (x, y, z, w), then t, of every body.
    poses: Vec<[f32; 7]>,
    pairs: Vec<[u32; 2]>,
}

/// A recording being written.
pub struct Recorder {
    path: PathBuf,
    file: BufWriter<File>,
}

impl Recorder {
    /// Creates the file and writes the first line.
    ///
    /// # Errors
    /// A file that can't be written.
    pub fn create(path: &Path, scene: &Scene) -> miette::Result<Self> {
        let file = File::create(path)
            .into_diagnostic()
            .wrap_err_with(|| cannot_write(path))?;
        let mut recorder = Self {
            path: path.to_owned(),
            file: BufWriter::new(file),
        };
        let bodies = &scene.bodies;
        recorder.line(&Header {
            format: "sdop-record",
            version: 1,
            scene: &scene.name,
            seed: scene.seed,
            shapes: scene.shapes.iter().map(shape_line).collect(),
            bodies: (bodies.shape.iter().zip(&bodies.dynamic))
                .map(|(&shape, dynamic)| BodyLine {
                    shape,
                    fixed: !dynamic,
                })
                .collect(),
        })?;
        Ok(recorder)
    }

    /// Writes a frame's line.
    ///
    /// # Errors
    /// A file that can't be written.
    pub fn frame(&mut self, frame: &Frame<'_>) -> miette::Result<()> {
        let bodies = frame.bodies;
        let poses = bodies.rotation.iter().zip(&bodies.translation);
        self.line(&FrameLine {
            frame: frame.number,
            poses: poses
                .map(|(&[qx, qy, qz, qw], &[tx, ty, tz])| [qx, qy, qz, qw, tx, ty, tz])
                .collect(),
            pairs: frame.pairs.sorted(),
        })
    }

    /// Writes what is still in memory.
    ///
    /// # Errors
    /// A file that can't be written.
    pub fn finish(mut self) -> miette::Result<()> {
        let flushed = self.file.flush();
        flushed
            .into_diagnostic()
            .wrap_err_with(|| cannot_write(&self.path))
    }

    fn line(&mut self, value: &impl Serialize) -> miette::Result<()> {
        serde_json::to_writer(&mut self.file, value)
            .map_err(std::io::Error::from)
            .and_then(|()| self.file.write_all(b"\n"))
            .into_diagnostic()
            .wrap_err_with(|| cannot_write(&self.path))
    }
}

fn shape_line(shape: &Shape) -> ShapeLine<'_> {
    let [x, y, z] = shape.ball.centre.to_array();
    let [a, b, c] = shape.ordop.basis.columns.map(|column| column.to_array());
    ShapeLine {
        name: &shape.name,
        vertices: shape.vertices.iter().map(|v| v.to_array()).collect(),
        triangles: &shape.triangles,
        ball: [x, y, z, shape.ball.radius],
        ordop: OrDopLine {
            k: shape.ordop.directions.k(),
            basis: [a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2]],
            lo: &shape.ordop.lo,
            hi: &shape.ordop.hi,
        },
    }
}

fn cannot_write(path: &Path) -> String {
    format!("cannot write {}", path.display())
}
