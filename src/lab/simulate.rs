//! A scene's run: the listed effects move the bodies, the culler culls them, frame after frame.
//!
//! F frames are F culls and F − 1 steps: the first frame is the scene as placed. The trajectory doesn't depend on how it is
//! culled, so that runs which differ in [`CullSettings`](crate::settings::CullSettings) alone see the same poses.

use miette::Diagnostic;
use thiserror::Error;

use crate::bodies::Bodies;
use crate::bodies::contract::ContractError;
use crate::counters::{Counters, Seconds};
use crate::culler::Culler;
use crate::lab::effects::{EffectError, EffectReport, Effects};
use crate::lab::hash::PairsHash;
use crate::lab::hash::volumes_sha256;
use crate::lab::scene::Scene;
use crate::pairs::PairList;
use crate::settings::{Finder, SettingsError, Strategy};
use crate::simd::Tier;
use crate::threads::ThreadsError;

/// A scene being run.
pub struct Simulation<'a> {
    scene: &'a Scene,
    bodies: Bodies,
    effects: Effects,
    culler: Culler,
    frame: u32,
}

/// One culled frame.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// Counted from 0.
    pub number: u32,
    /// The poses that were culled.
    pub bodies: &'a Bodies,
    /// The reported pairs, in the finder's order.
    pub pairs: &'a PairList,
}

/// What a finished run says of itself. Counters and hashes are equal on every CPU, tier and thread count.
#[derive(Clone, Debug)]
pub struct Summary {
    /// Sums over frames.
    pub counters: Counters,
    /// Sums over frames, with construction (shapes and culler) and effects.
    pub seconds: Seconds,
    /// Every effect, listed or not.
    pub effects: Vec<EffectReport>,
    /// The pair finder at work: the one asked for, or what `auto` picked.
    pub finder: Finder,
    /// The hash of all volumes.
    pub volumes_sha256: String,
    /// The hash of all reported pairs; `None` for the control, which reports none.
    pub pairs_sha256: Option<String>,
}

/// Why a scene can't be run on.
#[derive(Debug, Error, Diagnostic)]
pub enum SimulationError {
    /// Culling settings that can't be carried out.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Settings(#[from] SettingsError),
    /// An effect that the scene can't have.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Effect(#[from] EffectError),
    /// Threads that the system refused.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Threads(#[from] ThreadsError),
    /// A body left the contract.
    #[error("frame {frame}: {error}")]
    Contract {
        /// The frame that its step led to.
        frame: u32,
        /// The body and what is wrong with it.
        #[diagnostic_source]
        error: ContractError,
    },
}

impl<'a> Simulation<'a> {
    /// Prepares a run of the scene, culled as its `cull` says in the tier `tier`.
    ///
    /// # Errors
    /// Effects or culling that the scene can't have; never for a scene just built.
    pub fn new(scene: &'a Scene, tier: Tier) -> Result<Self, SimulationError> {
        Ok(Self {
            scene,
            bodies: scene.bodies.clone(),
            effects: scene.start_effects()?,
            culler: Culler::new(&scene.shapes, &scene.bodies, &scene.cull, tier)?,
            frame: 0,
        })
    }

    /// The same simulation culling on so many threads; nothing but seconds depends on their number.
    ///
    /// # Errors
    /// The system refuses to start the threads.
    pub fn with_threads(mut self, threads: usize) -> Result<Self, SimulationError> {
        self.culler = self.culler.with_threads(threads)?;
        Ok(self)
    }

    /// Advances to the next frame (the first needs no step) and culls it; `None` after the last.
    ///
    /// # Errors
    /// A body that left the contract, by its index and the frame.
    pub fn next_frame(&mut self) -> Result<Option<Frame<'_>>, SimulationError> {
        let number = self.frame;
        if number == self.scene.frames {
            return Ok(None);
        }
        if number > 0 {
            let step = self.effects.step(&mut self.bodies);
            step.map_err(|error| SimulationError::Contract {
                frame: number,
                error,
            })?;
        }
        self.frame += 1;
        Ok(Some(Frame {
            number,
            pairs: self.culler.cull(&self.bodies),
            bodies: &self.bodies,
        }))
    }

    /// Counters summed over the frames so far.
    #[must_use]
    pub fn counters(&self) -> &Counters {
        self.culler.counters()
    }

    /// Seconds summed over the frames so far, with construction (shapes and culler) and effects.
    #[must_use]
    pub fn seconds(&self) -> Seconds {
        let culling = self.culler.seconds();
        Seconds {
            construct: self.scene.construct_seconds + culling.construct,
            effects: self.effects.reports().iter().map(|e| e.seconds).sum(),
            ..*culling
        }
    }

    /// Runs to the last frame. `observe` sees every frame, after its culling and outside of the timing.
    ///
    /// # Errors
    /// As [`Self::next_frame`], or what `observe` returns.
    pub fn run<E: From<SimulationError>>(
        mut self,
        mut observe: impl FnMut(&Frame<'_>) -> Result<(), E>,
    ) -> Result<Summary, E> {
        let mut hash = PairsHash::default();
        while let Some(frame) = self.next_frame()? {
            hash.frame(frame.number, &frame.pairs.sorted());
            observe(&frame)?;
        }
        let culls = self.scene.cull.strategy != Strategy::None;
        Ok(Summary {
            counters: *self.counters(),
            seconds: self.seconds(),
            effects: self.effects.reports().to_vec(),
            finder: self.culler.finder(),
            volumes_sha256: volumes_sha256(&self.scene.shapes),
            pairs_sha256: culls.then(|| hash.finish()),
        })
    }
}

/// Runs the whole scene in the tier `tier`, on the caller's thread: [`Simulation::run`] of a new simulation.
///
/// # Errors
/// As [`Simulation::new`] and [`Simulation::run`].
pub fn run<E: From<SimulationError>>(
    scene: &Scene,
    tier: Tier,
    observe: impl FnMut(&Frame<'_>) -> Result<(), E>,
) -> Result<Summary, E> {
    Simulation::new(scene, tier)?.run(observe)
}
