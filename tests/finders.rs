//! Every pair finder reports what all-pairs reports, on scenes made to be hard for it: the same set, in every tier and on
//! any number of threads the same list and the same counts.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sdop::broad_phase::Groups;
use sdop::cost::Counters;
use sdop::mesh::shapes::ProceduralShape;
use sdop::pipeline::Culler;
use sdop::scene::bodies::Bodies;
use sdop::scene::settings::{CullSettings, Finder, Strategy};
use sdop::simd::Level;
use sdop::volume::{DirectionSet, Shape, ShapeSpec};
use support::{random_quaternion, shapes};

const FINDERS: [Finder; 2] = [Finder::Grid, Finder::Sweep];

/// Strategies with each first test.
const STRATEGIES: [Strategy; 6] = [
    Strategy::Sphere,
    Strategy::SDopSequential,
    Strategy::OrDop,
    Strategy::Obb,
    Strategy::Aabb,
    Strategy::KDop,
];

struct Scene {
    name: &'static str,
    shapes: Vec<Shape>,
    bodies: Bodies,
    /// How far a coordinate may move in a frame.
    step: f32,
}

/// A boxy shape with the bounding radius asked for.
fn shape_of_radius(radius: f32) -> Shape {
    let mesh = ProceduralShape::default_of("box").unwrap().build().unwrap();
    let spec = ShapeSpec {
        radius: Some(radius),
        ..ShapeSpec::default()
    };
    Shape::build(&mesh, &spec).unwrap()
}

impl Scene {
    /// Bodies of the given radii, one shape a radius, at points drawn by `place`.
    fn new(
        name: &'static str,
        radii: &[f32],
        n: usize,
        mut place: impl FnMut(usize, &mut ChaCha8Rng) -> [f32; 3],
    ) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(n as u64);
        let mut bodies = Bodies::default();
        for i in 0..n {
            bodies.shape.push((i % radii.len()) as u32);
            bodies.dynamic.push(i % 7 != 3);
            bodies.rotation.push(random_quaternion(&mut rng));
            bodies.translation.push(place(i, &mut rng));
            bodies.velocity.push([0.0; 3]);
            bodies.spin.push([0.0; 3]);
        }
        Self {
            name,
            shapes: radii.iter().map(|&r| shape_of_radius(r)).collect(),
            bodies,
            step: 0.1 * radii[0],
        }
    }
}

fn uniform(rng: &mut ChaCha8Rng, side: f32) -> [f32; 3] {
    std::array::from_fn(|_| rng.random_range(0.0..side))
}

/// Scenes that have cost pair finders pairs, time or their composure.
fn hard_scenes() -> Vec<Scene> {
    let mut scenes = vec![
        Scene::new("none", &[1.0], 0, |_, _| [0.0; 3]),
        Scene::new("one", &[1.0], 1, |_, _| [5.0; 3]),
        Scene::new("two", &[1.0], 2, |i, _| [i as f32; 3]),
        Scene::new("uniform", &[1.0], 700, |_, rng| uniform(rng, 20.0)),
        Scene::new("sparse", &[1.0], 300, |_, rng| uniform(rng, 300.0)),
        Scene::new("crowded", &[1.0], 400, |_, rng| uniform(rng, 6.0)),
        Scene::new("coincident", &[1.0], 150, |_, _| [3.0, -2.0, 7.0]),
        Scene::new("on cell borders", &[1.0], 500, |i, _| {
            // Diameters of a little more than 2: neighbours touch, and the grid's borders run between them.
            [i % 8, i / 8 % 8, i / 64].map(|k| k as f32 * 2.000_002)
        }),
        Scene::new("half a cell off", &[1.0], 500, |i, _| {
            [i % 8, i / 8 % 8, i / 64].map(|k| k as f32 * 2.0 + 1.0)
        }),
        Scene::new("line along x", &[1.0], 300, |_, rng| {
            [rng.random_range(0.0..900.0), 1.0, 2.0]
        }),
        Scene::new("line along z", &[1.0], 300, |_, rng| {
            [1.0, 2.0, rng.random_range(0.0..900.0)]
        }),
        Scene::new("diagonal line", &[1.0], 300, |_, rng| {
            [rng.random_range(0.0..600.0); 3]
        }),
        Scene::new("plane", &[1.0], 500, |_, rng| {
            [
                rng.random_range(0.0..40.0),
                3.0,
                rng.random_range(0.0..40.0),
            ]
        }),
        Scene::new("slanted plane", &[1.0], 500, |_, rng| {
            let [x, y, _] = uniform(rng, 60.0);
            [x, y, -0.7 * x + 0.4 * y]
        }),
        Scene::new("clusters far apart", &[1.0], 500, |i, rng| {
            let centre = [1e4, -3e5, 7e3].map(|x: f32| x * (i % 5) as f32);
            let by = uniform(rng, 6.0);
            std::array::from_fn(|k| centre[k] + by[k])
        }),
        Scene::new("one far away", &[1.0], 400, |i, rng| match i {
            17 => [1e9, -1e9, 3e8],
            _ => uniform(rng, 15.0),
        }),
        Scene::new("far from the origin", &[1.0], 300, |_, rng| {
            uniform(rng, 64.0).map(|x| x + 1e8)
        }),
        Scene::new("at the contract's corners", &[1e16], 60, |i, _| {
            [0, 1, 2].map(|k| if i >> k & 1 == 1 { 1.1e18 } else { -1.1e18 })
        }),
        Scene::new("tiny", &[1e-30], 300, |_, rng| uniform(rng, 1e-29)),
        Scene::new("radii 1:16", &[1.0, 2.3, 5.1, 16.0], 400, |_, rng| {
            uniform(rng, 60.0)
        }),
        Scene::new(
            "radii 1:1000",
            &[0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0],
            600,
            |_, rng| uniform(rng, 25.0),
        ),
        Scene::new("points", &[1e-6, 1.0], 400, |_, rng| uniform(rng, 12.0)),
    ];
    let mut giant = Scene::new("a giant among tiny ones", &[0.05, 40.0], 600, |_, rng| {
        uniform(rng, 5.0)
    });
    giant.bodies.shape.iter_mut().for_each(|shape| *shape = 0);
    giant.bodies.shape[5] = 1;
    scenes.push(giant);
    let mut nested = Scene::new(
        "tiny cluster beside giants",
        &[0.01, 10.0],
        400,
        |i, rng| uniform(rng, if i % 2 == 0 { 0.1 } else { 200.0 }),
    );
    nested.step = 0.001;
    scenes.push(nested);
    let mut all_static = Scene::new("all static", &[1.0], 100, |_, rng| uniform(rng, 6.0));
    all_static.bodies.dynamic.fill(false);
    scenes.push(all_static);
    let many = random_scene();
    scenes.push(many);
    scenes
}

/// Shapes of all kinds, one of them about an origin far off its ball.
fn random_scene() -> Scene {
    let shapes = shapes(DirectionSet::K18, sdop::volume::Axes::Principal);
    let bodies = support::random_bodies(5, 300, 9.0, shapes.len());
    Scene {
        name: "every shape",
        shapes,
        bodies,
        step: 0.1,
    }
}

fn settings(strategy: Strategy, pairs: Finder) -> CullSettings {
    CullSettings {
        strategy,
        pairs,
        ..CullSettings::default()
    }
}

/// Culls some frames in which bodies move; `take` sees the culler after each.
fn run(
    scene: &Scene,
    settings: &CullSettings,
    level: Level,
    threads: usize,
    frames: usize,
    mut take: impl FnMut(&Culler),
) {
    let mut rng = ChaCha8Rng::seed_from_u64(99);
    let mut bodies = scene.bodies.clone();
    let culler = Culler::new(&scene.shapes, &bodies, settings, level).unwrap();
    let mut culler = culler.with_threads(threads).unwrap();
    for _ in 0..frames {
        culler.cull(&bodies);
        take(&culler);
        advance(&mut bodies, scene.step, &mut rng);
    }
}

/// Moves the moving bodies a little, the same way for everyone.
fn advance(bodies: &mut Bodies, step: f32, rng: &mut ChaCha8Rng) {
    for (t, &moves) in bodies.translation.iter_mut().zip(&bodies.dynamic) {
        for x in t {
            let by = rng.random_range(-step..=step);
            *x += if moves { by } else { 0.0 };
        }
    }
}

/// The sorted pairs of some frames.
fn found(scene: &Scene, strategy: Strategy, finder: Finder, frames: usize) -> Vec<Vec<[u32; 2]>> {
    let mut found = Vec::new();
    run(
        scene,
        &settings(strategy, finder),
        Level::detect(),
        1,
        frames,
        |culler| {
            found.push(culler.pairs().sorted());
        },
    );
    found
}

fn compare(found: &[Vec<[u32; 2]>], wanted: &[Vec<[u32; 2]>], what: &str) {
    for (frame, (found, wanted)) in found.iter().zip(wanted).enumerate() {
        let is_lost = |pair: &&[u32; 2]| found.binary_search(pair).is_err();
        let lost: Vec<_> = wanted.iter().filter(is_lost).collect();
        let (count, some) = (lost.len(), &lost[..lost.len().min(5)]);
        assert!(
            lost.is_empty(),
            "{what}, frame {frame}: lost {count} of {}: {some:?}",
            wanted.len()
        );
        assert_eq!(
            found.len(),
            wanted.len(),
            "{what}, frame {frame}: reported twice"
        );
    }
}

#[test]
fn every_finder_reports_what_all_pairs_reports() {
    for scene in hard_scenes() {
        for strategy in STRATEGIES {
            let wanted = found(&scene, strategy, Finder::AllPairs, 4);
            for finder in FINDERS {
                let found = found(&scene, strategy, finder, 4);
                compare(
                    &found,
                    &wanted,
                    &format!("{}, {strategy}, {finder}", scene.name),
                );
            }
        }
    }
}

/// Pairs of equal balls whose distance is that of touching up to a few roundings, in any direction or along an axis.
fn near_touching(seed: u64, radius: f32, offset: f32) -> Scene {
    let mut scene = Scene::new("near-touching", &[radius], 1200, |_, _| [0.0; 3]);
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let reach = 2.0 * f64::from(scene.shapes[0].ball.radius);
    let centres = &mut scene.bodies.translation;
    for (pair, centres) in centres.chunks_exact_mut(2).enumerate() {
        let way = match pair % 4 {
            0..3 => std::array::from_fn(|axis| f64::from(u8::from(axis == pair % 4))),
            _ => direction(&mut rng),
        };
        let [x, y, z] = uniform(&mut rng, 40.0 * radius).map(|x| x + offset);
        let distance = reach * (1.0 + rng.random_range(-12.0..12.0) * f64::from(f32::EPSILON));
        centres[0] = [x, y, z];
        centres[1] = std::array::from_fn(|k| (f64::from(centres[0][k]) + distance * way[k]) as f32);
    }
    scene.bodies.dynamic.fill(true);
    scene
}

/// Pairs of unequal balls that touch to the last bit along an axis, on either side of its origin: there the difference of
/// centres and the sum of radii round, so that a test reports pairs whose exact ends lie apart.
fn unequal_near_touching(seed: u64) -> Scene {
    let mut scene = Scene::new("unequal near-touching", &[1.0, 0.37], 1200, |_, _| [0.0; 3]);
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let [a, b] = [0, 1].map(|shape: usize| f64::from(scene.shapes[shape].ball.radius));
    for (pair, centres) in scene.bodies.translation.chunks_exact_mut(2).enumerate() {
        let axis = pair % 3;
        // The radii that are tested are wider by four ulps.
        let ulps = 4.0 + rng.random_range(-1.0..1.0);
        let distance = (a + b) * (1.0 + ulps * f64::from(f32::EPSILON));
        let at = uniform(&mut rng, 40.0);
        (centres[0], centres[1]) = (at, at);
        centres[0][axis] = (-distance * rng.random_range(0.1..0.9)) as f32;
        centres[1][axis] = (f64::from(centres[0][axis]) + distance) as f32;
    }
    scene.bodies.dynamic.fill(true);
    scene
}

fn direction(rng: &mut ChaCha8Rng) -> [f64; 3] {
    let v: [f64; 3] = std::array::from_fn(|_| rng.random_range(-1.0..1.0));
    let norm = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / norm)
}

#[test]
fn no_finder_loses_a_near_touching_pair() {
    for seed in 0..30 {
        let (radius, offset) = [(1.0, 0.0), (0.77, -31.0), (1e-3, 0.25)][seed as usize % 3];
        let scene = near_touching(seed, radius, offset);
        let wanted = found(&scene, Strategy::Sphere, Finder::AllPairs, 1);
        assert!(wanted[0].len() > 300, "about half of them touch");
        let unequal = unequal_near_touching(seed);
        for finder in FINDERS {
            let found = |scene| found(scene, Strategy::Sphere, finder, 1);
            compare(&found(&scene), &wanted, &format!("{finder}, seed {seed}"));
            let wanted = self::found(&unequal, Strategy::Sphere, Finder::AllPairs, 1);
            compare(
                &found(&unequal),
                &wanted,
                &format!("{finder}, unequal, seed {seed}"),
            );
        }
    }
}

/// What must not depend on tier or threads.
fn trace(
    scene: &Scene,
    settings: &CullSettings,
    level: Level,
    threads: usize,
) -> Vec<(Vec<[u32; 2]>, Counters)> {
    let mut trace = Vec::new();
    run(scene, settings, level, threads, 3, |culler| {
        trace.push((culler.pairs().iter().collect(), *culler.counters()));
    });
    trace
}

#[test]
fn groups_leave_of_every_list_the_pairs_that_may_collide() {
    let scene = Scene::new("groups", &[0.5, 1.0, 4.0], 500, |_, rng| uniform(rng, 22.0));
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    let mut bits = || rng.random_range(0..16u32) & rng.random_range(0..16u32);
    let groups: Vec<Groups> = (0..500)
        .map(|_| Groups {
            member: bits(),
            mask: bits() | 1,
        })
        .collect();
    let may = |&[a, b]: &[u32; 2]| {
        let (a, b) = (groups[a as usize], groups[b as usize]);
        a.member & b.mask != 0 && b.member & a.mask != 0
    };
    for strategy in STRATEGIES {
        let mut wanted = found(&scene, strategy, Finder::AllPairs, 3);
        let all: usize = wanted.iter().map(Vec::len).sum();
        wanted.iter_mut().for_each(|pairs| pairs.retain(may));
        let kept: usize = wanted.iter().map(Vec::len).sum();
        assert!(0 < kept && 4 * kept < 3 * all, "{kept} of {all} are kept");
        for &finder in Finder::ALL {
            for threads in [1, 3] {
                let settings = settings(strategy, finder);
                let culler = Culler::new(&scene.shapes, &scene.bodies, &settings, Level::detect());
                let mut culler = culler.unwrap().with_threads(threads).unwrap();
                culler.set_groups(Some(groups.clone()));
                let (mut rng, mut bodies) = (ChaCha8Rng::seed_from_u64(99), scene.bodies.clone());
                let mut found = Vec::new();
                for _ in 0..3 {
                    found.push(culler.cull(&bodies).sorted());
                    advance(&mut bodies, scene.step, &mut rng);
                }
                compare(&found, &wanted, &format!("{strategy}, {finder}, {threads}"));
            }
        }
    }
}

/// Enough bodies for threads to share updates and sorts too, which they don't for fewer.
#[test]
fn many_bodies_give_the_list_of_one_thread_on_any_number() {
    let scene = Scene::new("many", &[1.0], 40_000, |_, rng| uniform(rng, 96.0));
    for strategy in [Strategy::Sphere, Strategy::SDopSequential] {
        let settings = settings(strategy, Finder::Grid);
        let wanted = trace(&scene, &settings, Level::detect(), 1);
        assert!(wanted[2].0.len() > 10_000);
        for threads in [2, 3] {
            let found = trace(&scene, &settings, Level::detect(), threads);
            // Lists of this length are not worth printing.
            assert!(found == wanted, "{strategy}, {threads} threads");
        }
    }
}

#[test]
fn auto_is_one_of_the_others_in_list_and_count() {
    for (n, side, wanted) in [(60, 9.0, Finder::AllPairs), (400, 16.0, Finder::Grid)] {
        let scene = Scene::new("auto", &[1.0], n, |_, rng| uniform(rng, side));
        let [auto, named] = [Finder::Auto, wanted].map(|finder| {
            let settings = settings(Strategy::SDopSequential, finder);
            run(&scene, &settings, Level::detect(), 1, 1, |culler| {
                assert_eq!(culler.finder(), wanted);
            });
            trace(&scene, &settings, Level::detect(), 1)
        });
        assert_eq!(auto, named);
    }
}

#[test]
fn lists_and_counts_are_the_same_in_every_tier_and_on_every_number_of_threads() {
    for scene in hard_scenes()
        .iter()
        .filter(|scene| scene.bodies.shape.len() >= 300)
    {
        for finder in FINDERS {
            for strategy in STRATEGIES {
                let settings = settings(strategy, finder);
                let wanted = trace(scene, &settings, Level::SCALAR, 1);
                for level in Level::available() {
                    let found = trace(scene, &settings, level, 1);
                    assert!(
                        found == wanted,
                        "{}, {finder}, {strategy}, {level}",
                        scene.name
                    );
                }
                let found = trace(scene, &settings, Level::detect(), 3);
                assert!(
                    found == wanted,
                    "{}, {finder}, {strategy}, threads",
                    scene.name
                );
            }
        }
    }
}

#[test]
fn bodies_may_gather_and_part_over_many_frames() {
    // Everybody falls to the middle and flies apart again: levels are planned anew, places reordered.
    let mut scene = Scene::new("gathering", &[0.3, 1.0, 4.0], 400, |_, rng| {
        uniform(rng, 100.0).map(|x| x - 50.0)
    });
    scene.bodies.dynamic.fill(true);
    scene.bodies.dynamic[7] = false;
    let start = scene.bodies.translation.clone();
    let cullers = [Finder::AllPairs].iter().chain(&FINDERS).map(|&finder| {
        let settings = settings(Strategy::SDopSequential, finder);
        Culler::new(&scene.shapes, &scene.bodies, &settings, Level::detect()).unwrap()
    });
    let mut cullers: Vec<Culler> = cullers.collect();
    for frame in 0..120 {
        let nearness = 0.02 + (frame as f32 / 60.0 - 1.0).abs();
        for (body, (t, from)) in scene.bodies.translation.iter_mut().zip(&start).enumerate() {
            if body != 7 {
                *t = from.map(|x| x * nearness);
            }
        }
        let (first, rest) = cullers.split_first_mut().unwrap();
        let wanted = first.cull(&scene.bodies).sorted();
        for culler in rest {
            let found = culler.cull(&scene.bodies).sorted();
            compare(
                &[found],
                std::slice::from_ref(&wanted),
                &format!("frame {frame}"),
            );
        }
    }
}
