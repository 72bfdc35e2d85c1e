//! What a change costs, and what it does to a budget and to the origin.

use sdop::mesh::ProceduralShape;
use sdop::settings::{Budget, CullSettings, Strategy};
use sdop::volume::{Shape, ShapeSpec};
use sdop::world::{Body, BodyId, World};

use super::{Random, shapes, world_of};

fn moved(world: &mut World, id: BodyId, x: f64) {
    world.set_pose(id, Body::default().rotation, [x, 0.0, 0.0]).unwrap();
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
