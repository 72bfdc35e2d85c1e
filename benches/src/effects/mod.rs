//! Effects: what moves the bodies between two frames. Only the effects that a scene lists run, so
//! others cost nothing. The paper's scenes need only motion and walls.
//!
//! To add an effect, write a file with its `Settings` (its form in a scene file) and `new`, and add
//! its name below. Trajectories must be equal to the bit on every platform: the state is f32,
//! operations have a fixed order without FMA, and square roots and trigonometry use `libm`. The
//! same holds for intermediate f64.

pub mod brownian;
mod contacts;
pub mod gravity;
pub mod motion;
pub mod response;
pub mod rest;
pub mod spin;
mod velocities;
pub mod walls;

pub use velocities::Velocities;

use std::ops::Range;
use std::time::Instant;

use miette::Diagnostic;
use thiserror::Error;
use toml::Spanned;

use sdop::bodies::Bodies;
use sdop::bodies::contract::{ContractError, check_poses};
use sdop::rounding::pose;
use sdop::volume::Shape;

/// The initial state of a scene, from which effects are built.
#[derive(Clone, Copy, Debug)]
pub struct InitialState<'a> {
    /// The seed of all random draws.
    pub seed: u64,
    /// Seconds per step.
    pub dt: f32,
    /// Distance between opposite walls of the box about the origin, if there is one.
    pub side: Option<f32>,
    /// The bodies' shapes.
    pub shapes: &'a [Shape],
    /// The initial poses.
    pub bodies: &'a Bodies,
    /// The runs of bodies of the whole scene that may move; `bodies` may be a part of it.
    pub moving: &'a [Range<usize>],
    /// The initial velocities.
    pub velocities: &'a Velocities,
}

/// The world position of a body-frame point, computed in f64 and rounded once; t itself for the
/// body origin.
pub(crate) fn world_centre(point: [f32; 3], q: &[f32; 4], t: &[f32; 3]) -> [f32; 3] {
    if point == [0.0; 3] {
        return *t;
    }
    pose::transform(&pose::rotation(*q), point, *t).map(|x| x as f32)
}

/// One way in which bodies change from frame to frame.
pub trait Effect: Send {
    /// Advances the bodies by one step and returns how many it changed. `dynamic` are the runs of
    /// bodies that may move and aren't asleep; all others stay as they are.
    fn step(
        &mut self,
        bodies: &mut Bodies,
        velocities: &mut Velocities,
        dynamic: &[Range<usize>],
    ) -> u64;

    /// Whether it also reads or changes bodies that are asleep: its runs then include them.
    fn wakes(&self) -> bool {
        false
    }

    /// The runs of bodies that are awake from now on, if the effect puts bodies to sleep.
    fn awake(&self) -> Option<&[Range<usize>]> {
        None
    }

    /// Sets which bodies of the scene these are, by their numbers in ascending order. Effects that
    /// draw bodies from the whole scene need them.
    fn renumber(&mut self, _numbers: &[u32]) {}
}

/// The error for an effect that a scene lists but can't have.
#[derive(Clone, Debug, PartialEq, Error, Diagnostic)]
#[error("{effect}: {problem}")]
pub struct EffectError {
    /// The effect's name.
    pub effect: &'static str,
    /// Why the scene can't have it.
    pub problem: String,
    /// How to mend it.
    #[help]
    pub hint: &'static str,
    /// The bytes of the scene file that list the effect.
    pub span: Range<usize>,
}

/// What `new` of an effect returns: the effect, or a problem and a hint.
type BuiltEffect = Result<Box<dyn Effect>, (String, &'static str)>;

/// Declares the effects in the order in which a step applies them; the names are the keys of
/// `[effects]`.
macro_rules! effects {
    ($($name:ident,)+) => {
        /// The `[effects]` table of a scene.
        #[derive(Clone, Debug, Default, PartialEq, serde::Deserialize)]
        #[serde(deny_unknown_fields, default)]
        pub struct EffectsSpec {
            $(#[doc = concat!("The effect `", stringify!($name), "`, if listed.")]
            pub $name: Option<Spanned<$name::Settings>>,)+
        }

        /// Every effect's name, in the order in which a step applies them.
        pub const NAMES: &[&str] = &[$(stringify!($name)),+];

        impl EffectsSpec {
            /// Every effect's name, in the order of [`NAMES`], and whether the scene lists it.
            #[must_use]
            pub fn lists(&self) -> Vec<(&'static str, bool)> {
                vec![$((stringify!($name), self.$name.is_some())),+]
            }
        }

        /// The listed effects and the place of each in [`NAMES`].
        fn listed(spec: &EffectsSpec, start: &InitialState<'_>) -> Result<Vec<(usize, Box<dyn Effect>)>, EffectError> {
            let mut list = Vec::new();
            let mut place = 0;
            $(if let Some(settings) = &spec.$name {
                let made = $name::new(settings.get_ref(), start);
                list.push((place, made.map_err(|(problem, hint)| {
                    EffectError { effect: NAMES[place], problem, hint, span: settings.span() }
                })?));
            }
            place += 1;)+
            debug_assert_eq!(place, NAMES.len());
            Ok(list)
        }
    };
}

// Velocities first, then which bodies are asleep, then poses from the new velocities (semi-implicit
// Euler), and the walls last, so that every frame's spheres lie inside of them.
effects! {
    gravity,
    brownian,
    response,
    rest,
    motion,
    spin,
    walls,
}

/// What an effect did in a run, and its price.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct EffectReport {
    /// The effect's name.
    pub name: &'static str,
    /// Whether the scene lists it; if not, it is not simulated and everything below is zero.
    pub listed: bool,
    /// Steps taken.
    pub steps: u64,
    /// Bodies that it was given, summed over steps: all dynamic ones, without those asleep unless
    /// it may wake them. `seconds / visited` is the price per body.
    pub visited: u64,
    /// Bodies changed, summed over steps.
    pub changed: u64,
    /// Wall time, summed over steps.
    pub seconds: f64,
}

/// The effects of one run, and the velocities between its frames.
pub struct Effects {
    velocities: Velocities,
    running: Vec<(usize, Box<dyn Effect>)>,
    reports: Vec<EffectReport>,
    dynamic: Vec<Range<usize>>,
    /// The dynamic bodies that aren't asleep.
    awake: Vec<Range<usize>>,
}

impl Effects {
    /// The effects that a scene lists, for a run from its initial state.
    ///
    /// # Errors
    /// An effect that the scene can't have, such as walls without a box.
    pub fn new(spec: &EffectsSpec, start: &InitialState<'_>) -> Result<Self, EffectError> {
        let running = listed(spec, start)?;
        let report = |&name| EffectReport {
            name,
            listed: false,
            steps: 0,
            visited: 0,
            changed: 0,
            seconds: 0.0,
        };
        let mut reports: Vec<EffectReport> = NAMES.iter().map(report).collect();
        for (place, _) in &running {
            reports[*place].listed = true;
        }
        let dynamic = runs(&start.bodies.dynamic);
        Ok(Self {
            velocities: start.velocities.clone(),
            awake: awake(&running).unwrap_or(&dynamic).to_vec(),
            running,
            reports,
            dynamic,
        })
    }

    /// Advances the bodies from one frame to the next and checks the contract where bodies may have
    /// moved.
    ///
    /// # Errors
    /// A body that left the contract, by its index.
    pub fn step(&mut self, bodies: &mut Bodies) -> Result<(), ContractError> {
        if self.running.is_empty() {
            return Ok(());
        }
        for (place, effect) in &mut self.running {
            let start = Instant::now();
            let runs = match effect.wakes() {
                true => &self.dynamic,
                false => &self.awake,
            };
            let visited: usize = runs.iter().map(Range::len).sum();
            let changed = effect.step(bodies, &mut self.velocities, runs);
            if let Some(awake) = effect.awake() {
                self.awake.clear();
                self.awake.extend_from_slice(awake);
            }
            let report = &mut self.reports[*place];
            report.seconds += start.elapsed().as_secs_f64();
            report.steps += 1;
            report.visited += visited as u64;
            report.changed += changed;
        }
        self.awake.iter().try_for_each(|run| check_poses(bodies, run.clone()))
    }

    /// Replaces the set of bodies: their `numbers` in the scene in ascending order, their
    /// velocities, and the runs among them that this process moves. How far each effect has come
    /// stays.
    pub fn replace(&mut self, numbers: &[u32], velocities: Velocities, moving: Vec<Range<usize>>) {
        for (_, effect) in &mut self.running {
            effect.renumber(numbers);
        }
        self.awake = awake(&self.running).unwrap_or(&moving).to_vec();
        (self.velocities, self.dynamic) = (velocities, moving);
    }

    /// Takes the velocities out, for a [`Self::replace`] to come.
    pub fn take_velocities(&mut self) -> Velocities {
        std::mem::take(&mut self.velocities)
    }

    /// The velocities of all bodies now.
    #[must_use]
    pub fn velocities(&self) -> &Velocities {
        &self.velocities
    }

    /// What each effect did so far, listed or not, in the order of [`NAMES`].
    #[must_use]
    pub fn reports(&self) -> &[EffectReport] {
        &self.reports
    }
}

/// The runs of bodies that are awake, if an effect puts bodies to sleep.
fn awake(running: &[(usize, Box<dyn Effect>)]) -> Option<&[Range<usize>]> {
    running.iter().find_map(|(_, effect)| effect.awake())
}

/// The runs of consecutive `true`.
pub(crate) fn runs(flags: &[bool]) -> Vec<Range<usize>> {
    let mut end = 0;
    let groups = flags.chunk_by(|a, b| a == b).map(|group| {
        let start = end;
        end += group.len();
        (group[0], start..end)
    });
    groups.filter_map(|(set, run)| set.then_some(run)).collect()
}
