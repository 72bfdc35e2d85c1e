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

use crate::boxes::{Frame, Slabs, lower, upper};
use crate::changes::Changes;
use crate::entry::{Entry, Setup, Work};
use crate::incremental::{Change, Extras, Found, HUNDRED_THOUSAND, Incremental, MoverEntry, Moves};
use crate::threads::Threads;

pub const VERSION: &str = "0.36.1";

/// One way to drive it.
pub const ENTRIES: [Entry; 1] = [Entry {
    name: "rapier3d",
    version: VERSION,
    work: Work::Boxes,
    threads: usize::MAX,
    ages: true,
    new: |setup| Ok(Box::new(Rapier::new(setup, NO_SKIN)?)),
}];

/// A length unit for which the skin rounds away, and rapier's own.
pub const NO_SKIN: f32 = 1e-30;
const DEFAULT_UNIT: f32 = 1.0;
/// The skin of a leaf for a unit of 1.
const SKIN: f32 = 0.04;

const WITHOUT_SKIN: MoverEntry = MoverEntry {
    name: "rapier3d",
    version: VERSION,
    margin: 0.0,
    extras: Extras::None,
    work: Work::Boxes,
    only: None,
    most_bodies: usize::MAX,
    new: |setup| Ok(Box::new(Rapier::new(setup, NO_SKIN)?)),
};

/// Given what has changed, without a skin and with rapier's.
pub const MOVERS: [MoverEntry; 2] = [
    WITHOUT_SKIN,
    MoverEntry {
        name: "rapier3d, margin 0.04",
        margin: SKIN,
        extras: Extras::Within(4.0 * SKIN),
        most_bodies: HUNDRED_THOUSAND,
        new: |setup| Ok(Box::new(Rapier::new(setup, DEFAULT_UNIT)?)),
        ..WITHOUT_SKIN
    },
];

struct Rapier {
    broad_phase: BroadPhaseBvh,
    parameters: IntegrationParameters,
    colliders: ColliderSet,
    bodies: RigidBodySet,
    handles: Vec<ColliderHandle>,
    events: Vec<BroadPhasePairEvent>,
    threads: Threads,
    /// Those of the last frame, read.
    read: Vec<Change>,
    changes: Changes,
}

impl Rapier {
    fn new(setup: &Setup<'_>, length_unit: f32) -> miette::Result<Self> {
        let mut colliders = ColliderSet::new();
        let collider = |_: &u32| {
            let ball = ColliderBuilder::ball(1.0);
            colliders.insert(ball.active_collision_types(ActiveCollisionTypes::all()))
        };
        let handles = setup.first.bodies.shape.iter().map(collider).collect();
        let mut rapier = Self {
            broad_phase: BroadPhaseBvh::new(),
            parameters: IntegrationParameters { length_unit, ..IntegrationParameters::default() },
            colliders,
            bodies: RigidBodySet::new(),
            handles,
            events: Vec::new(),
            threads: Threads::new(setup.threads)?,
            read: Vec::new(),
            changes: Changes::default(),
        };
        Contestant::frame(&mut rapier, setup.first);
        rapier.settle();
        rapier.read_events();
        Ok(rapier)
    }

    fn set(&mut self, body: usize, slabs: &Slabs) {
        let corners = [lower(slabs), upper(slabs)].map(Vector::from_array);
        let aabb = Aabb::new(corners[0], corners[1]);
        let handle = self.handles[body];
        self.broad_phase.set_aabb(&self.parameters, handle, aabb);
    }

    fn update(&mut self) {
        let Self { broad_phase, parameters, colliders, bodies, events, .. } = self;
        events.clear();
        self.threads.run(|| broad_phase.update(parameters, colliders, bodies, &[], &[], events));
    }

    fn read_events(&mut self) {
        self.read.clear();
        self.read.extend(self.events.iter().map(change));
    }
}

fn change(event: &BroadPhasePairEvent) -> Change {
    let (pair, begins) = match event {
        BroadPhasePairEvent::AddPair(pair) => (pair, true),
        BroadPhasePairEvent::DeletePair(pair) => (pair, false),
    };
    let number = |handle: ColliderHandle| handle.into_raw_parts().0;
    ([pair.collider1, pair.collider2].map(number), begins)
}

impl Contestant<Frame> for Rapier {
    fn frame(&mut self, frame: &Frame) {
        for (body, slabs) in frame.boxes.iter().enumerate() {
            self.set(body, slabs);
        }
        self.update();
    }

    fn settle(&mut self) {
        for event in &self.events {
            let (pair, begins) = change(event);
            self.changes.note(pair, begins);
        }
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.changes.pairs()
    }
}

impl Incremental for Rapier {
    fn frame(&mut self, moves: &Moves) {
        for (body, slabs) in moves.iter() {
            self.set(body as usize, slabs);
        }
        self.update();
        self.read_events();
    }

    fn found(&self) -> Found<'_> {
        Found::Changes(&self.read)
    }
}
