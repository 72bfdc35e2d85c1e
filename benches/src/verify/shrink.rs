//! Shrinks a scene to the smallest one that shows a missed pair, as a file for `sdop run`.

use std::fmt::Write as _;
use std::io;
use std::path::{Path, PathBuf};

use crate::scene::SceneFile;
use sdop::bodies::Bodies;
use sdop::culler::CullError;
use sdop::files;
use sdop::mesh::{self, TriangleMesh};
use sdop::settings::{CullSettings, Finder, Interest};
use sdop::volume::Shape;
use sdop_judge::ours::answers::{Answers, Predicate};
use sdop_judge::ours::compare::{compare, culler, difference, found};
use sdop_judge::ours::judged::Shapes;
use sdop_judge::ours::rounds::Failure;
use sdop_judge::ours::ways::Mode;
use sdop_judge::report::pose_in_text;

/// A scene of a few bodies that shows a missed pair.
#[derive(Clone, Debug)]
pub struct SmallestScene {
    /// The settings, with interest renumbered.
    pub settings: CullSettings,
    /// How it was computed.
    pub mode: Mode,
    /// Shapes.
    pub shapes: Vec<Shape>,
    /// Bodies.
    pub bodies: Bodies,
}

impl SmallestScene {
    /// Removes bodies, half of the rest at a time, as long as a pair is missed or found by one
    /// finder alone. `None` if the last frame alone shows no error, because it depends on earlier
    /// frames.
    #[must_use]
    pub fn of(failure: &Failure) -> Option<Self> {
        let mut smallest = Self {
            settings: failure.settings.clone(),
            mode: failure.mode,
            shapes: failure.shapes.clone(),
            bodies: failure.frames.last()?.clone(),
        };
        if !smallest.is_wrong() {
            return None;
        }
        let [i, j] = failure.pair.map(|body| body as usize);
        if let Some(pair) = smallest.keep(|body| body == i || body == j) {
            smallest = pair;
        }
        let mut chunk = smallest.bodies.len().div_ceil(2);
        while chunk > 0 {
            let mut start = 0;
            while start < smallest.bodies.len() {
                let left_out = start..start + chunk;
                match smallest.keep(|body| !left_out.contains(&body)) {
                    Some(fewer) => smallest = fewer,
                    None => start += chunk,
                }
            }
            chunk /= 2;
        }
        Some(smallest)
    }

    /// The scene with only the kept bodies, if it still misses a pair.
    fn keep(&self, kept: impl Fn(usize) -> bool) -> Option<Self> {
        let all = &self.bodies;
        let which: Vec<usize> = (0..all.len()).filter(|&body| kept(body)).collect();
        if which.len() < 2 || which.len() == all.len() {
            return None;
        }
        let bodies = Bodies {
            shape: which.iter().map(|&i| all.shape[i]).collect(),
            dynamic: which.iter().map(|&i| all.dynamic[i]).collect(),
            rotation: which.iter().map(|&i| all.rotation[i]).collect(),
            translation: which.iter().map(|&i| all.translation[i]).collect(),
        };
        let mut smaller = Self {
            bodies,
            ..self.clone()
        };
        if let Some(Interest::Bodies(list)) = &self.settings.interest {
            let place = |&body: &u32| which.iter().position(|&i| i == body as usize);
            let renumbered = list.iter().filter_map(place).map(|i| i as u32).collect();
            smaller.settings.interest = Some(Interest::Bodies(renumbered));
        }
        smaller.is_wrong().then_some(smaller)
    }

    fn is_wrong(&self) -> bool {
        wrong(&self.shapes, &self.bodies, &self.settings, self.mode).unwrap_or(false)
    }

    /// Writes the scene and its meshes into `directory`. Returns the scene's path and whether the
    /// file, read back, still misses a pair.
    ///
    /// # Errors
    /// A file can't be written.
    pub fn write(&self, directory: &Path) -> io::Result<(PathBuf, bool)> {
        let path = directory.join("missed-pair.toml");
        for origin in ["ball", "file"] {
            files::write(&path, self.toml(directory, origin)?)?;
            if self.shown_by(&path) {
                return Ok((path, true));
            }
        }
        Ok((path, false))
    }

    fn toml(&self, directory: &Path, origin: &str) -> io::Result<String> {
        let mut text = String::from("name = \"missed-pair\"\nframes = 1\n");
        // Formatting into a String cannot fail.
        for i in 0..self.bodies.len() {
            let shape = self.bodies.shape[i] as usize;
            let file = format!("missed-pair-{shape}.obj");
            let built = &self.shapes[shape];
            let mesh = TriangleMesh {
                name: built.name.clone(),
                vertices: built.vertices.clone(),
                triangles: built.triangles.clone(),
                ..TriangleMesh::default()
            };
            mesh::write(&mesh, directory.join(&file)).map_err(io::Error::other)?;
            let numbers = pose_in_text(self.bodies.rotation[i], self.bodies.translation[i]);
            let _ = write!(
                text,
                "\n[[bodies]] # {i}\nmesh = \"{file}\"\norigin = \"{origin}\"\nposes = [[{}]]\nstatic = {}\n",
                numbers, !self.bodies.dynamic[i]
            );
        }
        let cull = std::collections::BTreeMap::from([("cull", &self.settings)]);
        let cull = toml::to_string(&cull).map_err(io::Error::other)?;
        let _ = write!(text, "\n{cull}");
        Ok(text)
    }

    fn shown_by(&self, path: &Path) -> bool {
        let scene = SceneFile::read(path).and_then(|file| file.build());
        scene.is_ok_and(|scene| {
            wrong(&scene.shapes, &scene.bodies, &scene.cull, self.mode) == Some(true)
        })
    }
}

/// Whether a culler misses a pair of the frame, or finds other pairs than all-pairs on the same
/// tier.
fn wrong(shapes: &[Shape], bodies: &Bodies, settings: &CullSettings, mode: Mode) -> Option<bool> {
    let judged = Shapes::new(shapes.to_vec()).ok()?;
    let answers = Answers::judge(&judged, bodies, settings.k, &Predicate::ALL).ok()?;
    let all_pairs = CullSettings {
        pairs: Finder::AllPairs,
        ..settings.clone()
    };
    let lists = |settings, mode| -> Result<_, CullError> {
        let mut culler = culler(shapes, bodies, settings, mode)?;
        let list = culler.cull(bodies)?.sorted();
        Ok((list, found(&culler, settings)))
    };
    let (list, found) = lists(settings, mode).ok()?;
    let (_, expected) = lists(&all_pairs, Mode::plain(mode.tier)).ok()?;
    let missed = compare(&answers, settings, &list).0.missed;
    Some(missed > 0 || !difference(&found, &expected).is_empty())
}
