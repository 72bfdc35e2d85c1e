//! One change at a time: bodies that rest, are woken, leave, or change anything else a verdict
//! depends on.

use sdop::mesh::ProceduralShape;
use sdop::settings::{Budget, CullSettings, Strategy};
use sdop::volume::{Shape, ShapeSpec};
use sdop::world::{Body, BodyId, Groups, Motion, World};
use sdop_judge::configuration::{variants, ways as judged_ways};

use super::{Random, shapes, world_of};

/// A row of boxes, each of which meets the next, culled.
fn row(count: u16, motion: Motion, way: &CullSettings) -> (World, Vec<BodyId>) {
    let mut world = world_of(&shapes(), way);
    let at =
        |i: u16| Body { motion, ..Body::at(0, Body::default().rotation, [f64::from(i), 0.0, 0.0]) };
    let ids = (0..count).map(|i| world.insert(at(i)).unwrap()).collect();
    world.cull().unwrap();
    assert_eq!(world.events().begun().count(), usize::from(count) - 1);
    (world, ids)
}

fn moved(world: &mut World, id: BodyId, x: f64) {
    world.set_pose(id, Body::default().rotation, [x, 0.0, 0.0]).unwrap();
}

/// Pairs at rest stay until a body leaves.
#[test]
fn resting_pairs_end_with_a_body() {
    let (mut world, ids) = row(100, Motion::Dynamic, &CullSettings::default());
    for &id in &ids {
        world.set_motion(id, Motion::Resting).unwrap();
    }
    moved(&mut world, ids[60], 60.25); // so that an index is made
    world.cull().unwrap();
    moved(&mut world, ids[60], 60.0);
    world.cull().unwrap();
    assert_eq!(world.pairs().len(), 99);
    assert_eq!(world.events().ended().count(), 0);
    // Set where it is and woken: nothing has changed.
    let before = world.counters().sphere;
    moved(&mut world, ids[7], 7.0);
    world.set_motion(ids[7], Motion::Dynamic).unwrap();
    world.cull().unwrap();
    assert_eq!(world.counters().sphere, before);
    assert_eq!(world.pairs().len(), 99);
    assert_eq!(world.events().iter().count(), 99);
    // Moved, one at rest leaves one of its neighbours, and stays at rest.
    moved(&mut world, ids[20], 20.5);
    world.cull().unwrap();
    assert!(world.events().ended().eq([[ids[19], ids[20]]]));
    assert_eq!(world.body(ids[20]).unwrap().motion, Motion::Resting);
    let volumes = world.counters().sphere.since(&before).updates;
    assert!((2..8).contains(&volumes), "{volumes}: its own and those near it");
    // Two fixed bodies are in no pair, one and another at rest are.
    for (at, motion, pairs) in
        [(50, Motion::Fixed, 98), (51, Motion::Fixed, 97), (50, Motion::Resting, 98)]
    {
        world.set_motion(ids[at], motion).unwrap();
        world.cull().unwrap();
        assert_eq!(world.pairs().len(), pairs, "{at} {motion:?}");
    }
    assert_eq!(world.events().begun().count(), 0, "it ended and began since the last call");
}

/// The body was moved after the cull that the snapshot has the pairs of, and the world has seen
/// that since.
#[test]
fn rollback_searches_all_bodies() {
    let (mut world, ids) = row(100, Motion::Dynamic, &CullSettings::default());
    moved(&mut world, ids[20], 20.5);
    let saved = world.snapshot();
    for _ in 0..2 {
        world.cull().unwrap();
        assert_eq!(world.pairs().len(), 98);
        world.restore(&saved).unwrap();
        assert_eq!(world.pairs().len(), 99);
    }
}

/// Cubes of edge 2 at f32 translations, about 2²⁰, until two are placed that touch: rounded to f32
/// about the world's origin, they would be a sixteenth apart.
#[test]
fn origins_come_with_far_bodies() {
    let way = CullSettings::default();
    let base = f64::from(1 << 20);
    let at = |x: f64| Body::at(0, Body::default().rotation, [base + x, 0.0, 0.0]);
    let [x, y, z] = [2.0; 3];
    let mesh = ProceduralShape::Box { x, y, z }.build().unwrap();
    let shape = Shape::build(&mesh, &ShapeSpec::default()).unwrap();
    let mut world = world_of(&[shape], &way);
    let ids: Vec<BodyId> =
        (0..40).map(|i| world.insert(at(8.0 + 4.0 * f64::from(i))).unwrap()).collect();
    world.cull().unwrap();
    moved(&mut world, ids[0], base - 50.0); // so that the bounds of all are kept
    world.cull().unwrap();
    for (x, pairs) in [(0.07, 1), (0.25, 0), (0.07, 1)] {
        moved(&mut world, ids[0], base - 2.0 + 0.07);
        moved(&mut world, ids[1], base + x);
        world.cull().unwrap();
        assert_eq!(world.pairs().len(), pairs, "{x}");
    }
    moved(&mut world, ids[0], base - 50.0);
    moved(&mut world, ids[1], base - 40.0);
    world.cull().unwrap();
    assert_eq!(world.pairs().len(), 0);
}

/// Whatever a verdict depends on is changed alone, of bodies that stay where they are. A needle is
/// as wide as half a unit along the row.
#[test]
fn each_input_changes_verdict() {
    let (mut world, ids) = row(100, Motion::Resting, &CullSettings::default());
    let mut set = |change: fn(&mut Body), pairs: usize| {
        let mut body = world.body(ids[30]).unwrap();
        change(&mut body);
        world.set(ids[30], body).unwrap();
        world.cull().unwrap();
        assert_eq!(world.pairs().len(), pairs);
    };
    set(|body| body.groups = Groups { member: 1, mask: 0 }, 97);
    set(|body| body.groups = Groups::ALL, 99);
    set(|body| body.margin = 1.25, 101);
    set(|body| body.margin = 0.0, 99);
    set(|body| body.shape = 2, 97);
    set(|body| body.rotation = [0.0, 0.5, 0.0, 0.5], 101); // its tips reach along the row
    set(|body| body.rotation = [0.0, 0.0, 0.0, 1.0], 97);
    set(|body| body.shape = 0, 99);
    for (shape, pairs) in [(2, 0), (0, 99)] {
        world.replace_shape(0, &shapes()[shape]).unwrap();
        world.cull().unwrap();
        assert_eq!(world.pairs().len(), pairs);
    }
}

/// So many needles side by side: the spheres of neighbours meet, their or-DOPs don't.
fn needles(way: &CullSettings, count: u32) -> (World, Vec<BodyId>) {
    let mut world = world_of(&shapes(), way);
    let ids = (0..count).map(|i| world.insert(needle(3.0 * f64::from(i))).unwrap());
    let ids = ids.collect();
    (world, ids)
}

fn needle(y: f64) -> Body {
    Body::at(2, Body::default().rotation, [0.0, y, 0.0])
}

#[test]
fn interest_alone_changes_pairs() {
    let strategy = Strategy::SDopObjectOfInterest;
    let (mut world, ids) = needles(&CullSettings { strategy, ..CullSettings::default() }, 40);
    world.cull().unwrap();
    assert_eq!(world.pairs().len(), 39);
    for (of_interest, pairs) in [(vec![ids[0]], 38), (vec![ids[5], ids[20]], 35), (vec![], 39)] {
        world.set_interest(&of_interest).unwrap();
        world.cull().unwrap();
        assert_eq!(world.pairs().len(), pairs, "{of_interest:?}");
    }
    world.set_interest(&[ids[7]]).unwrap();
    world.cull().unwrap();
    world.remove(ids[7]).unwrap();
    world.cull().unwrap();
    let again = world.insert(needle(21.0)).unwrap();
    world.cull().unwrap();
    assert_eq!((again.slot(), world.pairs().len()), (ids[7].slot(), 39));
}

/// A budget of one test refines the first pair. When its first body leaves, the next pair is
/// refined, although none of its bodies has changed; when it comes back, it isn't any more.
#[test]
fn unrefined_pair_is_not_kept() {
    let way = CullSettings {
        strategy: Strategy::SDopTimeCritical,
        budget: Some(Budget::Tests(1)),
        ..CullSettings::default()
    };
    let (mut world, ids) = needles(&way, 40);
    for (y, refined) in [(0.0, 0), (-1000.0, 1), (0.0, 0)] {
        let at = needle(y);
        world.set_pose(ids[0], at.rotation, at.translation).unwrap();
        for _ in 0..3 {
            let pairs: Vec<_> = world.cull().unwrap().iter().collect();
            let neighbours = ids.windows(2).map(|two| [two[0], two[1]]);
            assert!(neighbours.skip(refined + 1).eq(pairs), "{y}");
        }
    }
}

/// Bodies that touch to the bit stop, rest, are woken, and leave by an ulp.
#[test]
fn touching_bodies_freeze_and_thaw() {
    let ulp = f64::from(f32::EPSILON) * 16.0;
    for (k, axes) in variants() {
        let [x, y, z] = [2.0; 3];
        let spec = ShapeSpec { directions: k, axes, ..ShapeSpec::default() };
        let mesh = ProceduralShape::Box { x, y, z }.build().unwrap();
        let shape = Shape::build(&mesh, &spec).unwrap();
        for way in judged_ways(k, axes) {
            if way.strategy == Strategy::None {
                continue;
            }
            let way = CullSettings { budget: Some(Budget::Tests(1000)), ..way };
            let mut world = world_of(std::slice::from_ref(&shape), &way);
            let at = |x: f64| Body::at(0, Body::default().rotation, [x, 0.0, 0.0]);
            let ids: Vec<BodyId> =
                (0..20).map(|i| world.insert(at(2.0 * f64::from(i))).unwrap()).collect();
            assert!(world.cull().unwrap().len() >= 19);
            for (motion, x) in [
                (Motion::Resting, 20.0),
                (Motion::Resting, 20.0 + ulp),
                (Motion::Dynamic, 20.0),
                (Motion::Fixed, 20.0),
                (Motion::Resting, 25.0),
                (Motion::Dynamic, 20.0 - ulp),
                (Motion::Resting, 20.0),
            ] {
                world.set(ids[10], Body { motion, ..at(x) }).unwrap();
                let now = world.cull().unwrap().sorted();
                let before = now.contains(&[ids[9], ids[10]]) || x > 20.0;
                let after = now.contains(&[ids[10], ids[11]]) || !(20.0..21.0).contains(&x);
                assert!(before && after, "{way:?} {motion:?} {x}");
                let mut fresh = world_of(std::slice::from_ref(&shape), &way);
                for (id, body) in world.bodies() {
                    assert_eq!(fresh.insert(body).unwrap(), id);
                }
                assert_eq!(now, fresh.cull().unwrap().sorted(), "{way:?} {motion:?} {x}");
            }
        }
    }
}

/// Counted, not timed: what is looked at doesn't depend on how many bodies there are.
#[test]
fn a_frame_costs_what_changes() {
    let volumes_of = |count: u32, far: f64| {
        let mut random = Random::new(5);
        let mut world = World::new(shapes()).unwrap();
        let side = f64::from(count).cbrt();
        let place = |random: &mut Random| {
            [(); 3].map(|()| far + 2.0 * side * f64::from(random.within(1.0)))
        };
        let ids: Vec<BodyId> = (0..count)
            .map(|i| {
                world.insert(Body::at(i % 3, [0.0, 0.0, 0.6, 0.8], place(&mut random))).unwrap()
            })
            .collect();
        // Such that no other body is the outermost.
        for x in [-3.0, 3.0] {
            world.insert(Body::at(0, [1.0; 4], [far + x * side; 3])).unwrap();
        }
        world.cull().unwrap();
        world.set_pose(ids[0], [1.0; 4], place(&mut random)).unwrap();
        world.cull().unwrap(); // makes an index
        let before = *world.counters();
        for frame in 0..50 {
            let id = ids[random.below(count) as usize];
            let at = place(&mut random);
            match frame % 3 {
                0 => world.set_pose(id, [1.0; 4], at).unwrap(),
                1 => drop(world.insert(Body::at(1, [1.0; 4], at)).unwrap()),
                _ => world.set(id, Body::at(2, [1.0; 4], at).fixed()).unwrap(),
            }
            world.cull().unwrap();
        }
        let counted = world.counters().since(&before);
        counted.sphere.updates + counted.ordop.updates + counted.sphere.tests + counted.ordop.tests
    };
    for far in [0.0, 1.0e9 + 0.1] {
        let [few, many] = [500, 8000].map(|count| volumes_of(count, far));
        assert!(many < 2 * few && many < 50 * 100, "{few}, {many}, {far}");
    }
}
