//! What culls a scene: a culler, or a world where f32 doesn't hold some translation.

use std::time::Instant;

use super::SimulationError;
use crate::scene::Scene;
use sdop::bodies::Bodies;
use sdop::counters::{Counters, Seconds};
use sdop::culler::{CullError, Culler};
use sdop::pairs::PairList;
use sdop::settings::{CullSettings, Finder, Interest, SettingsError};
use sdop::simd::Tier;
use sdop::world::{Body, BodyId, World};

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
        let settings = CullSettings {
            interest: None,
            ..scene.cull.clone()
        };
        let builder = builder.settings(&settings);
        let mut world = World::with(scene.shapes.clone(), &builder)?;
        let translations = scene.fine.of(&scene.bodies);
        let bodies = (0..scene.bodies.len()).map(|body| Body {
            shape: scene.bodies.shape[body],
            dynamic: scene.bodies.dynamic[body],
            ..posed(&scene.bodies, translations.as_deref(), body)
        });
        let ids = bodies
            .map(|body| world.insert(body))
            .collect::<Result<Vec<_>, _>>()?;
        world.set_interest(&interest(&scene.cull, &ids)?)?;
        Ok(Self::World(Box::new(FineCuller {
            placing: (start.elapsed().as_secs_f64() - world.seconds().construct).max(0.0),
            world,
            ids,
            pairs: PairList::default(),
        })))
    }

    /// Culls a frame.
    pub fn cull(&mut self, scene: &Scene, bodies: &Bodies) -> Result<(), SimulationError> {
        match self {
            Self::Columns(culler) => culler.cull(bodies).map(|_| ())?,
            Self::World(fine) => fine.cull(bodies, scene.fine.of(bodies).as_deref())?,
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
    fn cull(
        &mut self,
        bodies: &Bodies,
        translations: Option<&[[f64; 3]]>,
    ) -> Result<(), SimulationError> {
        let (start, before) = (Instant::now(), self.world.seconds().total);
        for (body, &id) in self.ids.iter().enumerate() {
            // Static bodies stay where they were inserted.
            if bodies.dynamic[body] {
                let posed = posed(bodies, translations, body);
                self.world.set_pose(id, posed.rotation, posed.translation)?;
            }
        }
        let pairs = self.world.cull()?;
        self.pairs = pairs
            .iter()
            .map(|pair| pair.map(|id| id.slot() as u32))
            .collect();
        let culling = self.world.seconds().total - before;
        self.placing += (start.elapsed().as_secs_f64() - culling).max(0.0);
        Ok(())
    }
}

/// A body of the first shape at its pose, with its translation in f64.
fn posed(bodies: &Bodies, translations: Option<&[[f64; 3]]>, body: usize) -> Body {
    let rounded = || bodies.translation[body].map(f64::from);
    let translation = translations.map_or_else(rounded, |all| all[body]);
    Body::at(0, bodies.rotation[body], translation)
}

/// The bodies of interest in a world.
fn interest(settings: &CullSettings, ids: &[BodyId]) -> Result<Vec<BodyId>, CullError> {
    match &settings.interest {
        None => Ok(Vec::new()),
        Some(Interest::Bodies(list)) => Ok(list.iter().map(|&body| ids[body as usize]).collect()),
        Some(Interest::Cone(_)) => Err(SettingsError::Interest {
            problem: "a view cone, and translations that f32 doesn't hold".to_owned(),
            hint: "list the bodies of interest, or round the translations to f32",
        }
        .into()),
    }
}
