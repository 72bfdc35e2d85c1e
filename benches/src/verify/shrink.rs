//! Writes the smallest case of a failure as files: a scene for `sdop run`, if one frame shows it.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::scene::SceneFile;
use sdop::files;
use sdop::settings::CullSettings;
use sdop_judge::Frame;
use sdop_judge::configuration::cullers::settings;
use sdop_judge::report::{case_file, scene};
use sdop_judge::shrink;
use sdop_judge::verify::Failure;

/// How long a failure is made smaller.
const SHRINK_TIME: Duration = Duration::from_secs(60);

/// A small case that our culler fails.
#[derive(Clone, Debug)]
pub struct SmallestScene {
    /// The failure, of which the settings and the mode still hold.
    pub failure: Failure,
    /// The settings, with interest in bodies of the small case.
    pub settings: CullSettings,
    /// The case.
    pub shrunk: shrink::SmallestCase,
}

impl SmallestScene {
    /// Shrinks a failure. `None` when it doesn't show again.
    #[must_use]
    pub fn of(failure: &Failure) -> Option<Self> {
        let shrunk = failure.smallest(SHRINK_TIME)?;
        let bodies = shrunk.case.frames[0].bodies.len();
        Some(Self {
            settings: settings(failure.settings.strategy, &failure.settings, bodies),
            failure: failure.clone(),
            shrunk,
        })
    }

    /// Writes the case into `directory` and, where one frame shows it, the scene and its meshes.
    /// Returns the scene's path, or else the case's, and whether the scene, read back, still fails.
    ///
    /// # Errors
    /// A file can't be written.
    pub fn write(&self, directory: &Path) -> io::Result<(PathBuf, bool)> {
        let (name, bytes) = case_file(&self.shrunk)?;
        let path = directory.join(name);
        files::write(&path, bytes)?;
        if self.shrunk.case.frames.len() > 1 {
            return Ok((path, false));
        }
        let cull = BTreeMap::from([("cull", &self.settings)]);
        let cull = toml::to_string(&cull).map_err(io::Error::other)?;
        let path = path.with_extension("toml");
        for origin in ["ball", "file"] {
            for (name, bytes) in scene(&self.shrunk.case, origin, &cull) {
                files::write(&directory.join(name), bytes)?;
            }
            if self.is_shown_by(&path) {
                return Ok((path, true));
            }
        }
        Ok((path, false))
    }

    fn is_shown_by(&self, path: &Path) -> bool {
        let scene = SceneFile::read(path).and_then(|file| file.build());
        scene.is_ok_and(|scene| {
            let mut read = self.failure.clone();
            read.case.frames = vec![Frame::fitted(scene.bodies, &scene.shapes)];
            read.case.shapes = scene.shapes;
            read.smallest(Duration::ZERO).is_some()
        })
    }
}
