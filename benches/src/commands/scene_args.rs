//! The arguments of every command that runs a scene: the file, and flags that override its values.

use std::ffi::OsStr;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};

use clap::builder::{PossibleValue, TypedValueParser};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use miette::miette;
use sdop::Tier;
use sdop::choice::nearest;
use sdop::settings::{
    Axes, Budget, CullSettings, Finder, Interest, Order, Overlap, Strategy, TestedVolume, Updates,
};
use sdop::volume::DirectionSet;
use sdop_bench::scene::SceneFile;
use sdop_bench::tradeoff::variant::named;
use serde::Deserialize as _;
use toml::de::ValueDeserializer;

use super::files::ReadArgs;
use super::one_of;

/// A scene file and flags that override it; `C` are the culling flags that the command takes.
#[derive(clap::Args)]
pub struct SceneArgs<C: clap::Args = CullArgs> {
    /// The scene file (TOML), for example data/scenes/paper-500.toml
    #[arg(id = "scene", value_name = "SCENE")]
    pub path: PathBuf,
    /// Frames to cull; the first is the scene as placed
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    pub frames: Option<u32>,
    /// The seed of all random draws
    #[arg(long)]
    pub seed: Option<u64>,
    #[command(flatten)]
    files: ReadArgs,
    #[command(flatten)]
    pub cull: C,
}

/// Flags that override the scene's `[cull]` table, key by key.
pub trait Overrides {
    /// Puts the flags that were given over the settings.
    fn apply(&self, cull: &mut CullSettings);
}

/// All such flags.
#[derive(Clone, Debug, Default, PartialEq, clap::Args)]
#[command(next_help_heading = "Culling (each overrides the scene's [cull])")]
pub struct CullArgs {
    /// Which volumes are tested, and in which order: a strategy, or a variant as tables name it,
    /// such as "s-dop 26, model" or or-14
    #[arg(long, value_parser = StrategyParser)]
    strategy: Option<String>,
    #[command(flatten)]
    of_variants: VariantArgs,
    /// Number of the or-DOP's half-spaces
    #[arg(long, value_parser = one_of::<DirectionSet>(DirectionSet::NAMES))]
    k: Option<DirectionSet>,
    /// When or-DOPs are updated
    #[arg(long, value_parser = one_of::<Updates>(Updates::NAMES))]
    updates: Option<Updates>,
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

/// The flags that a comparison of all variants leaves open.
#[derive(Clone, Debug, Default, PartialEq, clap::Args)]
#[command(next_help_heading = "Culling (each overrides the scene's [cull])")]
pub struct VariantArgs {
    #[command(flatten)]
    tried: CandidateArgs,
    /// Which separating axes the or-DOP test tries
    #[arg(long, value_parser = one_of::<Overlap>(Overlap::NAMES))]
    overlap: Option<Overlap>,
    /// Bodies of interest, as in 0,5,7, or a view cone, as in '{ body = 0, direction = [0, 0, 1],
    /// half_angle = 30 }'
    #[arg(long, value_parser = interest)]
    interest: Option<Interest>,
}

/// The flags that limit what a recommendation tries.
#[derive(Clone, Debug, Default, PartialEq, clap::Args)]
#[command(next_help_heading = "Culling (each overrides the scene's [cull])")]
pub struct CandidateArgs {
    /// Pair finder: how candidates for the first volume test are found
    #[arg(long, value_name = "FINDER", value_parser = one_of::<Finder>(Finder::NAMES))]
    pub pairs: Option<Finder>,
    /// The or-DOP's axes
    #[arg(long, value_parser = one_of::<Axes>(Axes::NAMES))]
    pub axes: Option<Axes>,
}

/// The machine's resources that the culler uses.
#[derive(clap::Args)]
#[command(next_help_heading = "Machine")]
pub struct MachineArgs {
    /// SIMD level: scalar, sse2, avx2, avx512 or neon [default: the fastest that this CPU has]
    #[arg(long, value_name = "LEVEL")]
    pub simd: Option<Tier>,
}

impl<C: clap::Args + Overrides> SceneArgs<C> {
    /// The most bytes that are read of a file, or of a line of a record.
    pub fn max_bytes(&self) -> u64 {
        self.files.max_bytes()
    }

    /// Reads the scene and puts the overrides in place.
    ///
    /// # Errors
    /// A scene that can't be read, or settings that no scene can have.
    pub fn read(&self) -> miette::Result<SceneFile> {
        self.read_other(&self.path)
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
        if let Some(warning) = file.spec.idle_speed() {
            eprintln!("warning: {}: {warning}", scene.display());
        }
        Ok(file)
    }
}

impl SceneArgs {
    /// Reads the scene, whose strategy decides which of the flags have an effect.
    ///
    /// # Errors
    /// As [`Self::read`]; a flag without effect.
    pub fn read_culled(&self) -> miette::Result<SceneFile> {
        let file = self.read()?;
        match self.cull.without_effect(&file.spec.cull) {
            None => Ok(file),
            Some((flag, why)) => Err(miette!(
                help = format!("leave {flag} out, or choose another --strategy"),
                "{flag} has no effect: {} {why}",
                file.spec.cull.strategy
            )),
        }
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

    /// The requested strategy, if any.
    pub fn strategy(&self) -> Option<Strategy> {
        self.cull.strategy.is_some().then(|| self.settings().strategy)
    }
}

/// Puts a flag over a setting.
fn over<T: Clone>(setting: &mut T, flag: Option<&T>) {
    if let Some(value) = flag {
        setting.clone_from(value);
    }
}

impl Overrides for CandidateArgs {
    fn apply(&self, cull: &mut CullSettings) {
        over(&mut cull.pairs, self.pairs.as_ref());
        over(&mut cull.axes, self.axes.as_ref());
    }
}

impl Overrides for VariantArgs {
    fn apply(&self, cull: &mut CullSettings) {
        self.tried.apply(cull);
        over(&mut cull.overlap, self.overlap.as_ref());
        if self.interest.is_some() {
            cull.interest.clone_from(&self.interest);
        }
    }
}

impl Overrides for CullArgs {
    fn apply(&self, cull: &mut CullSettings) {
        self.of_variants.apply(cull);
        over(&mut cull.k, self.k.as_ref());
        over(&mut cull.updates, self.updates.as_ref());
        over(&mut cull.order, self.order.as_ref());
        let tests = self.budget_tests.map(Budget::Tests);
        cull.budget = tests.or(self.budget_us.map(Budget::Microseconds)).or(cull.budget);
        if let Some(variant) = self.strategy.as_deref().and_then(|name| named(cull, name)) {
            *cull = variant.settings;
        }
    }
}

impl CullArgs {
    /// A flag that changes nothing, and why.
    fn without_effect(&self, cull: &CullSettings) -> Option<(&'static str, &'static str)> {
        let scheme = cull.strategy.scheme();
        let has = |volume| scheme.volumes().any(|own| own == volume);
        let (is_oriented, has_k) = (has(TestedVolume::OrDop), has(TestedVolume::KDop));
        let is_critical = cull.strategy == Strategy::SDopTimeCritical;
        let critical = "has no budget";
        let given = [
            ("--k", self.k.is_some() && !is_oriented && !has_k, "has no k"),
            ("--axes", self.of_variants.tried.axes.is_some() && !is_oriented, "has no or-DOP"),
            ("--overlap", self.of_variants.overlap.is_some() && !is_oriented, "has no or-DOP"),
            ("--updates", self.updates.is_some() && !is_oriented, "has no or-DOP"),
            ("--budget-tests", self.budget_tests.is_some() && !is_critical, critical),
            ("--budget-us", self.budget_us.is_some() && !is_critical, critical),
            ("--order", self.order.is_some() && !is_critical, critical),
        ];
        given.into_iter().find(|(_, is_idle, _)| *is_idle).map(|(flag, _, why)| (flag, why))
    }
}

/// Parses the name of a strategy or of a variant; help lists the strategies.
#[derive(Clone)]
struct StrategyParser;

impl TypedValueParser for StrategyParser {
    type Value = String;

    fn parse_ref(
        &self,
        command: &clap::Command,
        argument: Option<&clap::Arg>,
        value: &OsStr,
    ) -> Result<String, clap::Error> {
        let text = value.to_string_lossy();
        if named(&CullSettings::default(), &text).is_some_and(|variant| !variant.hulls) {
            return Ok(text.into_owned());
        }
        let mut error = clap::Error::new(ErrorKind::InvalidValue).with_cmd(command);
        let mut add = |kind, value| drop(error.insert(kind, value));
        let flag = argument.map_or_else(|| "--strategy".to_owned(), ToString::to_string);
        add(ContextKind::InvalidArg, ContextValue::String(flag));
        add(ContextKind::InvalidValue, ContextValue::String(text.clone().into_owned()));
        let names = Strategy::NAMES.iter().map(|name| (*name).to_owned());
        add(ContextKind::ValidValue, ContextValue::Strings(names.collect()));
        let begins = Strategy::NAMES.iter().find(|name| name.starts_with(&*text));
        let similar = begins.copied().or_else(|| nearest(&text, Strategy::NAMES.iter().copied()));
        let tip = match similar {
            Some(name) => format!("a similar value exists: '{name}'"),
            None => "variants are named as in tables: \"s-dop 26\", \"s-dop 14, model, one-sided\", or-18; hulls are \
                     tested by no strategy"
                .to_owned(),
        };
        add(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
        Err(error)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(Strategy::NAMES.iter().map(PossibleValue::new)))
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
