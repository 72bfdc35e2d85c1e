//! Culls a scene: by a culler, or by a world if f32 doesn't hold some translation.

use std::time::Instant;

use super::SimulationError;
use crate::scene::Scene;
use sdop::bodies::Bodies;
use sdop::counters::{Counters, Seconds};
use sdop::culler::{Culler, PlacedCone};
use sdop::pairs::PairList;
use sdop::rounding::pose::{rotate_of, rotation};
use sdop::settings::{CullSettings, Finder, Interest, ViewCone};
use sdop::simd::Tier;
use sdop::volume::Shape;
use sdop::world::{Body, BodyId, Motion, World};

/// Culls a scene's bodies, frame by frame.
pub(super) enum SceneCuller {
    /// All translations are f32.
    Columns(Box<Culler>),
    /// Some may not be.
    World(Box<FineCuller>),
}

/// Bodies in a world, each in the slot of its number.
pub(super) struct FineCuller {
    world: World,
    ids: Vec<BodyId>,
    /// From each body's origin to its sphere's centre, in the body frame; empty without a cone.
    centres: Vec<[f64; 3]>,
    pairs: PairList,
    /// Seconds that passed outside of the culler, for poses and origins.
    placing: f64,
}

impl SceneCuller {
    pub fn new(scene: &Scene, tier: Tier, threads: usize) -> Result<Self, SimulationError> {
        let builder = Culler::builder().tier(tier).threads(threads);
        if scene.fine.is_empty() {
            let builder = builder.settings(&scene.cull);
            let culler = builder.build(&scene.shapes, &scene.bodies)?;
            return Ok(Self::Columns(Box::new(culler)));
        }
        let start = Instant::now();
        let settings = CullSettings { interest: None, ..scene.cull.clone() };
        let builder = builder.settings(&settings);
        let mut world = World::with(scene.shapes.clone(), &builder)?;
        let translations = scene.fine.of(&scene.bodies);
        let body = |body| world_body(&scene.bodies, translations.as_deref(), body);
        let bodies = (0..scene.bodies.len()).map(body);
        let ids = bodies.map(|body| world.insert(body)).collect::<Result<Vec<_>, _>>()?;
        let mut centres = Vec::new();
        match &scene.cull.interest {
            None => (),
            Some(Interest::Bodies(list)) => {
                let listed: Vec<_> = list.iter().map(|&body| ids[body as usize]).collect();
                world.set_interest(&listed)?;
            }
            Some(Interest::Cone(_)) => {
                let shape = |&shape: &u32| centre(&scene.shapes[shape as usize]);
                centres = scene.bodies.shape.iter().map(shape).collect();
            }
        }
        Ok(Self::World(Box::new(FineCuller {
            placing: (start.elapsed().as_secs_f64() - world.seconds().construct).max(0.0),
            world,
            ids,
            centres,
            pairs: PairList::default(),
        })))
    }

    /// Culls a frame.
    pub fn cull(&mut self, scene: &Scene, bodies: &Bodies) -> Result<(), SimulationError> {
        match self {
            Self::Columns(culler) => culler.cull(bodies).map(|_| ())?,
            Self::World(fine) => fine.cull(scene, bodies)?,
        }
        Ok(())
    }

    /// The pairs of the last frame.
    pub fn pairs(&self) -> &PairList {
        match self {
            Self::Columns(culler) => culler.pairs(),
            Self::World(fine) => &fine.pairs,
        }
    }

    /// The finder at work.
    pub fn finder(&self) -> Finder {
        match self {
            Self::Columns(culler) => culler.finder(),
            Self::World(fine) => fine.world.finder(),
        }
    }

    /// Counters summed over the frames so far.
    pub fn counters(&self) -> &Counters {
        match self {
            Self::Columns(culler) => culler.counters(),
            Self::World(fine) => fine.world.counters(),
        }
    }

    /// Seconds summed over the frames so far. To place bodies about their origins is a part of
    /// updating them.
    pub fn seconds(&self) -> Seconds {
        match self {
            Self::Columns(culler) => *culler.seconds(),
            Self::World(fine) => {
                let seconds = *fine.world.seconds();
                Seconds {
                    update: seconds.update + fine.placing,
                    total: seconds.total + fine.placing,
                    ..seconds
                }
            }
        }
    }
}

impl FineCuller {
    fn cull(&mut self, scene: &Scene, bodies: &Bodies) -> Result<(), SimulationError> {
        let (start, before) = (Instant::now(), self.world.seconds().total);
        let translations = scene.fine.of(bodies);
        let translations = translations.as_deref();
        for (body, &id) in self.ids.iter().enumerate() {
            // Static bodies stay where they were inserted.
            if bodies.dynamic[body] {
                let posed = world_body(bodies, translations, body);
                self.world.set_pose(id, posed.rotation, posed.translation)?;
            }
        }
        if let Some(Interest::Cone(cone)) = &scene.cull.interest {
            self.look(cone, bodies, translations)?;
        }
        let pairs = self.world.cull()?;
        self.pairs = pairs.iter().map(|pair| pair.map(|id| id.slot() as u32)).collect();
        let culling = self.world.seconds().total - before;
        self.placing += (start.elapsed().as_secs_f64() - culling).max(0.0);
        Ok(())
    }

    /// Of interest are the bodies whose spheres' centres lie in the cone, both in f64.
    fn look(
        &mut self,
        cone: &ViewCone,
        bodies: &Bodies,
        translations: Option<&[[f64; 3]]>,
    ) -> Result<(), SimulationError> {
        let pose = |body: usize| {
            let Body { rotation, translation, .. } = world_body(bodies, translations, body);
            (rotation, translation)
        };
        let cone = PlacedCone::new(cone, cone.body.map(|body| pose(body as usize)));
        let is_seen = |body: usize| {
            let (q, t) = pose(body);
            let centre = rotate_of(&rotation(q), self.centres[body]);
            cone.sees([0, 1, 2].map(|axis| centre[axis] + t[axis]))
        };
        let ids = self.ids.iter().enumerate();
        let seen: Vec<_> = ids.filter(|&(body, _)| is_seen(body)).map(|(_, &id)| id).collect();
        Ok(self.world.set_interest(&seen)?)
    }
}

/// A sphere's centre as seen from the origin that poses place.
fn centre(shape: &Shape) -> [f64; 3] {
    let (offset, centre) = (shape.pose_offset, shape.ball.centre);
    [0, 1, 2].map(|axis| offset[axis] + f64::from(centre[axis]))
}

/// One of these bodies for a world, at its f64 translation if there are such.
pub(crate) fn world_body(bodies: &Bodies, translations: Option<&[[f64; 3]]>, body: usize) -> Body {
    let rounded = || bodies.translation[body].map(f64::from);
    let translation = translations.map_or_else(rounded, |all| all[body]);
    Body {
        motion: match bodies.dynamic[body] {
            true => Motion::Dynamic,
            false => Motion::Fixed,
        },
        ..Body::at(bodies.shape[body], bodies.rotation[body], translation)
    }
}
