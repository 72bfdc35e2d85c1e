//! Bodies in far-apart regions, and bodies that are too far apart for one origin.

use sdop::culler::Culler;
use sdop::mesh::{ProceduralShape, TriangleMesh};
use sdop::settings::{CullSettings, Strategy};
use sdop::volume::{Shape, ShapeSpec};
use sdop::world::{Body, BodyId, Motion, World, WorldError};

use super::{Random, motion};

/// Half the sides of cubes: ordinary ones, small ones and giants.
const HALF: [f64; 3] = [1.0, 0.0625, 2048.0];

fn world() -> World {
    let cube = |half: f64| {
        let [x, y, z] = [(2.0 * half) as f32; 3];
        let mesh = ProceduralShape::Box { x, y, z }.build().unwrap();
        Shape::build(&mesh, &ShapeSpec::default()).unwrap()
    };
    let way = CullSettings { strategy: Strategy::SDopBatch, ..CullSettings::default() };
    World::with(HALF.map(cube).to_vec(), &Culler::builder().settings(&way)).unwrap()
}

/// An ordinary or small body somewhere in a place: unturned, so that cubes meet exactly where no
/// axis separates them.
fn near(random: &mut Random, base: [f64; 3], wide: f64) -> Body {
    let unit = [(); 3].map(|()| f64::from(random.within(1.0)));
    Body {
        shape: random.below(2),
        motion: motion(random.below(4) > 0),
        translation: std::array::from_fn(|i| base[i] + wide * unit[i]),
        ..Body::default()
    }
}

#[test]
fn regions_add_few_pairs() {
    for (seed, regions, wide, least, most) in
        [(1, 1000, 5.0, 9.0, 15.0), (2, 3, 2.0, 9.0, 15.0), (3, 60, 5.0, 3.0, 6.0)]
    {
        let mut random = Random::new(seed);
        let mut whole = world();
        let mut alone = 0;
        whole.insert(Body::default()).unwrap(); // one translation is f32
        for _ in 0..regions {
            let base = [(); 3].map(|()| {
                let unit = f64::from(random.within(1.0));
                unit.signum() * 10_f64.powf(least + (most - least) * unit.abs())
            });
            let mut one = world();
            for _ in 0..10 + random.below(21) {
                let body = near(&mut random, base, wide);
                one.insert(body).unwrap();
                whole.insert(body).unwrap();
            }
            alone += one.cull().unwrap().sorted().len();
        }
        let all = whole.cull().unwrap().sorted().len();
        assert!(alone > 20, "{alone}");
        assert!(all as f64 <= 1.1 * alone as f64 + 4.0, "{all} of {alone}");
    }
}

/// Giants in one place leave the small bodies of others as finely placed as they are alone.
#[test]
fn giants_elsewhere_add_few_pairs() {
    let mut random = Random::new(4);
    let (mut whole, mut alone) = (world(), 0);
    for place in 0..40 {
        let base = [(); 3].map(|()| f64::from(random.within(1.0)) * [1.0e9, 1.0e6][place % 2]);
        let mut one = world();
        for _ in 0..30 {
            let mut body = near(&mut random, base, 1.5);
            (body.shape, body.motion) = (1, Motion::Dynamic);
            if place == 7 {
                body.shape = 2;
            }
            one.insert(body).unwrap();
            whole.insert(body).unwrap();
        }
        alone += one.cull().unwrap().sorted().len();
    }
    let all = whole.cull().unwrap().sorted().len();
    assert!(alone > 435 && all as f64 <= 1.1 * alone as f64 + 4.0, "{all} of {alone}");
}

/// A world of one far mesh, so large that all bodies are in one region. They may lie twice as far
/// out as the contract goes.
fn world_of_far_meshes() -> World {
    let corner = |x: f64, y: f64, z: f64| [1.0e18 + x * 1.0e16, y * 1.0e16, z * 1.0e16];
    let corners = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)];
    let points = corners.map(|(x, y, z)| corner(x, y, z));
    let mesh = TriangleMesh::from_f64(&points, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]);
    let shape = Shape::build(&mesh.unwrap(), &ShapeSpec::default()).unwrap();
    World::new(vec![shape]).unwrap()
}

/// Bodies that lie twice as far out as the contract goes can be placed about an origin near them,
/// but not on both sides of the world.
#[test]
fn refusals_follow_from_present_bodies() {
    let mut random = Random::new(5);
    let mut world = world_of_far_meshes();
    let mut seen = [0; 2];
    for frame in 0..1200 {
        let body = |random: &mut Random| Body {
            motion: motion(random.below(3) > 0),
            rotation: [[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 0.0]][random.below(2) as usize],
            translation: std::array::from_fn(|i| match i {
                0 => 1.1e18 * (f64::from(random.below(3)) - 1.0),
                _ => f64::from(random.within(1.0)) * 2.0e16,
            }),
            margin: [0.0, 4.0e15][random.below(2) as usize],
            ..Body::default()
        };
        // In two of three frames dynamic bodies change and all else stays, as far as the world is
        // told.
        let all_change = frame % 3 == 0;
        for (id, was) in world.bodies().collect::<Vec<_>>() {
            let draw = random.below(4);
            if all_change && draw == 0 {
                world.remove(id).unwrap();
            } else if draw < 2 && (all_change || was.motion.is_dynamic()) {
                let next = body(&mut random);
                let motion = motion(next.motion.is_dynamic() || !all_change);
                world.set(id, Body { motion, ..next }).unwrap();
            }
        }
        if all_change {
            for _ in 0..random.below(6) {
                world.insert(body(&mut random)).unwrap();
            }
        }
        let bodies: Vec<(BodyId, Body)> = world.bodies().collect();
        let mut fresh = world_of_far_meshes();
        let ids = bodies.iter().map(|(_, body)| fresh.insert(*body).unwrap());
        let ids: Vec<BodyId> = ids.collect();
        let old = |id: BodyId| bodies[ids.binary_search(&id).unwrap()].0;
        let expected = match fresh.cull() {
            Ok(pairs) => Ok(pairs.sorted().into_iter().map(|pair| pair.map(old)).collect()),
            Err(WorldError::Apart(id)) => Err(old(id)),
            Err(other) => panic!("{other}"),
        };
        let found: Result<Vec<[BodyId; 2]>, BodyId> = match world.cull() {
            Ok(pairs) => Ok(pairs.sorted()),
            Err(WorldError::Apart(id)) => Err(id),
            Err(other) => panic!("{other}"),
        };
        assert_eq!(found, expected, "frame {frame}: {bodies:?}");
        seen[usize::from(found.is_err())] += 1;
    }
    assert!(seen.iter().all(|&times| times > 30), "{seen:?}");
}

/// A margin that grows in a frame that is refused counts in the next one.
#[test]
fn refused_frames_lose_no_change() {
    let mut world = world_of_far_meshes();
    let turns = [[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 0.0]];
    let at = |turn: usize, x: f64, y: f64| Body::at(0, turns[turn], [x, y, 0.0]);
    // Two next to the world's origin, 2·10¹⁵ from each other, and two that can go beyond the
    // contract on either side.
    let middle = [0.0, 1.2e16].map(|y| at(0, -1.0e18, y));
    let [a, b] = middle.map(|body| world.insert(body).unwrap());
    let others = [0, 1].map(|turn| world.insert(at(turn, 0.0, 5.0e17)).unwrap());
    assert_eq!(world.cull().unwrap().sorted().len(), 0);
    let margin = 8.0e15;
    world.set(a, Body { margin, ..middle[0] }).unwrap();
    for (turn, x) in [1.1e18, -1.1e18].into_iter().enumerate() {
        world.set_pose(others[turn], turns[turn], [x, 5.0e17, 0.0]).unwrap();
    }
    assert_eq!(world.cull().err(), Some(WorldError::Apart(others[0])));
    for turn in 0..2 {
        world.set_pose(others[turn], turns[turn], [0.0, 5.0e17, 0.0]).unwrap();
    }
    assert_eq!(world.cull().unwrap().sorted(), [[a, b]]);
}

/// A row of touching cubes through many cells and their borders, along each diagonal, next to a
/// body far away.
#[test]
fn chains_hold_across_cells() {
    for way in [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, -1.0, 1.0], [-1.0, 1.0, 1.0]] {
        for start in [-128.0, -127.7, 1.0e9 + 0.1] {
            let mut world = world();
            for i in 0..300 {
                let translation = way.map(|x| start + x * 2.0 * f64::from(i));
                let body = Body { translation, ..Body::default() };
                world.insert(body).unwrap();
            }
            let away = Body { translation: [1.0e12 + 0.1, 0.0, 0.0], ..Body::default() };
            world.insert(away).unwrap();
            let pairs = world.cull().unwrap().sorted();
            let along = pairs.iter().filter(|[a, b]| b.slot() == a.slot() + 1);
            assert_eq!(along.count(), 299, "{way:?}, {start}");
        }
    }
}
