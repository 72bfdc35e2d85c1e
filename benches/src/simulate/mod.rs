//! A scene's run: the listed effects move the bodies, the culler culls them, frame after frame.
//!
//! F frames are F culls and F − 1 steps: the first frame is the scene as placed. The trajectory
//! doesn't depend on how it is culled, so that runs which differ in
//! [`CullSettings`](sdop::settings::CullSettings) alone see the same poses.

mod scene_culler;

use miette::Diagnostic;
use thiserror::Error;

use crate::effects::{EffectError, EffectReport, Effects};
use crate::hash::volumes_sha256;
use crate::hash::{PairsDigest, PairsHash};
use crate::percentiles::Percentiles;
use crate::remedy::WithRemedy;
use crate::scene::{FineTranslations, Scene};
use sdop::bodies::Bodies;
use sdop::bodies::contract::ContractError;
use sdop::counters::{Counters, Seconds};
use sdop::culler::CullError;
use sdop::pairs::PairList;
use sdop::settings::Finder;
use sdop::simd::Tier;
use sdop::world::WorldError;

use scene_culler::SceneCuller;
pub(crate) use scene_culler::world_body;

/// The poses of a scene, frame after frame: the first is the scene as placed, every other one a
/// step of its effects.
///
/// As an iterator it yields a copy of each frame's bodies; [`Self::advance`] lends them instead.
pub struct Trajectory {
    bodies: Bodies,
    effects: Effects,
    next: u32,
    frames: u32,
}

impl Trajectory {
    /// The scene's own frames.
    ///
    /// # Errors
    /// An effect that the scene can't have; never for a scene just built.
    pub fn new(scene: &Scene) -> Result<Self, EffectError> {
        Ok(Self {
            bodies: scene.bodies.clone(),
            effects: scene.start_effects()?,
            next: 0,
            frames: scene.frames,
        })
    }

    /// The same trajectory with another number of frames.
    #[must_use]
    pub fn with_frames(self, frames: u32) -> Self {
        Self { frames, ..self }
    }

    /// Goes to the next frame and lends its bodies; `None` after the last.
    ///
    /// # Errors
    /// A body that left the contract, by its index and the frame.
    pub fn advance(&mut self) -> Result<Option<&Bodies>, SimulationError> {
        if self.next >= self.frames {
            return Ok(None);
        }
        let frame = self.next;
        if frame > 0 {
            let step = self.effects.step(&mut self.bodies);
            step.map_err(|error| SimulationError::contract(frame, error))?;
        }
        self.next += 1;
        Ok(Some(&self.bodies))
    }

    /// The number of the frame to come.
    #[must_use]
    pub fn next_number(&self) -> u32 {
        self.next
    }

    /// Every effect of the scene with its steps and seconds so far.
    pub fn reports(&self) -> &[EffectReport] {
        self.effects.reports()
    }
}

impl Iterator for Trajectory {
    type Item = Result<Bodies, SimulationError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.advance().map(|bodies| bodies.cloned()).transpose()
    }
}

/// A scene being run.
pub struct Simulation<'a> {
    scene: &'a Scene,
    trajectory: Trajectory,
    culler: SceneCuller,
}

/// One culled frame.
#[derive(Clone, Copy, Debug)]
pub struct SimulatedFrame<'a> {
    /// Counted from 0.
    pub number: u32,
    /// The poses that were culled, with translations rounded to f32.
    pub bodies: &'a Bodies,
    /// The translations that f32 doesn't hold.
    pub fine: &'a FineTranslations,
    /// The reported pairs, in the finder's order.
    pub pairs: &'a PairList,
    /// What this frame's culling counted.
    pub counters: Counters,
    /// What it took; without construction and effects.
    pub seconds: Seconds,
}

/// What a finished run says of itself. Counters and hashes are equal on every CPU, tier and thread
/// count.
#[derive(Clone, Debug)]
pub struct Summary {
    /// Sums over frames.
    pub counters: Counters,
    /// Sums over frames, with construction (shapes and culler) and effects.
    pub seconds: Seconds,
    /// The time of culling a single frame.
    pub frame_seconds: Percentiles,
    /// Every effect, listed or not.
    pub effects: Vec<EffectReport>,
    /// The pair finder in use: the requested one, or the one that `auto` picked.
    pub finder: Finder,
    /// The hash of all volumes.
    pub volumes_sha256: String,
    /// The hash of all reported pairs; `None` for the control, which reports none.
    pub pairs_sha256: Option<String>,
    /// The order-free digest of the same pairs.
    pub pairs_digest: Option<String>,
}

/// Why a scene can't be run on.
#[derive(Debug, Error, Diagnostic)]
pub enum SimulationError {
    /// A culler that can't be made, or bodies that it refuses.
    #[error("{}", .0.problem())]
    #[diagnostic(help("{}", .0.help()))]
    Cull(CullError),
    /// A world that can't be made, or bodies that it refuses.
    #[error("{}", .0.problem())]
    #[diagnostic(help("{}", .0.help()))]
    World(WorldError),
    /// An effect that the scene can't have.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Effect(#[from] EffectError),
    /// A body left the contract.
    #[error("frame {frame}: {error}")]
    Contract {
        /// The frame that its step led to.
        frame: u32,
        /// The body and what is wrong with it.
        #[diagnostic_source]
        error: WithRemedy<ContractError>,
    },
}

crate::remedy::held_with_remedy!(SimulationError, Cull(CullError), World(WorldError));

impl SimulationError {
    /// A body that left the contract in the step to `frame`.
    pub(crate) fn contract(frame: u32, error: ContractError) -> Self {
        let error = WithRemedy(error);
        Self::Contract { frame, error }
    }
}

impl<'a> Simulation<'a> {
    /// Prepares a run of the scene, culled as its `cull` says in the tier `tier` on the caller's
    /// thread.
    ///
    /// # Errors
    /// Effects or culling that the scene can't have; never for a scene just built.
    pub fn new(scene: &'a Scene, tier: Tier) -> Result<Self, SimulationError> {
        Self::with_threads(scene, tier, 1)
    }

    /// The same culling on several threads; only seconds depend on their number.
    ///
    /// # Errors
    /// As [`Self::new`], and threads that the system refuses to start.
    pub fn with_threads(
        scene: &'a Scene,
        tier: Tier,
        threads: usize,
    ) -> Result<Self, SimulationError> {
        Ok(Self {
            scene,
            trajectory: Trajectory::new(scene)?,
            culler: SceneCuller::new(scene, tier, threads)?,
        })
    }

    /// Advances to the next frame (the first needs no step) and culls it; `None` after the last.
    ///
    /// # Errors
    /// A body that left the contract, by its index and the frame.
    pub fn next_frame(&mut self) -> Result<Option<SimulatedFrame<'_>>, SimulationError> {
        let number = self.trajectory.next_number();
        let Some(bodies) = self.trajectory.advance()? else {
            return Ok(None);
        };
        let (counted, took) = (*self.culler.counters(), self.culler.seconds());
        self.culler.cull(self.scene, bodies)?;
        Ok(Some(SimulatedFrame {
            number,
            pairs: self.culler.pairs(),
            bodies,
            fine: &self.scene.fine,
            counters: self.culler.counters().since(&counted),
            seconds: self.culler.seconds().since(&took),
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
            effects: self.trajectory.reports().iter().map(|e| e.seconds).sum(),
            ..culling
        }
    }

    /// Runs to the last frame. `observe` sees every frame, after its culling and outside of the
    /// timing.
    ///
    /// # Errors
    /// As [`Self::next_frame`], or what `observe` returns.
    pub fn run<E: From<SimulationError>>(
        mut self,
        mut observe: impl FnMut(&SimulatedFrame<'_>) -> Result<(), E>,
    ) -> Result<Summary, E> {
        let (mut hash, mut digest) = (PairsHash::default(), PairsDigest::default());
        let mut frames = Vec::new();
        while let Some(frame) = self.next_frame()? {
            frames.push(frame.seconds.total);
            hash.frame(frame.number, &frame.pairs.sorted());
            digest.add(frame.number, frame.pairs.iter());
            observe(&frame)?;
        }
        let culls = self.scene.cull.strategy.scheme().culls();
        Ok(Summary {
            counters: *self.counters(),
            seconds: self.seconds(),
            frame_seconds: Percentiles::of(frames),
            effects: self.trajectory.reports().to_vec(),
            finder: self.culler.finder(),
            volumes_sha256: volumes_sha256(&self.scene.shapes),
            pairs_sha256: culls.then(|| hash.finish()),
            pairs_digest: culls.then(|| digest.finish()),
        })
    }
}

/// Runs the whole scene in the tier `tier`, on the caller's thread: [`Simulation::run`] of a new
/// simulation.
///
/// # Errors
/// As [`Simulation::new`] and [`Simulation::run`].
pub fn run<E: From<SimulationError>>(
    scene: &Scene,
    tier: Tier,
    observe: impl FnMut(&SimulatedFrame<'_>) -> Result<(), E>,
) -> Result<Summary, E> {
    Simulation::new(scene, tier)?.run(observe)
}
