//! Bodies in far-apart regions: pairs are those of the exact f64 translations, follow from the bodies as they are now, and are
//! hardly more than each region alone has.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use sdop::culler::Culler;
use sdop::mesh::ProceduralShape;
use sdop::settings::{CullSettings, Strategy};
use sdop::volume::{Shape, ShapeSpec};
use sdop::world::{Body, BodyId, World};

use super::Random;

/// Cubes of half side 1 and a sixteenth.
const HALF: [f64; 2] = [1.0, 0.0625];

fn world() -> World {
    let cube = |half: f64| {
        let [x, y, z] = [(2.0 * half) as f32; 3];
        let mesh = ProceduralShape::Box { x, y, z }.build().unwrap();
        Shape::build(&mesh, &ShapeSpec::default()).unwrap()
    };
    let way = CullSettings {
        strategy: Strategy::SDopBatch,
        ..CullSettings::default()
    };
    World::with(HALF.map(cube).to_vec(), &Culler::builder().settings(&way)).unwrap()
}

/// Where the body of a region lies: unturned, so that cubes meet exactly where no axis separates them.
fn near(random: &mut Random, base: [f64; 3], wide: f64) -> Body {
    let unit = [(); 3].map(|()| f64::from(random.unit()));
    Body {
        shape: random.below(2),
        dynamic: random.below(4) > 0,
        translation: std::array::from_fn(|i| base[i] + wide * unit[i]),
        ..Body::default()
    }
}

/// Whether the cubes meet; differences of f64 as near as that are exact enough: within 2⁻³ of bodies 10¹⁵ away.
fn meet(a: &Body, b: &Body) -> bool {
    let most = HALF[a.shape as usize] + HALF[b.shape as usize];
    (0..3).all(|i| (a.translation[i] - b.translation[i]).abs() <= most)
}

fn assert_no_pair_is_missed(world: &World, pairs: &[[BodyId; 2]]) {
    let bodies: Vec<(BodyId, Body)> = world.bodies().collect();
    for (at, (i, a)) in bodies.iter().enumerate() {
        for (j, b) in &bodies[at + 1..] {
            let asked = (a.dynamic || b.dynamic) && meet(a, b);
            let is_reported = pairs.binary_search(&[*i, *j]).is_ok();
            assert!(is_reported || !asked, "{a:?} {b:?}");
        }
    }
}

/// The pairs of a new world with the same bodies, by their numbers among those present.
fn afresh(bodies: &[(BodyId, Body)]) -> Vec<[BodyId; 2]> {
    let mut fresh = world();
    let ids: Vec<BodyId> = bodies
        .iter()
        .map(|(_, body)| fresh.insert(*body).unwrap())
        .collect();
    let old = |id: BodyId| bodies[ids.binary_search(&id).unwrap()].0;
    let pairs = fresh.cull().unwrap().sorted();
    pairs.into_iter().map(|pair| pair.map(old)).collect()
}

/// Teleports between regions, insertions, removals, static bodies that are moved; regions that merge and split, and times
/// when all translations are f32.
#[test]
fn pairs_follow_from_present_bodies() {
    let mut random = Random(ChaCha8Rng::seed_from_u64(1));
    let mut world = world();
    let mut seen = 0;
    for frame in 0..150 {
        let far = [1.0e9 + 0.3, 2.0e15, 400.1, 6.0e4 + 0.7][frame / 8 % 4];
        let place = |random: &mut Random| {
            let base = [(); 3].map(|()| f64::from(random.below(3)) * far);
            let mut body = near(random, base, 2.5);
            if frame % 11 == 10 {
                body.translation = body.translation.map(|x| f64::from(x as f32));
            }
            body
        };
        for (id, _) in world.bodies().collect::<Vec<_>>() {
            match random.below(8) {
                0 => world.remove(id).unwrap(),
                1..4 => world.set(id, place(&mut random)).unwrap(),
                _ if frame % 11 == 10 => world.set(id, place(&mut random)).unwrap(),
                _ => {}
            }
        }
        for _ in 0..random.below(40) {
            world.insert(place(&mut random)).unwrap();
        }
        let pairs = world.cull().unwrap().sorted();
        assert_no_pair_is_missed(&world, &pairs);
        let bodies: Vec<(BodyId, Body)> = world.bodies().collect();
        assert_eq!(pairs, afresh(&bodies), "frame {frame}");
        seen += pairs.len();
    }
    assert!(seen > 1000, "{seen}");
}

#[test]
fn regions_add_few_pairs() {
    for (seed, regions, least, most) in [(1, 1000, 9.0, 15.0), (2, 3, 9.0, 15.0), (3, 60, 3.0, 6.0)]
    {
        let mut random = Random(ChaCha8Rng::seed_from_u64(seed));
        let mut whole = world();
        let mut alone = 0;
        for _ in 0..regions {
            let base = [(); 3].map(|()| {
                let unit = f64::from(random.unit());
                unit.signum() * 10_f64.powf(least + (most - least) * unit.abs())
            });
            let mut one = world();
            for _ in 0..10 + random.below(21) {
                let body = near(&mut random, base, 5.0);
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

/// A row of touching cubes through many cells and their borders, along each diagonal, beside a body far away.
#[test]
fn chains_hold_across_cells() {
    for way in [
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [1.0, -1.0, 1.0],
        [-1.0, 1.0, 1.0],
    ] {
        for start in [-128.0, -127.7, 1.0e9 + 0.1] {
            let mut world = world();
            for i in 0..300 {
                let translation = way.map(|x| start + x * 2.0 * f64::from(i));
                let body = Body {
                    translation,
                    ..Body::default()
                };
                world.insert(body).unwrap();
            }
            let away = Body {
                translation: [1.0e12 + 0.1, 0.0, 0.0],
                ..Body::default()
            };
            world.insert(away).unwrap();
            let pairs = world.cull().unwrap().sorted();
            let along = pairs.iter().filter(|[a, b]| b.slot() == a.slot() + 1);
            assert_eq!(along.count(), 299, "{way:?}, {start}");
        }
    }
}
