//! Boxes that come and go: whatever has happened, pairs and events are those of the definition.

use std::collections::{BTreeMap, BTreeSet};

use sdop::boxes::{BoxBody, BoxWorldSnapshot};
use sdop::{Aabb, BodyId, BoxCuller, BoxWorld, Finder, Groups, Motion};

use crate::boxes::scenes::{Kind, boxes, expected};
use crate::histories::{HistoryKind, live};
use sdop_judge::draw::random::Random;

pub fn drawn(random: &mut Random, kind: Kind) -> BoxBody {
    let bounds = boxes(kind, 8, random)[random.below(8)];
    let motion = match random.below(8) {
        0..2 => Motion::Fixed,
        2..4 => Motion::Resting,
        _ => Motion::Dynamic,
    };
    let groups = match random.below(4) {
        0 => Groups { member: 1 << random.below(2), mask: 1 << random.below(2) },
        _ => Groups::ALL,
    };
    BoxBody { bounds, motion, groups }
}

/// The pairs of the boxes that are there, the lower slot first.
pub fn pairs(bodies: &BTreeMap<BodyId, BoxBody>) -> BTreeSet<[BodyId; 2]> {
    let (ids, bodies): (Vec<BodyId>, Vec<BoxBody>) =
        bodies.iter().map(|(&id, &body)| (id, body)).unzip();
    let bounds: Vec<Aabb> = bodies.iter().map(|body| body.bounds).collect();
    let found = expected(&bounds, |i| bodies[i].motion != Motion::Fixed, |i| bodies[i].groups);
    found.into_iter().map(|pair| pair.map(|i| ids[i as usize])).collect()
}

/// After any insertions and removals, pairs and events match the definition.
#[test]
fn histories_of_boxes() {
    live(HistoryKind::Boxes, 2..60);
}

/// Numbers that no world has written.
#[test]
fn damaged_snapshots_of_boxes_are_refused() {
    let (mut world, mut random) = (BoxWorld::new(), Random::new(3));
    let ids: Vec<BodyId> =
        (0..20).map(|_| world.insert(drawn(&mut random, Kind::ALL[0])).unwrap()).collect();
    world.cull().unwrap();
    world.events();
    world.remove(ids[3]).unwrap();
    world.cull().unwrap();
    world.remove(ids[5]).unwrap();
    let whole = serde_json::to_value(world.snapshot()).unwrap();
    for (path, value) in [
        ("/version", serde_json::json!(1)),
        ("/bounds/7/0/1", serde_json::json!(f32::NAN.to_bits())),
        ("/bounds/7/0/1", serde_json::json!(f32::MAX.to_bits())),
        ("/bounds", serde_json::json!([])),
        ("/dynamic", serde_json::json!([true])),
        ("/groups", serde_json::json!([])),
        ("/ids/generation", serde_json::json!([1])),
        ("/ids/free/0", serde_json::json!([5, 0])),
        ("/ids/emptied/0", serde_json::json!([6, 0])),
        ("/ids/slots/5", serde_json::json!(5)),
        ("/ids/slots/17", serde_json::json!(u32::MAX)),
        ("/pairs/last", serde_json::json!([[2, 1], [4, 4]])),
        ("/pairs/last", serde_json::json!([[3], [4]])),
        ("/pairs/last", serde_json::json!([[1], [20]])),
        ("/pairs/watched", serde_json::json!([[20, 0, 1, 0]])),
        ("/pairs/gone", serde_json::json!([[6, 0]])),
        ("/pairs/changed", serde_json::json!([99])),
    ] {
        let mut text = whole.clone();
        *text.pointer_mut(path).unwrap() = value;
        let mut other = world.clone();
        let outcome = serde_json::from_value::<BoxWorldSnapshot>(text);
        if let Ok(snapshot) = outcome {
            assert!(other.restore(&snapshot).is_err(), "{path}");
        }
        assert_eq!(other.snapshot(), world.snapshot());
    }
}

/// The cube around the plate contains all moving boxes; only its ends show that nothing touches it.
#[test]
fn resting_plate_is_no_cube() {
    for &finder in Finder::ALL {
        let mut world = BoxWorld::with(&BoxCuller::builder().finder(finder)).unwrap();
        let plate = Aabb::new([-9.0, -9.0, -0.125], [9.0, 9.0, 0.0]);
        let plate = world.insert(BoxBody { motion: Motion::Fixed, ..plate.into() }).unwrap();
        let cube = |x: u16, z: f32| {
            let x = 2.0 * f32::from(x) - 8.0;
            Aabb::new([x, x, z], [x + 1.0, x + 1.0, z + 1.0])
        };
        let cubes: Vec<BodyId> = (0..8).map(|x| world.insert(cube(x, 0.5)).unwrap()).collect();
        for landed in 0..4 {
            for (x, &id) in (0..).zip(&cubes) {
                let z = if x < landed { 0.0 } else { 0.0_f32.next_up() };
                world.set_bounds(id, cube(x, z)).unwrap();
            }
            world.cull().unwrap();
            let wanted = cubes[..usize::from(landed)].iter().map(|&id| [plate, id]);
            assert!(
                world.pairs().collect::<BTreeSet<_>>() == wanted.collect(),
                "{finder}, {landed} landed"
            );
        }
    }
}
