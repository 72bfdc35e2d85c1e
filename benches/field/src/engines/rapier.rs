//! rapier3d's `BroadPhaseBvh`, driven alone: a tree of boxes, a map of pairs, and events for what
//! changed in it; and its queries on that tree.
//!
//! Without a margin the length unit is next to nothing, so that the skin rounds away and leaves are
//! the boxes to the bit. Boxes go in by `set_aabb`: outside of its physics pipeline nothing resets
//! a collider's list of changes, and `update` would then take every moved collider out of the tree
//! and put it back.

use rapier3d::dynamics::{IntegrationParameters, RigidBodySet};
use rapier3d::geometry::{
    Aabb, ActiveCollisionTypes, BroadPhaseBvh, BroadPhasePairEvent, ColliderBuilder,
    ColliderHandle, ColliderSet,
};
use rapier3d::math::{Pose, Vector};
use rapier3d::parry::query::{DefaultQueryDispatcher, Ray};
use rapier3d::parry::shape::Ball;
use rapier3d::pipeline::{QueryFilter, QueryPipeline};
use sdop_judge::contestant::Contestant;

use super::events::{Change, Events};
use super::parry::{aabb, ray};
use crate::entry::{New, Setup};
use crate::frame::{Frame, Slabs};
use crate::questions::{Question, Questions, RADIUS, flat};
use crate::threads::Threads;

/// Without a skin and with rapier's of 0.04.
pub const ENGINES: [(&str, New); 2] = [
    ("rapier3d", |setup| match setup.first.question {
        None => Ok(Box::new(Rapier::new(setup, NO_SKIN)?)),
        Some(_) => Ok(Box::new(Asked::new(setup)?)),
    }),
    ("rapier3d, margin 0.04", |setup| Ok(Box::new(Rapier::new(setup, DEFAULT_UNIT)?))),
];

/// A length unit for which the skin rounds away, and rapier's own.
const NO_SKIN: f32 = 1e-30;
const DEFAULT_UNIT: f32 = 1.0;

fn parameters(length_unit: f32) -> IntegrationParameters {
    IntegrationParameters { length_unit, ..IntegrationParameters::default() }
}

struct Rapier {
    broad_phase: BroadPhaseBvh,
    parameters: IntegrationParameters,
    colliders: ColliderSet,
    bodies: RigidBodySet,
    handles: Vec<ColliderHandle>,
    threads: Threads,
    reported: Vec<BroadPhasePairEvent>,
    events: Events,
}

impl Rapier {
    fn new(setup: &Setup<'_>, length_unit: f32) -> miette::Result<Self> {
        let mut colliders = ColliderSet::new();
        let collider = |_: &u32| {
            let ball = ColliderBuilder::ball(1.0);
            colliders.insert(ball.active_collision_types(ActiveCollisionTypes::all()))
        };
        let mut rapier = Self {
            broad_phase: BroadPhaseBvh::new(),
            parameters: parameters(length_unit),
            handles: setup.first.bodies.shape.iter().map(collider).collect(),
            colliders,
            bodies: RigidBodySet::new(),
            threads: Threads::new(setup.threads)?,
            reported: Vec::new(),
            events: Events::default(),
        };
        rapier.frame(setup.first);
        Ok(rapier)
    }
}

fn change(event: &BroadPhasePairEvent) -> Change {
    let (pair, begins) = match event {
        BroadPhasePairEvent::AddPair(pair) => (pair, true),
        BroadPhasePairEvent::DeletePair(pair) => (pair, false),
    };
    ([pair.collider1, pair.collider2].map(number), begins)
}

fn number(handle: ColliderHandle) -> u32 {
    handle.into_raw_parts().0
}

impl Contestant<Frame> for Rapier {
    fn frame(&mut self, frame: &Frame) {
        let Self { broad_phase, parameters, colliders, bodies, reported, .. } = self;
        for (body, slabs) in frame.changes() {
            broad_phase.set_aabb(parameters, self.handles[body as usize], aabb(slabs));
        }
        reported.clear();
        self.threads.run(|| broad_phase.update(parameters, colliders, bodies, &[], &[], reported));
        self.events.last.clear();
        self.events.last.extend(reported.iter().map(change));
    }

    fn settle(&mut self) {
        self.events.settle();
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.events.pairs()
    }
}

/// Colliders without bodies, to be asked. Tests of single colliders are those of cuboids at poses,
/// so ends are rounded.
struct Asked {
    broad_phase: BroadPhaseBvh,
    bodies: RigidBodySet,
    colliders: ColliderSet,
    probes: Vec<Aabb>,
    centres: Vec<Pose>,
    rays: Vec<Ray>,
    threads: Threads,
    found: Vec<Vec<u32>>,
}

impl Asked {
    fn new(setup: &Setup<'_>) -> miette::Result<Self> {
        let questions = Questions::of(setup)?;
        let (parameters, bodies) = (parameters(NO_SKIN), RigidBodySet::new());
        let (mut broad_phase, mut colliders) = (BroadPhaseBvh::new(), ColliderSet::new());
        for slabs in &questions.boxes {
            let handle = colliders.insert(cuboid(slabs));
            broad_phase.set_aabb(&parameters, handle, aabb(slabs));
        }
        let threads = Threads::new(setup.threads)?;
        let mut events = Vec::new();
        threads.run(|| {
            broad_phase.update(&parameters, &colliders, &bodies, &[], &[], &mut events);
        });
        let place = |&centre: &[f32; 3]| Pose::from_translation(Vector::from_array(centre));
        Ok(Self {
            broad_phase,
            bodies,
            colliders,
            probes: questions.probes.iter().map(aabb).collect(),
            centres: questions.centres.iter().map(place).collect(),
            rays: questions.segments.iter().map(ray).collect(),
            threads,
            found: Vec::new(),
        })
    }

    fn pipeline(&self) -> QueryPipeline<'_> {
        let (dispatcher, filter) = (&DefaultQueryDispatcher, QueryFilter::default());
        self.broad_phase.as_query_pipeline(dispatcher, &self.bodies, &self.colliders, filter)
    }

    fn answer(&self, question: Question) -> Vec<Vec<u32>> {
        let (threads, ball) = (&self.threads, Ball::new(RADIUS));
        match question {
            Question::Box => threads.each(&self.probes, |&probe| {
                let pipeline = self.pipeline();
                let met = pipeline.intersect_aabb_conservative(probe);
                met.map(|(handle, _)| number(handle)).collect()
            }),
            Question::Ball => threads.each(&self.centres, |&centre| {
                let pipeline = self.pipeline();
                let met = pipeline.intersect_shape(centre, &ball);
                met.map(|(handle, _)| number(handle)).collect()
            }),
            Question::Along => threads.each(&self.rays, |&ray| {
                let pipeline = self.pipeline();
                let met = pipeline.intersect_ray(ray, 1.0, true);
                met.map(|(handle, ..)| number(handle)).collect()
            }),
            Question::First => threads.each(&self.rays, |ray| {
                let first = self.pipeline().cast_ray(ray, 1.0, true);
                first.into_iter().map(|(handle, _)| number(handle)).collect()
            }),
            Question::Sets => Vec::new(), // it has no such query, and isn't asked
        }
    }
}

impl Contestant<Frame> for Asked {
    fn frame(&mut self, frame: &Frame) {
        if let Some((question, _)) = frame.question {
            self.found = self.answer(question);
        }
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        flat(&self.found).collect()
    }
}

fn cuboid(slabs: &Slabs) -> ColliderBuilder {
    let [x, y, z] = slabs.map(|[lo, hi]| 0.5 * (hi - lo));
    let middle = slabs.map(|[lo, hi]| 0.5 * (lo + hi));
    ColliderBuilder::cuboid(x, y, z).translation(Vector::from_array(middle))
}
