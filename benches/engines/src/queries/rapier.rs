//! rapier3d's queries on its broad phase, whose leaves are the boxes. Its tests of single colliders
//! are those of cuboids at poses, so ends are rounded.

use rapier3d::dynamics::{IntegrationParameters, RigidBodySet};
use rapier3d::geometry::{Aabb, BroadPhaseBvh, ColliderBuilder, ColliderHandle, ColliderSet};
use rapier3d::math::{Pose, Vector};
use rapier3d::parry::query::{DefaultQueryDispatcher, Ray};
use rapier3d::parry::shape::Ball;
use rapier3d::pipeline::{QueryFilter, QueryPipeline};

use super::asked::{Asked, each, ray};
use super::questions::{Question, Questions, RADIUS};
use crate::boxes::Slabs;
use crate::parry::aabb;
use crate::rapier::NO_SKIN;
use crate::threads::Threads;

/// Colliders without bodies.
pub struct Rapier {
    broad_phase: BroadPhaseBvh,
    bodies: RigidBodySet,
    colliders: ColliderSet,
    probes: Vec<Aabb>,
    centres: Vec<Pose>,
    rays: Vec<Ray>,
    threads: Threads,
    found: Vec<Vec<u32>>,
}

impl Rapier {
    pub fn new(questions: &Questions, threads: usize) -> miette::Result<Self> {
        let parameters =
            IntegrationParameters { length_unit: NO_SKIN, ..IntegrationParameters::default() };
        let (mut broad_phase, mut colliders) = (BroadPhaseBvh::new(), ColliderSet::new());
        for slabs in &questions.boxes {
            let handle = colliders.insert(cuboid(slabs));
            broad_phase.set_aabb(&parameters, handle, aabb(slabs));
        }
        let bodies = RigidBodySet::new();
        let threads = Threads::new(threads)?;
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
        self.broad_phase.as_query_pipeline(
            &DefaultQueryDispatcher,
            &self.bodies,
            &self.colliders,
            QueryFilter::default(),
        )
    }
}

impl Asked for Rapier {
    fn ask(&mut self, question: Question) {
        let (threads, ball) = (&self.threads, Ball::new(RADIUS));
        self.found = match question {
            Question::Box => each(threads, &self.probes, |&probe| {
                let pipeline = self.pipeline();
                let met = pipeline.intersect_aabb_conservative(probe);
                met.map(|(handle, _)| number(handle)).collect()
            }),
            Question::Ball => each(threads, &self.centres, |&centre| {
                let pipeline = self.pipeline();
                let met = pipeline.intersect_shape(centre, &ball);
                met.map(|(handle, _)| number(handle)).collect()
            }),
            Question::Along => each(threads, &self.rays, |&ray| {
                let pipeline = self.pipeline();
                let met = pipeline.intersect_ray(ray, 1.0, true);
                met.map(|(handle, ..)| number(handle)).collect()
            }),
            Question::First => each(threads, &self.rays, |ray| {
                let first = self.pipeline().cast_ray(ray, 1.0, true);
                first.into_iter().map(|(handle, _)| number(handle)).collect()
            }),
            Question::Sets => Vec::new(),
        };
    }

    fn answers(&self) -> Vec<Vec<u32>> {
        let mut answers = self.found.clone();
        answers.iter_mut().for_each(|bodies| bodies.sort_unstable());
        answers
    }
}

fn cuboid(slabs: &Slabs) -> ColliderBuilder {
    let [x, y, z] = slabs.map(|[lo, hi]| 0.5 * (hi - lo));
    let middle = slabs.map(|[lo, hi]| 0.5 * (lo + hi));
    ColliderBuilder::cuboid(x, y, z).translation(Vector::from_array(middle))
}

fn number(handle: ColliderHandle) -> u32 {
    handle.into_raw_parts().0
}
