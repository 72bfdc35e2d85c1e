//! A culler or a world of this library as a contestant, timed per stage, and optionally followed by
//! a test of convex hulls.

use std::time::Instant;

use super::counts::Counts;
use super::scene_world::SceneWorld;
use super::waiting_time::WaitingTime;
use crate::hull_test::HullTest;
use sdop::bodies::Bodies;
use sdop::counters::{Counters, Seconds, VolumeCounters};
use sdop::culler::{CullError, Culler};
use sdop::settings::CullSettings;
use sdop::simd::Tier;
use sdop::volume::Shape;
use sdop::world::WorldError;
use sdop_judge::contestant::Contestant;

/// Seconds of one frame, stage by stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct StageSeconds {
    /// World-space updates.
    pub update: f64,
    /// Finding candidates and the first volume test, and everything that no other stage includes.
    pub finding: f64,
    /// The or-DOP test, including the cost of passing pairs to it if that is timed together.
    pub refining: f64,
    /// The convex hulls' test.
    pub hulls: f64,
}

impl StageSeconds {
    /// All stages.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.update + self.finding + self.refining + self.hulls
    }

    /// The stages without some seconds of waiting, which are subtracted from the longest stage,
    /// where the interruption most likely was.
    #[must_use]
    pub fn without(mut self, waited: f64) -> Self {
        let stages = [&mut self.update, &mut self.finding, &mut self.refining, &mut self.hulls];
        let longest = stages.into_iter().max_by(|a, b| a.total_cmp(b));
        if let Some(longest) = longest {
            *longest = (*longest - waited).max(0.0);
        }
        self
    }
}

/// What culls.
#[derive(Debug)]
enum Engine {
    /// It is given all poses.
    Culler(Box<Culler>),
    /// It is given the poses that have changed.
    World(Box<SceneWorld>),
}

impl Engine {
    fn cull(&mut self, frame: &Bodies) -> Result<(), WorldError> {
        match self {
            Self::Culler(culler) => Ok(culler.cull(frame).map(drop)?),
            Self::World(world) => world.cull(frame),
        }
    }

    fn seconds(&self) -> &Seconds {
        match self {
            Self::Culler(culler) => culler.seconds(),
            Self::World(world) => world.world.seconds(),
        }
    }
}

/// A culler of this library, timed per stage, and optionally followed by a test of convex hulls.
#[derive(Debug)]
pub struct Culling {
    engine: Engine,
    hulls: Option<HullTest>,
    /// Seconds of the last frame.
    pub last: StageSeconds,
    /// Seconds of building it, without the shapes' volumes.
    pub construct: f64,
    refused: Option<WorldError>,
}

impl Culling {
    /// Culls bodies by some settings.
    ///
    /// # Errors
    /// Invalid settings or bodies.
    pub fn new(
        shapes: &[Shape],
        bodies: &Bodies,
        settings: &CullSettings,
        tier: Tier,
    ) -> Result<Self, CullError> {
        let mut waiting = WaitingTime::of_this_thread();
        let (waited, start) = (waiting.seconds(), Instant::now());
        let culler = Culler::builder().settings(settings).tier(tier);
        let culler = culler.build(shapes, bodies)?;
        let seconds = start.elapsed().as_secs_f64();
        let construct = (seconds - (waiting.seconds() - waited)).max(0.0);
        Ok(Self::of(Engine::Culler(Box::new(culler)), construct))
    }

    /// Culls bodies in a world, which keeps the pairs of those that haven't moved.
    ///
    /// # Errors
    /// Invalid settings or bodies.
    pub fn in_world(
        shapes: &[Shape],
        bodies: &Bodies,
        settings: &CullSettings,
        tier: Tier,
    ) -> Result<Self, WorldError> {
        let world = SceneWorld::new(shapes, bodies, settings, tier)?;
        let construct = world.construct;
        Ok(Self::of(Engine::World(Box::new(world)), construct))
    }

    fn of(engine: Engine, construct: f64) -> Self {
        Self { engine, hulls: None, last: StageSeconds::default(), construct, refused: None }
    }

    /// Adds a test of each pair that the culler reports by its convex hulls; none in a world.
    #[must_use]
    pub fn with_hulls(mut self, shapes: &[Shape]) -> Self {
        let start = Instant::now();
        self.hulls = Some(HullTest::new(shapes));
        self.construct += start.elapsed().as_secs_f64();
        self
    }

    /// Whether every frame so far was culled.
    ///
    /// # Errors
    /// The error of the first rejected frame; frames of a scene are never rejected.
    pub fn accepted(&self) -> Result<(), WorldError> {
        self.refused.clone().map_or(Ok(()), Err)
    }

    /// The culler's counters, summed over frames.
    #[must_use]
    pub fn counters(&self) -> Counters {
        match &self.engine {
            Engine::Culler(culler) => *culler.counters(),
            Engine::World(world) => world.counters(),
        }
    }

    /// The hulls' counters, summed over frames.
    #[must_use]
    pub fn hull_counters(&self) -> VolumeCounters {
        let hulls = self.hulls.as_ref();
        hulls.map_or_else(Default::default, |hulls| hulls.counters)
    }

    /// All counters, summed over frames.
    #[must_use]
    pub fn counts(&self) -> Counts {
        Counts { culler: self.counters(), hulls: self.hull_counters() }
    }
}

impl Contestant for Culling {
    fn frame(&mut self, frame: &Bodies) {
        if let Engine::World(world) = &mut self.engine {
            world.find_moved(frame);
        }
        let before = *self.engine.seconds();
        let start = Instant::now();
        let answer = self.engine.cull(frame);
        self.refused = self.refused.take().or(answer.err());
        let culled = start.elapsed().as_secs_f64();
        if let (Some(hulls), Engine::Culler(culler)) = (&mut self.hulls, &self.engine) {
            hulls.cull(frame, culler.pairs());
        }
        let stages = self.engine.seconds().since(&before);
        self.last = StageSeconds {
            update: stages.update,
            finding: culled - stages.update - stages.ordop,
            refining: stages.ordop,
            hulls: start.elapsed().as_secs_f64() - culled,
        };
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        match (&self.hulls, &self.engine) {
            (Some(hulls), _) => hulls.kept.iter().collect(),
            (None, Engine::Culler(culler)) => culler.pairs().iter().collect(),
            (None, Engine::World(world)) => world.pairs(),
        }
    }
}
