//! Our long-lived worlds, given what has changed, and a culler that gets all boxes in each frame.

use std::hint::black_box;

use sdop::boxes::{BoxBody, BoxCuller, BoxWorld};
use sdop::world::{Body, BodyId, Events, World};
use sdop::{Aabb, Motion};

use sdop_bench::remedy::OrReport as _;

use super::VERSION;
use crate::entry::{Setup, Work};
use crate::incremental::{Change, Extras, Found, Incremental, MoverEntry, Moves, Only};

const EXACT: MoverEntry = MoverEntry {
    name: "sdop BoxWorld",
    version: VERSION,
    margin: 0.0,
    extras: Extras::None,
    work: Work::Boxes,
    only: None,
    most_bodies: usize::MAX,
    new: |setup| Ok(Box::new(Boxes::new(setup, Use::Events)?)),
};

/// A world of boxes; with all pairs read; with bodies that are replaced; all boxes in each frame; a
/// world of meshes. The first of a case is what others are compared with.
pub const ENTRIES: [MoverEntry; 5] = [
    EXACT,
    MoverEntry {
        name: "sdop BoxWorld, insertion and removal",
        only: Some(Only::Replacement),
        new: |setup| Ok(Box::new(Boxes::new(setup, Use::Replacement)?)),
        ..EXACT
    },
    MoverEntry {
        name: "sdop BoxWorld, all pairs read",
        only: Some(Only::ReadPairs),
        new: |setup| Ok(Box::new(Boxes::new(setup, Use::AllPairs)?)),
        ..EXACT
    },
    MoverEntry {
        name: "sdop BoxCuller, all boxes",
        new: |setup| Ok(Box::new(AllBoxes::new(setup)?)),
        ..EXACT
    },
    MoverEntry {
        name: "sdop World, s-dop",
        work: Work::SDop,
        only: Some(Only::Meshes),
        new: |setup| Ok(Box::new(Meshes::new(setup)?)),
        ..EXACT
    },
];

/// What a frame is used for.
#[derive(Clone, Copy, PartialEq)]
enum Use {
    Events,
    AllPairs,
    Replacement,
}

/// Reads what has begun and ended.
fn read(events: &Events, body_of: &[u32], changes: &mut Vec<Change>) {
    let numbers = |pair: [BodyId; 2]| pair.map(|id| body_of[id.slot()]);
    changes.clear();
    changes.extend(events.ended().map(|pair| (numbers(pair), false)));
    changes.extend(events.begun().map(|pair| (numbers(pair), true)));
}

struct Boxes {
    world: BoxWorld,
    ids: Vec<BodyId>,
    /// The ids of a frame's bodies.
    moved: Vec<BodyId>,
    body_of: Vec<u32>,
    changes: Vec<Change>,
    purpose: Use,
}

impl Boxes {
    fn new(setup: &Setup<'_>, purpose: Use) -> miette::Result<Self> {
        let mut world = BoxWorld::with(&BoxCuller::builder().threads(setup.threads)).or_report()?;
        let ids = setup.first.corners.iter();
        let ids = ids.map(|&corners| world.insert(corners).or_report());
        let ids = ids.collect::<miette::Result<Vec<_>>>()?;
        let mut boxes = Self {
            world,
            body_of: (0..ids.len() as u32).collect(),
            ids,
            moved: Vec::new(),
            changes: Vec::new(),
            purpose,
        };
        boxes.cull();
        Ok(boxes)
    }

    fn cull(&mut self) {
        let pairs = self.world.cull();
        assert!(pairs.is_ok(), "{pairs:?}: the world has boxes");
        read(&self.world.events(), &self.body_of, &mut self.changes);
        if self.purpose == Use::AllPairs {
            for pair in self.world.pairs() {
                black_box(pair);
            }
        }
    }

    /// Removes a body and inserts another one, which gets its number.
    fn replace(&mut self, body: u32, bounds: Aabb) {
        let removed = self.world.remove(self.ids[body as usize]);
        assert!(removed.is_ok(), "{removed:?}: the body is there");
        let id = match self.world.insert(BoxBody::from(bounds)) {
            Ok(id) => id,
            Err(error) => unreachable!("{error}: frames have boxes"),
        };
        self.ids[body as usize] = id;
        if self.body_of.len() <= id.slot() {
            self.body_of.resize(id.slot() + 1, body);
        }
        self.body_of[id.slot()] = body;
    }
}

impl Incremental for Boxes {
    fn frame(&mut self, moves: &Moves) {
        if self.purpose == Use::Replacement {
            for (&body, &bounds) in moves.bodies.iter().zip(&moves.corners) {
                self.replace(body, bounds);
            }
        } else {
            self.moved.clear();
            let ids = moves.bodies.iter().map(|&body| self.ids[body as usize]);
            self.moved.extend(ids);
            let set = self.world.set_many(&self.moved, &moves.corners);
            assert!(set.is_ok(), "{set:?}: the bodies are there");
        }
        self.cull();
    }

    fn found(&self) -> Found<'_> {
        Found::Changes(&self.changes)
    }
}

/// A culler of given boxes, which compares nothing with the last frame.
struct AllBoxes {
    culler: BoxCuller,
    boxes: Vec<Aabb>,
}

impl AllBoxes {
    fn new(setup: &Setup<'_>) -> miette::Result<Self> {
        let mut culler = BoxCuller::builder().threads(setup.threads).build();
        if let Ok(culler) = &mut culler {
            culler.cull(&setup.first.corners).or_report()?;
        }
        Ok(Self { culler: culler.or_report()?, boxes: setup.first.corners.clone() })
    }
}

impl Incremental for AllBoxes {
    fn frame(&mut self, moves: &Moves) {
        for (&body, &bounds) in moves.bodies.iter().zip(&moves.corners) {
            self.boxes[body as usize] = bounds;
        }
        let pairs = self.culler.cull(&self.boxes);
        assert!(pairs.is_ok(), "{pairs:?}: frames have boxes");
    }

    fn found(&self) -> Found<'_> {
        Found::Pairs(self.culler.pairs().iter().collect())
    }
}

/// A world of resting meshes with what it has by default: full S-DOP.
struct Meshes {
    world: World,
    ids: Vec<BodyId>,
    rotations: Vec<[f32; 4]>,
    body_of: Vec<u32>,
    changes: Vec<Change>,
}

impl Meshes {
    fn new(setup: &Setup<'_>) -> miette::Result<Self> {
        let mut world = World::new(setup.scene.shapes.clone()).or_report()?;
        let bodies = &setup.first.bodies;
        let insert = |at: usize| {
            let translation = bodies.translation[at].map(f64::from);
            let body = Body::at(bodies.shape[at], bodies.rotation[at], translation);
            let motion = Motion::Resting;
            world.insert(Body { motion, ..body }).or_report()
        };
        let ids = (0..bodies.len()).map(insert);
        let ids = ids.collect::<miette::Result<Vec<_>>>()?;
        let mut meshes = Self {
            world,
            body_of: (0..ids.len() as u32).collect(),
            ids,
            rotations: bodies.rotation.clone(),
            changes: Vec::new(),
        };
        meshes.cull();
        Ok(meshes)
    }

    fn cull(&mut self) {
        let pairs = self.world.cull();
        assert!(pairs.is_ok(), "{pairs:?}: bodies are within the contract");
        read(&self.world.events(), &self.body_of, &mut self.changes);
    }
}

impl Incremental for Meshes {
    fn frame(&mut self, moves: &Moves) {
        for (&body, centre) in moves.bodies.iter().zip(&moves.centres) {
            let (id, rotation) = (self.ids[body as usize], self.rotations[body as usize]);
            let set = self.world.set_pose(id, rotation, centre.map(f64::from));
            assert!(set.is_ok(), "{set:?}: the body is there");
        }
        self.cull();
    }

    fn found(&self) -> Found<'_> {
        Found::Changes(&self.changes)
    }
}
