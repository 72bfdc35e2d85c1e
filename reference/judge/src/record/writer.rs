//! Writes a record.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::{BodyLine, FORMAT, FrameLine, Header, MINOR, RecordError, ShapeLine, VERSION};
use crate::json;
use sdop::bodies::Bodies;
use sdop::files::WholeFile;
use sdop::volume::Shape;

impl<Body> Header<Body> {
    /// The first line for these bodies, with what every record has.
    #[must_use]
    pub fn new(scene: &str, seed: u64, shapes: &[Shape], bodies: Vec<Body>) -> Self {
        Self {
            format: FORMAT.to_owned(),
            version: VERSION,
            minor: MINOR,
            program: Some(concat!("sdop ", env!("CARGO_PKG_VERSION")).to_owned()),
            frames: None,
            scene: scene.to_owned(),
            seed,
            dt: None,
            side: None,
            effects: None,
            cull: None,
            shapes: shapes.iter().map(ShapeLine::of).collect(),
            bodies,
        }
    }
}

impl BodyLine {
    /// A line for each body.
    #[must_use]
    pub fn all(bodies: &Bodies) -> Vec<Self> {
        let line = |(&shape, &dynamic): (&u32, &bool)| Self { shape, fixed: !dynamic };
        bodies.shape.iter().zip(&bodies.dynamic).map(line).collect()
    }
}

/// A record being written: under its name when it is whole.
#[derive(Debug)]
pub struct Recorder {
    path: PathBuf,
    file: WholeFile,
}

impl Recorder {
    /// Creates the file and writes the first line.
    ///
    /// # Errors
    /// A file that can't be written.
    pub fn create(path: &Path, header: &Header) -> Result<Self, RecordError> {
        let file = WholeFile::create(path);
        let mut recorder = Self {
            path: path.to_owned(),
            file: file.map_err(|cause| RecordError::unwritable(path, cause))?,
        };
        recorder.line(header)?;
        Ok(recorder)
    }

    /// Writes a frame's line.
    ///
    /// # Errors
    /// A file that can't be written.
    pub fn frame(&mut self, frame: &FrameLine) -> Result<(), RecordError> {
        self.line(frame)
    }

    /// Writes what is still in memory, and gives the file its name.
    ///
    /// # Errors
    /// A file that can't be written.
    pub fn finish(self) -> Result<(), RecordError> {
        let written = self.file.finish();
        written.map_err(|cause| RecordError::unwritable(&self.path, cause))
    }

    fn line(&mut self, value: &impl Serialize) -> Result<(), RecordError> {
        json::to_writer(&mut self.file, value)
            .map_err(std::io::Error::from)
            .and_then(|()| self.file.write_all(b"\n"))
            .map_err(|cause| RecordError::unwritable(&self.path, cause))
    }
}
