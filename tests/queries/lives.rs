//! An index that has followed a world answers like a newly built one.

use sdop::query::QuerySource;
use sdop::{Aabb, Body, BoxWorld, Line, QueryIndex, QueryVolume, World};

use crate::histories::{HistoryKind, live};
use crate::queries::{UNTURNED, cube};
use sdop_judge::draw::random::Random;

fn assert_same(index: &QueryIndex, world: &impl QuerySource, random: &mut Random) {
    let mut fresh = QueryIndex::new();
    fresh.update(world);
    assert_eq!(index.len(), fresh.len());
    for _ in 0..6 {
        let centre = [(); 3].map(|()| f64::from(random.within(8.0)));
        let ball = QueryVolume::Ball { centre, radius: 2.0 };
        assert_eq!(index.touching(&ball).unwrap(), fresh.touching(&ball).unwrap());
        let direction = [(); 3].map(|()| f64::from(random.within(1.0)));
        let line = Line::Ray { origin: centre, direction };
        let [found, wanted] = [index, &fresh].map(|index| index.along(&line).unwrap());
        assert_eq!(found, wanted);
        let [found, wanted] = [index, &fresh].map(|index| index.first(&line).unwrap());
        assert_eq!(found, wanted);
    }
    assert_eq!(index.pairs_with(&fresh).unwrap(), fresh.pairs_with(&fresh).unwrap());
}

/// The bodies that an index finds in each body's own volume.
#[test]
fn histories_that_are_asked() {
    live(HistoryKind::Queries, 2..6);
}

/// The shape of a number may be replaced while all bodies stay.
#[test]
fn replaced_shape_is_seen() {
    let mut world = World::new(vec![cube()]).unwrap();
    let body = world.insert(Body::default()).unwrap();
    let mut index = QueryIndex::new();
    index.update(&world);
    let point = QueryVolume::Ball { centre: [0.0, 1.25, 0.0], radius: 0.0 };
    assert_eq!(index.touching(&point).unwrap(), []);
    let [x, y, z] = [2.0, 3.0, 2.0];
    let longer = sdop::ProceduralShape::Box { x, y, z }.build().unwrap();
    let longer = sdop::Shape::build(&longer, &sdop::ShapeSpec::default()).unwrap();
    world.replace_shape(0, &longer).unwrap();
    index.update(&world);
    assert_eq!(index.touching(&point).unwrap(), [body]);
}

/// Worlds of both kinds, one after the other, with the same slots.
#[test]
fn another_world_is_another_set() {
    let random = &mut Random::new(3);
    let mut index = QueryIndex::new();
    let mut bodies = World::new(vec![cube()]).unwrap();
    bodies.insert(Body::at(0, UNTURNED, [3.0, 0.0, 0.0])).unwrap();
    let mut boxes = BoxWorld::new();
    boxes.insert(Aabb::new([-1.0; 3], [0.5; 3])).unwrap();
    boxes.insert(Aabb::new([2.0; 3], [2.5; 3])).unwrap();
    for _ in 0..2 {
        index.update(&bodies);
        assert_same(&index, &bodies, random);
        index.update(&boxes);
        assert_same(&index, &boxes, random);
        index.update(&World::new(Vec::new()).unwrap());
        assert!(index.is_empty());
    }
}
