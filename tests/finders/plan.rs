//! Plans depend only on the bodies and stay as recorded: the number of candidates, their order,
//! bytes and parts. Counts show a change of speed here on any machine.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use sdop::bodies::Places;
use sdop::broad_phase::{PairFinder, Population, Volume};
use sdop::culler::Culler;
use sdop::settings::{Finder, Strategy};
use sdop::simd::Tier;
use sdop::threads::Threads;
use sdop_bench::hash::PairsHash;

use super::scenes::{Scene, hard_scenes, uniform};
use super::{advance, settings};

/// The recorded values, one line per scene and finder; a failing test prints its values.
const RECORDED: &str = include_str!("plan.txt");

/// More than any finder waits before it reorders places, or looks at its plan again. All pairs have
/// no plan.
fn frames(finder: Finder) -> usize {
    if finder == Finder::AllPairs { 2 } else { 40 }
}

/// The hard scenes, and some in which sizes, crowds and axes call for another plan while bodies
/// move.
fn scenes() -> Vec<Scene> {
    let mut scenes = hard_scenes();
    let wide: Vec<f32> = (0..12).map(|i| 0.02 * 2f32.powf(0.7 * i as f32)).collect();
    scenes.extend([
        Scene::new("gathering", &[0.3, 1.0, 4.0], 400, |_, rng| {
            uniform(rng, 100.0).map(|x| x - 50.0)
        }),
        Scene::new("turning", &[1.0], 300, |_, rng| {
            let [x, y, z] = uniform(rng, 60.0);
            [x, 0.5 * y, 0.25 * z]
        }),
        Scene::new("sizes in clusters", &wide, 900, |i, rng| {
            let by = uniform(rng, 2.0);
            [0, 1, 2].map(|axis| by[axis] + [900.0, -300.0, 70.0][axis] * (i % 6) as f32)
        }),
        Scene::new("levels in a plane", &[0.05, 0.4, 6.0], 700, |_, rng| {
            let [x, y, _] = uniform(rng, 30.0);
            [x, y, 2.0]
        }),
    ]);
    scenes
}

/// Where bodies are in a frame, apart from their own small steps.
fn shift(scene: &Scene, frame: usize, home: [f32; 3], now: [f32; 3]) -> [f32; 3] {
    match scene.name {
        "gathering" => home.map(|x| x * (0.02 + (frame as f32 / 20.0 - 1.0).abs())),
        "turning" => {
            let stretch = [1.0, 1.0 + 0.1 * frame as f32, 1.0 + 0.02 * (frame * frame) as f32];
            std::array::from_fn(|axis| home[axis] * stretch[axis])
        }
        _ => now,
    }
}

/// Candidates, bytes, and what of the order of lists a hash keeps, after some frames.
fn lived(scene: &Scene, finder: Finder) -> String {
    let mut culler = Culler::builder()
        .settings(&settings(Strategy::Sphere, finder))
        .build(&scene.shapes, &scene.bodies)
        .unwrap();
    let (mut bodies, mut rng) = (scene.bodies.clone(), ChaCha8Rng::seed_from_u64(3));
    let mut hash = PairsHash::default();
    for frame in 0..frames(finder) {
        advance(&mut bodies, scene.step, &mut rng);
        for (body, t) in bodies.translation.iter_mut().enumerate() {
            if bodies.dynamic[body] {
                *t = shift(scene, frame, scene.bodies.translation[body], *t);
            }
        }
        let pairs: Vec<[u32; 2]> = culler.cull(&bodies).unwrap().iter().collect();
        hash.frame(frame as u32, &pairs);
    }
    let (tests, bytes) = (culler.counters().sphere.tests, culler.finder_bytes());
    format!("{tests} candidates {bytes} bytes {}", &hash.finish()[..16])
}

/// Parts that the work of the first frame is cut into.
fn parts(scene: &Scene, finder: Finder) -> usize {
    let ball = |body: usize| {
        let [x, y, z] = scene.bodies.translation[body];
        [x, y, z, scene.shapes[scene.bodies.shape[body] as usize].ball.radius]
    };
    let mut places = Places::new(&scene.bodies);
    let population = Population {
        bodies: places.len(),
        radii: [1.0; 2],
        cheap_test: true,
        volume: Volume::Ball,
    };
    let balls =
        |places: &Places| -> Vec<_> { places.body.iter().map(|&b| ball(b as usize)).collect() };
    let (mut finder, mut order) = (PairFinder::new(finder, &population), Vec::new());
    finder.reorder(&places, &balls(&places), &places.body.clone(), &mut order);
    if !order.is_empty() {
        places.body = order;
    }
    let pool = Threads::default();
    finder.arrange(pool.executor(Tier::detect()), &places, &balls(&places), &places.body, None);
    finder.parts()
}

#[test]
fn plans_are_as_recorded() {
    let mut found = String::new();
    for scene in scenes() {
        for &finder in Finder::ALL.iter().filter(|finder| **finder != Finder::Auto) {
            let (parts, lived) = (parts(&scene, finder), lived(&scene, finder));
            found += &format!("{}, {finder}: {parts} parts {lived}\n", scene.name);
        }
    }
    let other = found.lines().zip(RECORDED.lines()).find(|(found, recorded)| found != recorded);
    assert!(found == RECORDED, "{other:?} is the first that differs of\n{found}");
}

/// Bodies that move are first, otherwise in the order of columns.
#[test]
fn plan_is_independent_of_order() {
    let scene = &hard_scenes()[3];
    let sorted = Places::new(&scene.bodies);
    let everyone: Vec<u32> = (0..scene.bodies.len() as u32).collect();
    assert!(!sorted.is_empty() && Places::new(&hard_scenes()[0].bodies).is_empty());
    let moves = |&body: &u32| scene.bodies.dynamic[body as usize];
    let (moving, fixed): (Vec<u32>, Vec<u32>) = everyone.iter().partition(|&body| moves(body));
    assert_eq!((sorted.moving, sorted.len()), (moving.len(), everyone.len()));
    assert_eq!(sorted.body, [moving, fixed].concat());
}
