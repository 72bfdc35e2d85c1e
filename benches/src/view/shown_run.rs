//! The run to be shown, independent of its source: shapes, bodies, frames, and the pairs that each
//! strategy reported.

use std::path::Path;

use crate::measure::counts::Volume;
use crate::record;
use crate::scene::Scene;
use crate::simulate::{Simulation, SimulationError};
use sdop::bodies::Bodies;
use sdop::culler::{CullError, Culler};
use sdop::settings::{CullSettings, Strategy};
use sdop::simd::Tier;
use sdop::volume::Shape;
use sdop_judge::record::{BodyLine, FrameLine, Header, Reader, RecordError, VolumeLine};
use sdop_judge::{Claim, WorldBox};
use serde::Serialize;

/// A run in memory.
#[derive(Clone, Debug)]
pub struct ShownRun {
    /// Its source, as the page names it.
    pub source: String,
    /// The first line of its record.
    pub header: Header,
    /// The shapes.
    pub shapes: Vec<Shape>,
    /// The bodies, in no particular frame.
    pub bodies: Bodies,
    /// The frames.
    pub frames: Vec<FrameLine>,
    /// The claim that holds for the pairs in a frame's `meets`.
    pub claim: Claim,
    /// The boxes that a case gives with each frame, if its claim is about them.
    pub boxes: Option<Vec<Vec<WorldBox>>>,
    /// The periods of each frame, if a case has such.
    pub periods: Option<Vec<[Option<f64>; 3]>>,
    /// The missed pair that the page opens at.
    pub focus: Option<Focus>,
    /// Messages to show on the page.
    pub messages: Vec<String>,
}

/// A missed pair of a case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Focus {
    /// The frame's index.
    pub frame: usize,
    /// The two bodies.
    pub bodies: [u32; 2],
    /// A point that both share.
    pub point: Option<[f64; 3]>,
}

/// The pairs that one strategy reported, frame by frame.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownStrategy {
    /// Its name on the page.
    pub name: String,
    /// A description of how it culled.
    pub detail: String,
    /// Its settings, if it was a strategy of this program.
    pub settings: Option<CullSettings>,
    /// Sorted.
    pub pairs: Vec<Vec<[u32; 2]>>,
    /// The counters, with the same volumes in every frame.
    pub counters: Option<Vec<Vec<VolumeLine>>>,
}

impl ShownRun {
    /// A run whose pairs are judged by the bodies' meshes.
    fn of_meshes(
        source: &Path,
        header: Header,
        (shapes, bodies): (Vec<Shape>, Bodies),
        frames: Vec<FrameLine>,
    ) -> Self {
        Self {
            source: file_name(source),
            header,
            shapes,
            bodies,
            frames,
            claim: Claim::Mesh,
            boxes: None,
            periods: None,
            focus: None,
            messages: Vec::new(),
        }
    }

    /// Reads a record, or its first `frames` frames. If a record is broken, the frames before that
    /// are shown with a message, and the error is returned, too.
    ///
    /// # Errors
    /// The first line can't be read.
    pub fn record(
        path: &Path,
        most: Option<u32>,
    ) -> Result<(Self, Option<RecordError>), RecordError> {
        let mut reader = Reader::open(path)?;
        let (mut frames, mut broken) = (Vec::new(), None);
        while most.is_none_or(|most| frames.len() < most as usize) {
            match reader.next_frame() {
                Ok(Some(frame)) => frames.push(frame),
                Ok(None) => break,
                Err(error) => {
                    broken = Some(error);
                    break;
                }
            }
        }
        let bodies = (reader.shapes().to_vec(), reader.bodies().clone());
        let mut show = Self::of_meshes(path, reader.header().clone(), bodies, frames);
        if show.frames.iter().any(|frame| frame.translations.is_some()) {
            let words =
                "The record has translations that f32 doesn't hold. They are drawn rounded to f32.";
            show.messages.push(words.to_owned());
        }
        if let Some(error) = &broken {
            show.messages.push(match show.frames.len() {
                0 => in_words(error),
                whole => format!(
                    "The record is broken. {} The {whole} frames before that are shown.",
                    in_words(error)
                ),
            });
        }
        Ok((show, broken))
    }

    /// Simulates and culls a scene. `done` is called once per frame.
    ///
    /// # Errors
    /// As [`Simulation::new`] and [`Simulation::next_frame`].
    pub fn scene(
        scene: &Scene,
        source: &Path,
        tier: Tier,
        mut done: impl FnMut(),
    ) -> Result<Self, SimulationError> {
        let mut frames = Vec::new();
        let mut simulation = Simulation::new(scene, tier)?;
        while let Some(frame) = simulation.next_frame()? {
            frames.push(record::frame_line(&frame, scene.cull.strategy));
            done();
        }
        let bodies = (scene.shapes.clone(), scene.bodies.clone());
        let header = record::header(scene);
        Ok(Self::of_meshes(source, header, bodies, frames))
    }

    /// Culls these poses, frame after frame, for hard cases.
    ///
    /// # Errors
    /// The settings can't be carried out.
    pub fn poses(
        name: &str,
        source: &Path,
        shapes: Vec<Shape>,
        frames: &[Bodies],
        settings: &CullSettings,
        tier: Tier,
    ) -> Result<Self, CullError> {
        let bodies = frames.first().cloned().unwrap_or_default();
        let line = |(number, bodies): (usize, &Bodies)| FrameLine {
            frame: number as u32,
            poses: FrameLine::poses(bodies),
            ..FrameLine::default()
        };
        let header = Header::new(name, 0, &shapes, BodyLine::all(&bodies));
        let lines = frames.iter().enumerate().map(line).collect();
        let mut show = Self::of_meshes(source, header, (shapes, bodies), lines);
        show.header.cull = Some(settings.clone());
        let ShownStrategy { pairs, counters, .. } = show.cull(settings, tier)?;
        let counters = counters.into_iter().flatten();
        for ((frame, pairs), counters) in show.frames.iter_mut().zip(pairs).zip(counters) {
            (frame.pairs, frame.counters) = (pairs, Some(counters));
        }
        Ok(show)
    }

    /// The pairs of the record.
    #[must_use]
    pub fn recorded(&self) -> ShownStrategy {
        let settings = self.header.cull.clone();
        let name = match (&settings, &self.header.program) {
            (Some(cull), _) => cull.strategy.name().to_owned(),
            (None, Some(program)) => program.clone(),
            (None, None) => "as recorded".to_owned(),
        };
        ShownStrategy {
            name,
            detail: settings.as_ref().map_or(String::new(), detail),
            settings,
            pairs: self.frames.iter().map(|frame| frame.pairs.clone()).collect(),
            counters: counters(&self.frames),
        }
    }

    /// Culls the frames with these settings.
    ///
    /// # Errors
    /// The settings can't be carried out.
    pub fn cull(&self, settings: &CullSettings, tier: Tier) -> Result<ShownStrategy, CullError> {
        let mut bodies = self.bodies.clone();
        if let Some(first) = self.frames.first() {
            first.pose(&mut bodies);
        }
        let builder = Culler::builder().settings(settings).tier(tier);
        let mut culler = builder.build(&self.shapes, &bodies)?;
        let (mut pairs, mut counters) = (Vec::new(), Vec::new());
        for frame in &self.frames {
            frame.pose(&mut bodies);
            let before = *culler.counters();
            pairs.push(culler.cull(&bodies)?.sorted());
            counters
                .push(record::volume_lines(settings.strategy, &culler.counters().since(&before)));
        }
        Ok(ShownStrategy {
            name: settings.strategy.name().to_owned(),
            detail: detail(settings),
            settings: Some(settings.clone()),
            pairs,
            counters: Some(counters),
        })
    }

    /// The pairs of another record of the same frames, which must have the same bodies in the same
    /// poses.
    ///
    /// # Errors
    /// A text with the first difference.
    pub fn culled_by(&self, other: &Self) -> Result<ShownStrategy, String> {
        if self.header.bodies != other.header.bodies {
            return Err("its bodies are others".to_owned());
        }
        if self.header.shapes != other.header.shapes {
            return Err("its shapes are others".to_owned());
        }
        for (at, frame) in self.frames.iter().enumerate() {
            match other.frames.get(at) {
                None => return Err(format!("it ends before frame {}", frame.frame)),
                Some(same) if same.frame != frame.frame => {
                    return Err(format!(
                        "it has frame {} in place of frame {}",
                        same.frame, frame.frame
                    ));
                }
                Some(same)
                    if same.poses != frame.poses || same.translations != frame.translations =>
                {
                    return Err(format!("frame {} has other poses", frame.frame));
                }
                Some(_) => {}
            }
        }
        let mut culled = other.recorded();
        culled.pairs.truncate(self.frames.len());
        if let Some(counters) = &mut culled.counters {
            counters.truncate(self.frames.len());
        }
        Ok(culled)
    }

    /// The pairs whose spheres overlap: the potentially colliding set of the paper.
    pub(super) fn spheres(&self) -> Result<ShownStrategy, CullError> {
        let settings = CullSettings {
            strategy: Strategy::Sphere,
            pairs: sdop::settings::Finder::Auto,
            ..CullSettings::default()
        };
        self.cull(&settings, Tier::detect())
    }
}

/// An error and its remedy.
pub(super) fn in_words(error: &RecordError) -> String {
    let help = error.help().map_or(String::new(), |help| format!(" Remedy: {help}."));
    format!("{error}.{help}")
}

/// The counters of all frames. `None` if a frame lacks them or counts other volumes.
fn counters(frames: &[FrameLine]) -> Option<Vec<Vec<VolumeLine>>> {
    let all: Vec<Vec<VolumeLine>> =
        frames.iter().map(|frame| frame.counters.clone()).collect::<Option<_>>()?;
    let names =
        |lines: &[VolumeLine]| lines.iter().map(|line| line.volume.clone()).collect::<Vec<_>>();
    let first = names(all.first()?);
    all.iter().all(|lines| names(lines) == first).then_some(all)
}

fn detail(settings: &CullSettings) -> String {
    let CullSettings { pairs, k, axes, overlap, strategy, .. } = settings;
    if Volume::of(*strategy).is_empty() {
        return "nothing is culled".to_owned();
    }
    format!("pairs from {pairs}, k = {k}, {axes} axes, {overlap}")
}

/// The last part of a path, since the page may be opened on other machines.
pub(super) fn file_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}
