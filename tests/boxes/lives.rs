//! Boxes that come and go: whatever has happened, pairs and events are those of the definition.

use std::collections::{BTreeMap, BTreeSet};

use sdop::boxes::{BoxBody, BoxWorldSnapshot};
use sdop::{Aabb, BodyId, BoxCuller, BoxWorld, Finder, Groups, Motion, Tier, WorldError};

use crate::boxes::scenes::{Kind, Random, boxes, expected, moved};

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

/// Inserts, removes, changes and moves boxes, and holds what the world says against the definition.
/// `before_frame` may put another world in the place of this one, if it makes no difference.
fn live(world: &mut BoxWorld, kind: Kind, seed: u64, before_frame: fn(&mut BoxWorld, usize)) {
    let random = &mut Random(seed);
    let mut bodies: BTreeMap<BodyId, BoxBody> = BTreeMap::new();
    let mut gone: Vec<BodyId> = Vec::new();
    let mut before = BTreeSet::new();
    for frame in 0..40 {
        before_frame(world, frame);
        let calls = [0, 1, 30][random.below(3)];
        for _ in 0..calls {
            let body = drawn(random, kind);
            let ids: Vec<BodyId> = bodies.keys().copied().collect();
            let one = (!ids.is_empty()).then(|| ids[random.below(ids.len())]);
            match (random.below(6), one) {
                (0, Some(id)) => {
                    world.remove(id).unwrap();
                    assert!(world.remove(id).is_err() && world.body(id).is_err());
                    bodies.remove(&id);
                    gone.push(id);
                }
                (1, Some(id)) => {
                    world.set(id, body).unwrap();
                    bodies.insert(id, body);
                }
                (2, Some(id)) => {
                    world.set_bounds(id, body.bounds).unwrap();
                    bodies.get_mut(&id).unwrap().bounds = body.bounds;
                }
                _ => {
                    let id = world.insert(body).unwrap();
                    assert!(!gone.contains(&id) && bodies.insert(id, body).is_none());
                }
            }
        }
        for (&id, body) in bodies.iter_mut().filter(|(_, body)| body.motion == Motion::Dynamic) {
            moved(std::slice::from_mut(&mut body.bounds), 0.02, random);
            world.set_bounds(id, body.bounds).unwrap();
        }
        world.cull().unwrap();
        let wanted = pairs(&bodies);
        assert_eq!(world.len(), bodies.len());
        assert!(bodies.iter().all(|(&id, &body)| world.body(id).unwrap() == body));
        let listed: Vec<[BodyId; 2]> = world.pairs().collect();
        let found: BTreeSet<[BodyId; 2]> = listed.iter().copied().collect();
        assert!(listed.iter().is_sorted(), "{kind:?}, frame {frame}");
        assert!(world.ids().eq(bodies.keys().copied()));
        assert!(found == wanted && listed.len() == found.len(), "{kind:?}, frame {frame}");
        let events = world.events();
        assert!(events.begun().eq(wanted.difference(&before).copied()), "{kind:?}, frame {frame}");
        assert!(
            events.persisting().eq(wanted.intersection(&before).copied()),
            "{kind:?}, frame {frame}"
        );
        assert!(events.ended().eq(before.difference(&wanted).copied()), "{kind:?}, frame {frame}");
        before = wanted;
    }
}

/// After any insertions and removals, pairs and events match the definition.
#[test]
fn random_histories_match_definition() {
    for (kind, seed) in Kind::ALL.into_iter().zip(10..) {
        live(&mut BoxWorld::new(), kind, seed, |_, _| ());
        for &finder in Finder::ALL {
            let way =
                BoxCuller::builder().finder(finder).tier(Tier::SCALAR).threads(2).worth_waking(0);
            live(&mut BoxWorld::with(&way).unwrap(), kind, seed + 100, |_, _| ());
        }
    }
}

pub fn through_text(world: &BoxWorld) -> BoxWorldSnapshot {
    serde_json::from_str(&serde_json::to_string(&world.snapshot()).unwrap()).unwrap()
}

/// Goes astray in a clone and rolls it back, or restores the world in another that culls by another
/// finder.
fn restore(world: &mut BoxWorld, frame: usize) {
    let saved = through_text(world);
    let mut other = if frame.is_multiple_of(3) {
        world.clone()
    } else {
        let finder = Finder::ALL[frame % Finder::ALL.len()];
        BoxWorld::with(&BoxCuller::builder().finder(finder)).unwrap()
    };
    let ids: Vec<BodyId> = other.ids().collect();
    for &id in ids.iter().step_by(2) {
        other.remove(id).unwrap();
    }
    other.cull().unwrap();
    other.events();
    other.insert(Aabb::new([-1.0e9; 3], [1.0e9; 3])).and_then(|id| other.remove(id)).unwrap();
    other.restore(&saved).unwrap();
    assert_eq!(other.snapshot(), saved);
    if frame % 5 == 4 {
        other.shrink_to_fit();
    }
    *world = other;
}

#[test]
fn restored_worlds_of_boxes_go_on() {
    for (kind, seed) in Kind::ALL.into_iter().zip(40..) {
        live(&mut BoxWorld::new(), kind, seed, restore);
    }
}

/// Numbers that no world has written.
#[test]
fn damaged_snapshots_of_boxes_are_refused() {
    let (mut world, mut random) = (BoxWorld::new(), Random(3));
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

/// Crowds of a world come in portions or up to a limit.
#[test]
fn crowds_in_portions_or_limited() {
    let mut world = BoxWorld::new();
    for _ in 0..500 {
        world.insert(Aabb::new([0.0; 3], [1.0; 3])).unwrap();
    }
    let pairs = 500 * 499 / 2;
    let whole = world.cull().unwrap().sorted();
    let mut portions = Vec::new();
    let count = world.cull_in_portions(|portion| portions.extend(portion));
    assert_eq!((count, world.pairs().len()), (Ok(pairs as u64), 0));
    portions.sort();
    assert_eq!(portions, whole);
    let refused = world.cull_up_to(pairs - 1).map(|pairs| pairs.len());
    assert!(matches!(refused, Err(WorldError::Cull(_))), "{refused:?}");
    assert_eq!(world.pairs().len(), 0);
    let listed = world.cull_up_to(pairs).map(|pairs| pairs.sorted());
    assert_eq!(listed, Ok(whole));
    assert!(world.pair_bytes() >= 8 * pairs);
}

/// A box at rest that is moved is found where it is.
#[test]
fn moved_resting_box_is_found() {
    let mut world = BoxWorld::new();
    let cube = |x: f32| Aabb::new([x, 0.0, 0.0], [x + 1.0, 1.0, 1.0]);
    let still = world.insert(BoxBody { motion: Motion::Fixed, ..cube(0.0).into() }).unwrap();
    let moving = world.insert(cube(5.0)).unwrap();
    for x in [4.0, 4.5, 6.0, 6.0_f32.next_up(), 3.0] {
        world.set_bounds(still, cube(x)).unwrap();
        world.cull().unwrap();
        let meets = (4.0..=6.0).contains(&x);
        assert!(world.pairs().eq(meets.then_some([still, moving])), "{x}");
    }
    // Far from where it was, so that the cube it had there is of no use.
    world.set_bounds(still, cube(20.0)).unwrap();
    world.set_bounds(moving, cube(20.5)).unwrap();
    world.cull().unwrap();
    assert!(world.pairs().eq([[still, moving]]));
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
