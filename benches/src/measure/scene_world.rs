//! A world that is given a scene's frames as an engine gives them: only bodies that have moved are
//! set.

use std::time::Instant;

use super::waiting_time::WaitingTime;
use crate::simulate::world_body;
use sdop::bodies::Bodies;
use sdop::counters::Counters;
use sdop::culler::Culler;
use sdop::settings::CullSettings;
use sdop::simd::Tier;
use sdop::volume::Shape;
use sdop::world::{BodyId, World, WorldError};

/// How far a body moves, to have the world index all bodies before frames are timed.
const NUDGE: f64 = 1.0;

/// A world with the bodies of a scene, each in the slot of its number.
#[derive(Debug)]
pub(super) struct SceneWorld {
    /// The world.
    pub world: World,
    ids: Vec<BodyId>,
    /// The bodies as of the last frame, and those that have moved since.
    last: Bodies,
    moved: Vec<usize>,
    /// What was counted before the first frame.
    begun: Counters,
    /// Seconds of all that happens once.
    pub construct: f64,
}

impl SceneWorld {
    /// A world that has culled the bodies once and has indexed them.
    ///
    /// # Errors
    /// Invalid settings or bodies.
    pub fn new(
        shapes: &[Shape],
        bodies: &Bodies,
        settings: &CullSettings,
        tier: Tier,
    ) -> Result<Self, WorldError> {
        let mut waiting = WaitingTime::of_this_thread();
        let (waited, start) = (waiting.seconds(), Instant::now());
        // Strategies that a world is timed with have no use for bodies of interest.
        let settings = CullSettings { interest: None, ..settings.clone() };
        let builder = Culler::builder().settings(&settings).tier(tier);
        let mut world = World::with(shapes.to_vec(), &builder)?;
        let posed = (0..bodies.len()).map(|body| world_body(bodies, None, body));
        let ids = posed.map(|body| world.insert(body)).collect::<Result<Vec<_>, _>>()?;
        world.cull()?;
        let moving = (0..bodies.len()).find(|&body| bodies.dynamic[body]);
        if let Some(id) = moving.map(|body| ids[body]) {
            let body = world.body(id)?;
            let mut nudged = body;
            nudged.translation[0] += NUDGE;
            for body in [nudged, body] {
                world.set(id, body)?;
                world.cull()?;
            }
        }
        let seconds = start.elapsed().as_secs_f64();
        Ok(Self {
            construct: (seconds - (waiting.seconds() - waited)).max(0.0),
            begun: *world.counters(),
            world,
            ids,
            last: bodies.clone(),
            moved: Vec::new(),
        })
    }

    /// Finds the bodies that have moved since the last frame, which an engine knows.
    pub fn find_moved(&mut self, bodies: &Bodies) {
        self.moved.clear();
        for body in 0..bodies.len() {
            let (q, t) = (bodies.rotation[body], bodies.translation[body]);
            let before = (self.last.rotation[body], self.last.translation[body]);
            if q.map(f32::to_bits) != before.0.map(f32::to_bits)
                || t.map(f32::to_bits) != before.1.map(f32::to_bits)
            {
                self.moved.push(body);
                (self.last.rotation[body], self.last.translation[body]) = (q, t);
            }
        }
    }

    /// Sets the bodies found, and culls.
    ///
    /// # Errors
    /// A pose outside of the contract.
    pub fn cull(&mut self, bodies: &Bodies) -> Result<(), WorldError> {
        for &body in &self.moved {
            let t = bodies.translation[body].map(f64::from);
            self.world.set_pose(self.ids[body], bodies.rotation[body], t)?;
        }
        self.world.cull().map(|_| ())
    }

    /// The counters of all frames.
    pub fn counters(&self) -> Counters {
        self.world.counters().since(&self.begun)
    }

    /// The pairs of the last frame.
    pub fn pairs(&self) -> Vec<[u32; 2]> {
        let pairs = self.world.pairs();
        pairs.map(|pair| pair.map(|id| id.slot() as u32)).collect()
    }
}
