//! A scene file as written: TOML as plain structures. Each value is checked on its own.

use std::collections::BTreeMap;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};

use super::error::{SceneError, SceneText};
use crate::effects::EffectsSpec;
use crate::number::{Factors, Interval, Positive, Real};
use sdop::choice::choices;
use sdop::files;
use sdop::settings::CullSettings;
use sdop::volume::Origin;

/// A scene file, read but not yet built. Seed, frames and culling may be changed before
/// [`SceneFile::build`].
#[derive(Clone, Debug)]
pub struct SceneFile {
    pub(super) source: SceneText,
    pub(super) directory: PathBuf,
    /// Larger meshes are refused.
    pub(super) max_bytes: u64,
    /// What the file says.
    pub spec: SceneSpec,
}

/// The keys of a scene file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneSpec {
    /// The scene's name in records and tables.
    pub name: String,
    /// The seed of all random draws.
    #[serde(default = "first_seed")]
    pub seed: u64,
    /// How bodies share random draws.
    #[serde(default = "by_group")]
    pub seeding: Seeding,
    /// Frames to cull: the initial state and `frames − 1` steps.
    pub frames: NonZeroU32,
    /// Seconds per step.
    #[serde(default = "sixtieth")]
    pub dt: Positive,
    /// The walls, centred on the origin.
    #[serde(rename = "box")]
    pub bounds: Option<Spanned<BoxSpec>>,
    /// Groups of alike bodies; body indices run through the groups in order.
    pub bodies: Vec<Spanned<GroupSpec>>,
    /// What is simulated.
    #[serde(default)]
    pub effects: EffectsSpec,
    /// How it is culled.
    #[serde(default)]
    pub cull: CullSettings,
}

impl SceneSpec {
    /// A warning if bodies have speeds and nothing moves them.
    #[must_use]
    pub fn idle_speed(&self) -> Option<&'static str> {
        let is_fast = |group: &Spanned<GroupSpec>| {
            let group = group.get_ref();
            group.speed.is_some() || group.velocities.is_some()
        };
        let is_idle = self.effects.motion.is_none() && self.bodies.iter().any(is_fast);
        is_idle.then_some("bodies have speeds, but don't move: add `motion = true` to [effects]")
    }
}

/// The cube that holds the scene: its side or the density that sets it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoxSpec {
    /// Distance between opposite walls.
    pub side: Option<Spanned<Positive>>,
    /// Mean number of sphere overlaps per body, ignoring the walls, instead of the side.
    pub partners: Option<Spanned<Positive>>,
}

/// One `[[bodies]]` table.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GroupSpec {
    /// A mesh file, relative to the scene file.
    pub mesh: Option<Spanned<String>>,
    /// A procedural shape, instead of a mesh file.
    pub shape: Option<Spanned<String>>,
    /// The procedural shape's sizes, where they differ from its defaults.
    #[serde(default)]
    pub sizes: BTreeMap<Spanned<String>, Spanned<Real>>,
    /// Factors of the mesh's coordinates, before anything else; negative ones mirror.
    pub scale: Option<Spanned<Factors>>,
    /// How many bodies, placed by the seed.
    pub count: Option<Spanned<NonZeroU32>>,
    /// Explicit poses instead: q (x, y, z, w), which are f32, then t, which are f64.
    pub poses: Option<Spanned<Vec<Spanned<[f64; 7]>>>>,
    /// Radius of the bounding ball, or the ends of a log-uniform range; absent: the mesh's own
    /// size.
    pub radius: Option<Spanned<Interval>>,
    /// What the body frame's origin is.
    pub origin: Option<Spanned<Origin>>,
    /// Bodies that never move.
    #[serde(default, rename = "static")]
    pub fixed: bool,
    /// Initial speed; directions are drawn.
    pub speed: Option<Spanned<Interval>>,
    /// Explicit initial velocities, one per pose.
    pub velocities: Option<Spanned<Vec<Spanned<[f32; 3]>>>>,
    /// How seeded bodies are spread over the box.
    pub placement: Option<Spanned<Placement>>,
}

/// How the centres of a group's bodies are spread.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Placement {
    /// Uniformly in the box.
    Uniform,
    /// Uniformly in balls about centres that are uniform in the box.
    Clusters {
        /// How many balls.
        number: NonZeroU32,
        /// Their radius.
        radius: Positive,
    },
    /// Uniformly in a slice through the middle of the box, across z.
    Plane {
        /// The slice's thickness for centres.
        thickness: Positive,
    },
}

choices! {
    /// How bodies share random draws.
    Seeding, "seeding", {
        /// Bodies of a group draw from one stream in order, so that the last one's draws require
        /// all others.
        ByGroup = "by-group",
        /// Each body has its own streams, so that any part of a scene can be built without the
        /// rest.
        ByBody = "by-body",
    }
}

fn by_group() -> Seeding {
    Seeding::ByGroup
}

fn first_seed() -> u64 {
    1
}

fn sixtieth() -> Positive {
    Positive(1.0 / 60.0)
}

impl SceneFile {
    /// Reads a scene file.
    ///
    /// # Errors
    /// An unreadable file; text that is no TOML; unknown keys, wrong types and impossible values,
    /// each with line, column and a hint.
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        Self::read_within(path, files::MAX_BYTES)
    }

    /// The same for a file and meshes of at most `max_bytes` each.
    ///
    /// # Errors
    /// As [`SceneFile::read`], and a file with more bytes.
    pub fn read_within(path: &Path, max_bytes: u64) -> Result<Self, SceneError> {
        let directory = path.parent().unwrap_or(Path::new("")).to_owned();
        let file = Self::parse_source(SceneText::read(path, max_bytes)?, directory)?;
        Ok(Self { max_bytes, ..file })
    }

    /// Reads a scene from text; `file` is what errors call it, mesh paths are relative to
    /// `directory`.
    ///
    /// # Errors
    /// As [`SceneFile::read`].
    pub fn parse(text: &str, file: &str, directory: &Path) -> Result<Self, SceneError> {
        let source = SceneText { file: file.to_owned(), text: text.to_owned() };
        Self::parse_source(source, directory.to_owned())
    }

    fn parse_source(source: SceneText, directory: PathBuf) -> Result<Self, SceneError> {
        match read_spec(&source.text) {
            Ok(spec) => Ok(Self { source, directory, max_bytes: files::MAX_BYTES, spec }),
            Err(error) => Err(source.toml_error(&error)),
        }
    }
}

fn read_spec(text: &str) -> Result<SceneSpec, toml::de::Error> {
    let mut table = DeTable::parse(text)?;
    let mut nearest = BTreeMap::new();
    for value in table.get_ref().values() {
        find_double_roundings(value, &mut nearest);
    }
    table.get_mut().iter_mut().for_each(|(_, value)| round_once(value, &nearest));
    SceneSpec::deserialize(Deserializer::from(table))
}

/// Finds the floats that, read as f64 and then rounded, would not become the f32 nearest to their
/// *text*: a decimal just next to the midpoint of two f32 becomes the midpoint in f64, and its tie
/// may go to the other side. Collects the nearest f32 as text, by the float's place.
fn find_double_roundings(value: &Spanned<DeValue<'_>>, nearest: &mut BTreeMap<usize, String>) {
    match value.get_ref() {
        DeValue::Float(float) => {
            let text = float.as_str();
            if let (Ok(once), Ok(twice)) = (text.parse::<f32>(), text.parse::<f64>())
                && once.is_finite()
                && once != twice as f32
            {
                nearest.insert(value.span().start, format!("{:?}", f64::from(once)));
            }
        }
        DeValue::Array(list) => list.iter().for_each(|item| find_double_roundings(item, nearest)),
        DeValue::Table(table) => {
            for (key, item) in table {
                match (key.get_ref().as_ref(), item.get_ref()) {
                    ("poses", DeValue::Array(poses)) => find_in_rotations(poses, nearest),
                    _ => find_double_roundings(item, nearest),
                }
            }
        }
        _ => {}
    }
}

/// The same for poses, whose translations stay f64.
fn find_in_rotations(poses: &[Spanned<DeValue<'_>>], nearest: &mut BTreeMap<usize, String>) {
    for pose in poses {
        if let DeValue::Array(numbers) = pose.get_ref() {
            let rotation = numbers.iter().take(4);
            rotation.for_each(|number| find_double_roundings(number, nearest));
        }
    }
}

/// Replaces the floats found.
fn round_once<'i>(value: &mut Spanned<DeValue<'i>>, nearest: &'i BTreeMap<usize, String>) {
    let place = value.span().start;
    match value.get_mut() {
        float @ DeValue::Float(_) => {
            if let Some(Ok(exact)) = nearest.get(&place).map(|text| DeValue::parse(text)) {
                *float = exact.into_inner();
            }
        }
        DeValue::Array(list) => list.iter_mut().for_each(|item| round_once(item, nearest)),
        DeValue::Table(table) => table.iter_mut().for_each(|(_, item)| round_once(item, nearest)),
        _ => {}
    }
}
