//! Writes a record.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::{
    BodyLine, EffectLine, FORMAT, FrameLine, Header, MINOR, RecordError, ShapeLine, VERSION,
    VolumeLine,
};
use crate::bodies::Bodies;
use crate::counters::Counters;
use crate::files::Whole;
use crate::lab::measure::counts::{Counts, Volume};
use crate::lab::scene::Scene;
use crate::lab::simulate::Frame;
use crate::settings::Strategy;
use crate::volume::Shape;

impl Header {
    /// The first line for these bodies, with what every record has.
    #[must_use]
    pub fn new(scene: &str, seed: u64, shapes: &[Shape], bodies: &Bodies) -> Self {
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
            bodies: BodyLine::all(bodies),
        }
    }

    /// The first line of a scene's record.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let effects = scene.effects.lists().into_iter();
        let effects = effects.map(|(name, on)| EffectLine {
            name: name.to_owned(),
            on,
        });
        Self {
            frames: Some(scene.frames),
            dt: Some(scene.dt),
            side: scene.side,
            effects: Some(effects.collect()),
            cull: Some(scene.cull.clone()),
            ..Self::new(&scene.name, scene.seed, &scene.shapes, &scene.bodies)
        }
    }
}

impl BodyLine {
    /// A line for each body.
    #[must_use]
    pub fn all(bodies: &Bodies) -> Vec<Self> {
        let line = |(&shape, &dynamic): (&u32, &bool)| Self {
            shape,
            fixed: !dynamic,
        };
        bodies.shape.iter().zip(&bodies.dynamic).map(line).collect()
    }
}

impl FrameLine {
    /// The line of a culled frame.
    #[must_use]
    pub fn of(frame: &Frame<'_>, strategy: Strategy) -> Self {
        Self {
            frame: frame.number,
            poses: Self::poses(frame.bodies),
            pairs: frame.pairs.sorted(),
            counters: Some(VolumeLine::of(strategy, &frame.counters)),
            meets: None,
        }
    }
}

impl VolumeLine {
    /// A strategy's counters, in the order of its tests.
    #[must_use]
    pub fn of(strategy: Strategy, counters: &Counters) -> Vec<Self> {
        let counts = Counts {
            culler: *counters,
            ..Counts::default()
        };
        let line = |volume: Volume| Self {
            volume: volume.to_string(),
            counters: counts.of(volume),
        };
        Volume::of(strategy).into_iter().map(line).collect()
    }
}

/// A record being written: under its name when it is whole.
#[derive(Debug)]
pub struct Recorder {
    path: PathBuf,
    file: Whole,
}

impl Recorder {
    /// Creates the file and writes the first line.
    ///
    /// # Errors
    /// A file that can't be written.
    pub fn create(path: &Path, header: &Header) -> Result<Self, RecordError> {
        let file = Whole::create(path);
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
        serde_json::to_writer(&mut self.file, value)
            .map_err(std::io::Error::from)
            .and_then(|()| self.file.write_all(b"\n"))
            .map_err(|cause| RecordError::unwritable(&self.path, cause))
    }
}
