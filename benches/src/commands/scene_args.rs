//! The arguments of every command that runs a scene: the file, and flags that override its values.

use std::num::NonZeroU32;
use std::path::{Path, PathBuf};

use sdop::Tier;
use sdop::settings::{
    Axes, Budget, CullSettings, Finder, Interest, Order, Overlap, Strategy, Updates,
};
use sdop::volume::DirectionSet;
use sdop_bench::scene::{Scene, SceneFile};
use serde::Deserialize as _;
use toml::de::ValueDeserializer;

use super::files::ReadArgs;
use super::one_of;

/// A scene file and flags that override it.
#[derive(clap::Args)]
pub struct SceneArgs {
    /// The scene file (TOML), for example data/scenes/paper-500.toml
    scene: PathBuf,
    /// Frames to cull; the first is the scene as placed
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    frames: Option<u32>,
    /// The seed of all random draws
    #[arg(long)]
    seed: Option<u64>,
    #[command(flatten)]
    files: ReadArgs,
    #[command(flatten)]
    cull: CullArgs,
}

/// Flags that override the scene's `[cull]` table, key by key.
#[derive(Clone, Debug, Default, PartialEq, clap::Args)]
#[command(next_help_heading = "Culling (each overrides the scene's [cull])")]
pub struct CullArgs {
    /// Which volumes are tested, and in which order
    #[arg(long, value_parser = one_of::<Strategy>(Strategy::NAMES))]
    strategy: Option<Strategy>,
    /// Pair finder: how candidates for the first volume test are found
    #[arg(long, value_name = "FINDER", value_parser = one_of::<Finder>(Finder::NAMES))]
    pairs: Option<Finder>,
    /// Number of the or-DOP's half-spaces
    #[arg(long, value_parser = one_of::<DirectionSet>(DirectionSet::NAMES))]
    k: Option<DirectionSet>,
    /// The or-DOP's axes
    #[arg(long, value_parser = one_of::<Axes>(Axes::NAMES))]
    axes: Option<Axes>,
    /// Which separating axes the or-DOP test tries
    #[arg(long, value_parser = one_of::<Overlap>(Overlap::NAMES))]
    overlap: Option<Overlap>,
    /// When or-DOPs are updated
    #[arg(long, value_parser = one_of::<Updates>(Updates::NAMES))]
    updates: Option<Updates>,
    /// Bodies of interest, as in 0,5,7, or a view cone, as in '{ body = 0, direction = [0, 0, 1],
    /// half_angle = 30 }'
    #[arg(long, value_parser = interest)]
    interest: Option<Interest>,
    /// Time-critical: or-DOP tests per frame
    #[arg(long, value_name = "TESTS", conflicts_with = "budget_us")]
    budget_tests: Option<u64>,
    /// Time-critical: microseconds per frame
    #[arg(long, value_name = "MICROSECONDS")]
    budget_us: Option<u64>,
    /// Time-critical: the order in which the budget is spent
    #[arg(long, value_parser = one_of::<Order>(Order::NAMES))]
    order: Option<Order>,
}

/// The machine's resources that the culler uses.
#[derive(clap::Args)]
#[command(next_help_heading = "Machine")]
pub struct MachineArgs {
    /// SIMD level: scalar, sse2, avx2, avx512 or neon [default: the fastest that this CPU has]
    #[arg(long, value_name = "LEVEL")]
    simd: Option<Tier>,
}

impl SceneArgs {
    /// Reads and builds the scene with the overrides in place, to be studied in f32.
    ///
    /// # Errors
    /// A scene that can't be read or built, translations that f32 rounds too far, or settings that
    /// it can't have.
    pub fn build(&self) -> miette::Result<Scene> {
        Ok(self.read()?.build()?)
    }

    /// The most bytes that are read of a file, or of a line of a record.
    pub fn max_bytes(&self) -> u64 {
        self.files.max_bytes()
    }

    /// The file as named.
    pub fn path(&self) -> &Path {
        &self.scene
    }

    /// Reads the scene and puts the overrides in place.
    ///
    /// # Errors
    /// A scene that can't be read, or settings that no scene can have.
    pub fn read(&self) -> miette::Result<SceneFile> {
        self.read_other(&self.scene)
    }

    /// The same of another scene.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn read_other(&self, scene: &Path) -> miette::Result<SceneFile> {
        let mut file = SceneFile::read_within(scene, self.files.max_bytes())?;
        if let Some(frames) = self.frames.and_then(NonZeroU32::new) {
            file.spec.frames = frames;
        }
        if let Some(seed) = self.seed {
            file.spec.seed = seed;
        }
        self.cull.apply(&mut file.spec.cull);
        Ok(file)
    }

    /// The requested seed, if any.
    pub fn seed(&self) -> Option<u64> {
        self.seed
    }

    /// The default culling settings with the overrides in place.
    pub fn settings(&self) -> CullSettings {
        let mut settings = CullSettings::default();
        self.cull.apply(&mut settings);
        settings
    }

    /// A flag that only a scene can have, if one is given.
    pub fn scene_only(&self) -> Option<&'static str> {
        if self.seed.is_some() {
            return Some("--seed");
        }
        (self.cull != CullArgs::default()).then_some("a culling flag")
    }

    /// The requested number of frames, if any.
    pub fn frames(&self) -> Option<u32> {
        self.frames
    }

    /// The requested finder, if any.
    pub fn finder(&self) -> Option<Finder> {
        self.cull.pairs
    }

    /// The requested axes, if any.
    pub fn axes(&self) -> Option<Axes> {
        self.cull.axes
    }

    /// The requested strategy, if any.
    pub fn strategy(&self) -> Option<Strategy> {
        self.cull.strategy
    }
}

impl CullArgs {
    /// Puts the flags that were given over the settings.
    pub fn apply(&self, cull: &mut CullSettings) {
        fn over<T: Clone>(setting: &mut T, flag: Option<&T>) {
            if let Some(value) = flag {
                setting.clone_from(value);
            }
        }
        over(&mut cull.strategy, self.strategy.as_ref());
        over(&mut cull.pairs, self.pairs.as_ref());
        over(&mut cull.k, self.k.as_ref());
        over(&mut cull.axes, self.axes.as_ref());
        over(&mut cull.overlap, self.overlap.as_ref());
        over(&mut cull.updates, self.updates.as_ref());
        over(&mut cull.order, self.order.as_ref());
        if self.interest.is_some() {
            cull.interest.clone_from(&self.interest);
        }
        let tests = self.budget_tests.map(Budget::Tests);
        cull.budget = tests.or(self.budget_us.map(Budget::Microseconds)).or(cull.budget);
    }
}

/// Reads `0,5,7` or, as in a scene file, `{ body = 0, direction = [0, 0, 1], half_angle = 30 }`.
fn interest(text: &str) -> Result<Interest, String> {
    let value = if text.trim_start().starts_with(['{', '[']) {
        text.to_owned()
    } else {
        format!("[{text}]")
    };
    let read = ValueDeserializer::parse(&value).and_then(Interest::deserialize);
    // clap does not print help texts of errors, so it is part of the message.
    let hint = "body indices as in 0,5,7 or a cone as in { body = 0, direction = [0, 0, 1], half_angle = 30 }";
    read.map_err(|error| format!("interest: {}; {hint}", error.message()))
}

impl MachineArgs {
    /// The requested SIMD level, or the fastest.
    pub fn tier(&self) -> Tier {
        self.simd.unwrap_or_else(Tier::detect)
    }

    /// The SIMD level of `--simd`, if it was given.
    pub fn asked(&self) -> Option<Tier> {
        self.simd
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::{Interest, interest};

    /// Interest reads as a list or a cone.
    #[test]
    fn interest_parses_list_and_cone() {
        let list = interest("0, 5,7").unwrap();
        assert_eq!(list, Interest::Bodies(vec![0, 5, 7]));
        let cone = interest("{ body = 3, direction = [0, 0, 1], half_angle = 30 }").unwrap();
        let Interest::Cone(cone) = cone else { panic!("a cone") };
        assert_eq!(
            (cone.body, cone.direction, cone.half_angle, cone.range),
            (Some(3), [0.0, 0.0, 1.0], 30.0, None)
        );
        let error = interest("0,x").unwrap_err();
        assert!(error.starts_with("interest: "), "{error}");
    }
}
