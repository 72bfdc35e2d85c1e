//! Worlds that are saved, restored and rolled back; shapes and pairs that come and go.

use sdop::settings::Order;
use sdop::world::WorldSnapshot;
use sdop::{Aabb, BoxCuller, BoxWorld, CullError};

use super::*;

/// What one frame gives: pairs in order, and events.
type Frame = [Vec<[BodyId; 2]>; 3];

/// Changes a world as its bodies and the number of the frame say, and culls it.
fn step(world: &mut World, frame: u64) -> Frame {
    let mut random = Random(ChaCha8Rng::seed_from_u64(frame));
    let mut fine = |random: &mut Random| {
        let mut body = random.body(3);
        // A third of the translations are no f32, and some bodies have a margin.
        if random.below(3) == 0 {
            body.translation = body.translation.map(|x| x + 1e-9);
        }
        body.margin = [0.0, 0.0, 0.1, 0.7][random.below(4) as usize];
        body
    };
    let ids: Vec<BodyId> = world.ids().collect();
    for id in ids {
        match random.below(8) {
            0 if world.len() > 20 => world.remove(id).unwrap(),
            1 => world.set(id, fine(&mut random)).unwrap(),
            2..5 => {
                let body = fine(&mut random);
                world.set_pose(id, body.rotation, body.translation).unwrap();
            }
            _ => {}
        }
    }
    for _ in 0..random.below(12) {
        world.insert(fine(&mut random)).unwrap();
    }
    let pairs: Vec<_> = world.cull().unwrap().iter().collect();
    assert!(pairs.is_sorted(), "{frame}");
    assert_eq!(world.pairs().collect::<Vec<_>>(), pairs);
    let events = world.events();
    [pairs, events.begun().collect(), events.ended().collect()]
}

fn world_of(way: &CullSettings, threads: usize) -> World {
    let culler = Culler::builder().settings(way).threads(threads);
    World::with(shapes(), &culler.worth_waking(0)).unwrap()
}

/// Every finder, by a strategy of each kind: those with a budget of tests in every order.
fn saved_ways() -> Vec<CullSettings> {
    let kept = [
        Strategy::SDopSequential,
        Strategy::SDopBatch,
        Strategy::SDopTimeCritical,
        Strategy::Aabb,
        Strategy::Obb,
    ];
    let ways = ways().into_iter();
    let ways = ways.filter(|way| kept.contains(&way.strategy) && way.updates == Updates::Eager);
    ways.flat_map(|way| {
        let orders = match way.strategy {
            Strategy::SDopTimeCritical => Order::ALL,
            _ => &Order::ALL[..1],
        };
        orders.iter().map(move |&order| CullSettings {
            order,
            ..way.clone()
        })
    })
    .collect()
}

#[test]
fn restored_worlds_go_on_alike() {
    for way in saved_ways() {
        let mut world = world_of(&way, 1);
        // The strategy stays, the finder and the threads don't.
        let finder = if way.pairs == Finder::Grid {
            Finder::AllPairs
        } else {
            Finder::Grid
        };
        let elsewhere = CullSettings {
            pairs: finder,
            ..way.clone()
        };
        let mut other = world_of(&elsewhere, 3);
        let mut seen = 0;
        for frame in 0..8 {
            let saved = world.snapshot();
            let text = serde_json::to_string(&saved).unwrap();
            let read: WorldSnapshot = serde_json::from_str(&text).unwrap();
            assert_eq!(read, saved);
            let first: Vec<Frame> = (0..3).map(|next| step(&mut world, frame + next)).collect();
            other.restore(&read).unwrap();
            assert_eq!(other.snapshot(), saved, "{way:?}, {frame}");
            let again: Vec<Frame> = (0..3).map(|next| step(&mut other, frame + next)).collect();
            assert!(first == again, "{way:?}, restored at {frame}");
            let copy: Vec<Frame> = {
                world.restore(&saved).unwrap();
                let mut copy = world.clone();
                (0..3).map(|next| step(&mut copy, frame + next)).collect()
            };
            assert!(first == copy, "{way:?}, rolled back at {frame} and cloned");
            assert!(
                first[0] == step(&mut world, frame),
                "{way:?}, rolled back at {frame}"
            );
            seen += first.iter().map(|[pairs, ..]| pairs.len()).sum::<usize>();
        }
        assert!(seen > 50, "{way:?}: {seen} pairs");
    }
}

#[test]
fn damaged_snapshots_are_refused() {
    let mut world = world_of(&CullSettings::default(), 1);
    for frame in 0..4 {
        step(&mut world, frame);
    }
    let saved = world.snapshot();
    let text = serde_json::to_string(&saved).unwrap();
    let whole: serde_json::Value = serde_json::from_str(&text).unwrap();
    type Damage = fn(&mut serde_json::Value);
    let damages: [(Damage, &str); 6] = [
        (|json| json["version"] = 2.into(), "version 2"),
        (
            |json| json["dynamic"] = serde_json::json!([true]),
            "`dynamic` has 1 entries",
        ),
        (
            |json| json["rotation"][0] = serde_json::json!([0, 0, 0, 0]),
            "damaged",
        ),
        (
            |json| json["ids"]["free"] = serde_json::json!([4_000_000]),
            "is free",
        ),
        (
            |json| json["shapes"][1]["digest"] = 7.into(),
            "another shape",
        ),
        (
            |json| json["origin"][2] = 0x7ff8_0000_0000_0000_u64.into(),
            "origin",
        ),
    ];
    for (damage, problem) in damages {
        let mut json = whole.clone();
        damage(&mut json);
        let said = match serde_json::from_value::<WorldSnapshot>(json) {
            Err(error) => error.to_string(),
            Ok(read) => world.restore(&read).unwrap_err().to_string(),
        };
        assert!(said.contains(problem), "{said}, not {problem}");
        assert_eq!(world.snapshot(), saved, "{problem}: the world has changed");
    }
}

#[test]
fn restored_boxes_go_on_alike() {
    let step = |world: &mut BoxWorld, frame: u64| -> Frame {
        let mut random = Random(ChaCha8Rng::seed_from_u64(frame));
        let mut bounds = |random: &mut Random| {
            let min: [f32; 3] = [(); 3].map(|()| 4.0 * random.unit());
            Aabb::new(min, min.map(|x| x + 1.0 + random.unit()))
        };
        let ids: Vec<BodyId> = world.ids().collect();
        for id in ids {
            match random.below(8) {
                0 if world.len() > 20 => world.remove(id).unwrap(),
                1..5 => world.set_bounds(id, bounds(&mut random)).unwrap(),
                _ => {}
            }
        }
        for _ in 0..random.below(12) {
            world.insert(bounds(&mut random)).unwrap();
        }
        let pairs: Vec<_> = world.cull().unwrap().iter().collect();
        assert!(pairs.is_sorted());
        let events = world.events();
        [pairs, events.begun().collect(), events.ended().collect()]
    };
    for &finder in Finder::ALL {
        let mut world = BoxWorld::with(&BoxCuller::builder().finder(finder)).unwrap();
        let mut other = BoxWorld::new();
        for frame in 0..12 {
            let saved = world.snapshot();
            let first: Vec<Frame> = (0..3).map(|next| step(&mut world, frame + next)).collect();
            for world in [&mut other, &mut world] {
                world.restore(&saved).unwrap();
                assert_eq!(world.snapshot(), saved);
                let again: Vec<Frame> = (0..3).map(|next| step(world, frame + next)).collect();
                assert!(first == again, "{finder:?}, {frame}");
            }
            world.restore(&saved).unwrap();
            step(&mut world, frame);
        }
    }
}

#[test]
fn shapes_are_removed_and_replaced() {
    let [cube, ball, needle] = shapes().try_into().unwrap();
    let mut world = World::new(vec![cube.clone(), ball]).unwrap();
    let at = |x: f64| Body::at(0, [0.0, 0.0, 0.0, 1.0], [x, 0.0, 0.0]);
    let one = world.insert(at(0.0)).unwrap();
    let two = world.insert(at(1.5)).unwrap();
    assert_eq!(world.cull().unwrap().len(), 0, "cubes of edge 1");
    assert!(world.remove_shape(0).is_err(), "two bodies have it");
    // The needle is four long in x; the bodies of the cube now have it.
    world.replace_shape(0, &needle).unwrap();
    assert_eq!(world.cull().unwrap().sorted(), [[one, two]]);
    world.replace_shape(0, &cube).unwrap();
    assert_eq!(world.cull().unwrap().len(), 0);
    world.remove_shape(1).unwrap();
    assert!(
        world
            .insert(Body {
                shape: 1,
                ..at(0.0)
            })
            .is_err()
    );
    assert!(world.remove_shape(1).is_err() && world.replace_shape(1, &cube).is_err());
    assert_eq!(world.add_shape(needle), Ok(1), "its number is given again");
    world
        .set(
            two,
            Body {
                shape: 1,
                ..at(1.5)
            },
        )
        .unwrap();
    assert_eq!(world.cull().unwrap().sorted(), [[one, two]]);
}

#[test]
fn crowds_are_read_in_portions_or_refused() {
    let mut world = World::new(shapes()).unwrap();
    let ids: Vec<BodyId> = (0..600)
        .map(|_| world.insert(Body::default()).unwrap())
        .collect();
    let all = 600 * 599 / 2;
    let mut portions = Vec::new();
    let reported = world
        .cull_in_portions(|portion| portions.extend(portion))
        .unwrap();
    portions.sort();
    assert_eq!((reported, portions.len()), (all as u64, all));
    assert!(portions.is_sorted_by(|a, b| a < b), "each once");
    match world.cull_up_to(all - 1) {
        Err(WorldError::Cull(CullError::TooManyPairs { pairs, limit })) => {
            assert_eq!((pairs, limit), (all as u64, all - 1));
        }
        _ => panic!("more pairs than the limit"),
    }
    assert_eq!(world.cull_up_to(all).unwrap().sorted(), portions);
    let crowded = world.pair_bytes();
    for (place, &id) in ids.iter().enumerate() {
        let apart = [0.0, 0.0, 10.0 * place as f64];
        world.set_pose(id, [0.0, 0.0, 0.0, 1.0], apart).unwrap();
    }
    assert_eq!(world.cull().unwrap().len(), 0);
    // Bodies are removed while the events are read, which still hold the crowd's pairs.
    let events = world.events();
    assert!(crowded > 8 * all && events.begun().count() == 0);
    for [first, _] in events.ended() {
        if world.contains(first) {
            world.remove(first).unwrap();
        }
    }
    drop(events);
    world.cull().unwrap();
    world.events();
    world.shrink_to_fit();
    assert!(world.pair_bytes() < crowded / 100, "{}", world.pair_bytes());
}
