//! rapier3d's `BroadPhaseBvh`, driven alone: a tree of boxes, a map of pairs, and events for what
//! changed in it.
//!
//! The length unit is next to nothing, so that the skin rounds away and leaves are the boxes to the
//! bit. Boxes go in by `set_aabb`: outside of its physics pipeline nothing resets a collider's list
//! of changes, and `update` would then take every moved collider out of the tree and put it back.

use rapier3d::dynamics::{IntegrationParameters, RigidBodySet};
use rapier3d::geometry::{
    Aabb, ActiveCollisionTypes, BroadPhaseBvh, BroadPhasePairEvent, ColliderBuilder,
    ColliderHandle, ColliderSet,
};
use rapier3d::math::Vector;

use sdop_judge::contestant::Contestant;

use crate::boxes::{Frame, lower, upper};
use crate::changes::Changes;
use crate::entry::{Entry, Setup, Work};
use crate::threads::Threads;

/// One way to drive it.
pub const ENTRIES: [Entry; 1] = [Entry {
    name: "rapier3d",
    version: "0.36.1",
    work: Work::Boxes,
    threads: usize::MAX,
    ages: true,
    new: |setup| Ok(Box::new(Rapier::new(setup)?)),
}];

struct Rapier {
    broad_phase: BroadPhaseBvh,
    parameters: IntegrationParameters,
    colliders: ColliderSet,
    bodies: RigidBodySet,
    handles: Vec<ColliderHandle>,
    events: Vec<BroadPhasePairEvent>,
    threads: Threads,
    changes: Changes,
}

impl Rapier {
    fn new(setup: &Setup<'_>) -> miette::Result<Self> {
        let mut colliders = ColliderSet::new();
        let collider = |_: &u32| {
            let ball = ColliderBuilder::ball(1.0);
            colliders.insert(ball.active_collision_types(ActiveCollisionTypes::all()))
        };
        let handles = setup.first.bodies.shape.iter().map(collider).collect();
        let mut rapier = Self {
            broad_phase: BroadPhaseBvh::new(),
            parameters: IntegrationParameters {
                length_unit: 1e-30,
                ..IntegrationParameters::default()
            },
            colliders,
            bodies: RigidBodySet::new(),
            handles,
            events: Vec::new(),
            threads: Threads::new(setup.threads)?,
            changes: Changes::default(),
        };
        rapier.frame(setup.first);
        rapier.settle();
        Ok(rapier)
    }
}

impl Contestant<Frame> for Rapier {
    fn frame(&mut self, frame: &Frame) {
        let Self {
            broad_phase,
            parameters,
            colliders,
            bodies,
            handles,
            events,
            ..
        } = self;
        for (&handle, slabs) in handles.iter().zip(&frame.boxes) {
            let corners = [lower(slabs), upper(slabs)].map(Vector::from_array);
            broad_phase.set_aabb(parameters, handle, Aabb::new(corners[0], corners[1]));
        }
        events.clear();
        self.threads
            .run(|| broad_phase.update(parameters, colliders, bodies, &[], &[], events));
    }

    fn settle(&mut self) {
        for event in &self.events {
            let (pair, begins) = match event {
                BroadPhasePairEvent::AddPair(pair) => (pair, true),
                BroadPhasePairEvent::DeletePair(pair) => (pair, false),
            };
            let bodies = [pair.collider1, pair.collider2].map(|handle| handle.into_raw_parts().0);
            self.changes.note(bodies, begins);
        }
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.changes.pairs()
    }
}
