//! What worlds count of the bodies that they search for and of those that they keep.

use sdop::boxes::BoxBody;
use sdop::counters::RestCounters;
use sdop::world::{Body, BodyId, Motion, World};
use sdop::{Aabb, BoxWorld};

use super::shapes;

/// A world of bodies along a line.
trait CountingWorld {
    fn insert(&mut self, x: f32) -> BodyId;
    fn set(&mut self, id: BodyId, x: f32, motion: Motion);
    fn remove(&mut self, id: BodyId);
    fn cull(&mut self);
    fn counters(&self) -> RestCounters;
}

fn body(x: f32, motion: Motion) -> Body {
    Body { translation: [f64::from(x), 0.0, 0.0], motion, ..Body::default() }
}

fn box_body(x: f32, motion: Motion) -> BoxBody {
    BoxBody { motion, ..Aabb::new([x, 0.0, 0.0], [x + 1.5, 1.0, 1.0]).into() }
}

impl CountingWorld for World {
    fn insert(&mut self, x: f32) -> BodyId {
        self.insert(body(x, Motion::Dynamic)).unwrap()
    }

    fn set(&mut self, id: BodyId, x: f32, motion: Motion) {
        self.set(id, body(x, motion)).unwrap();
    }

    fn remove(&mut self, id: BodyId) {
        self.remove(id).unwrap();
    }

    fn cull(&mut self) {
        self.cull().unwrap();
    }

    fn counters(&self) -> RestCounters {
        self.counters().rest
    }
}

impl CountingWorld for BoxWorld {
    fn insert(&mut self, x: f32) -> BodyId {
        self.insert(box_body(x, Motion::Dynamic)).unwrap()
    }

    fn set(&mut self, id: BodyId, x: f32, motion: Motion) {
        self.set(id, box_body(x, motion)).unwrap();
    }

    fn remove(&mut self, id: BodyId) {
        self.remove(id).unwrap();
    }

    fn cull(&mut self) {
        self.cull().unwrap();
    }

    fn counters(&self) -> RestCounters {
        *self.rest_counters()
    }
}

/// A cull, and what it has counted: queried, thawed and kept bodies.
fn cull(world: &mut impl CountingWorld) -> [u64; 3] {
    let before = world.counters();
    world.cull();
    let counted = world.counters().since(&before);
    [counted.queried, counted.thawed, counted.kept]
}

fn assert_counts(world: &mut impl CountingWorld) {
    let ids: Vec<BodyId> = (0..100).map(|n| world.insert(n as f32)).collect();
    assert_eq!(cull(world), [0; 3], "the first cull finds all pairs");
    world.set(ids[7], 0.25, Motion::Dynamic);
    world.set(ids[8], 0.25, Motion::Dynamic);
    world.set(ids[8], 0.5, Motion::Dynamic);
    assert_eq!(cull(world), [2, 2, 98]);
    world.set(ids[7], 0.5, Motion::Dynamic);
    assert_eq!(cull(world), [1, 0, 99], "the same body again");
    world.set(ids[7], 0.5, Motion::Resting);
    assert_eq!(cull(world), [0, 0, 100], "rest changes no pair");
    world.set(ids[7], 0.75, Motion::Dynamic);
    assert_eq!(cull(world), [1, 1, 99], "after a frame without a change");
    world.set(ids[7], 0.25, Motion::Dynamic);
    world.remove(ids[8]);
    assert_eq!(cull(world), [2, 1, 98], "a removed body isn't kept");
    world.insert(8.0);
    assert_eq!(cull(world), [1, 0, 99], "its slot has a new body");
    for &id in &ids[20..40] {
        world.set(id, 0.25, Motion::Dynamic);
    }
    assert_eq!(cull(world), [0; 3], "many changes: all pairs are found");
    world.set(ids[20], 0.5, Motion::Dynamic);
    assert_eq!(cull(world), [1, 1, 99], "no body was queried before");
}

#[test]
fn worlds_count_queried_and_kept_bodies() {
    assert_counts(&mut World::new(shapes()).unwrap());
    assert_counts(&mut BoxWorld::new());
}
