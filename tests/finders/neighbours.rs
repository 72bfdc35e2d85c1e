//! Neighbour lists: whatever bodies do between two lists, each frame's pairs are those of all
//! pairs, in every tier. The tests also check that lists are actually kept.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sdop::bodies::Bodies;
use sdop::culler::Culler;
use sdop::settings::{Finder, Strategy};
use sdop::simd::Tier;

use super::scenes::{Scene, uniform};
use super::{compare, settings};

/// The share of its radius by which a body may drift before the first list ends.
const FIRST_SKIN: f32 = 0.25;

fn culler(scene: &Scene, strategy: Strategy, finder: Finder, tier: Tier) -> Culler {
    Culler::builder()
        .settings(&settings(strategy, finder))
        .tier(tier)
        .build(&scene.shapes, &scene.bodies)
        .unwrap()
}

/// Culls the frames that `step` makes by neighbour lists in every tier, and by all pairs. Returns
/// how many pairs there were, and how many tests lists and the grid made.
fn judge(
    scene: &Scene,
    strategy: Strategy,
    frames: usize,
    what: &str,
    mut step: impl FnMut(usize, &mut Bodies),
) -> (usize, [u64; 2]) {
    let mut wanted = culler(scene, strategy, Finder::AllPairs, Tier::detect());
    let mut grid = culler(scene, strategy, Finder::Grid, Tier::detect());
    let of = |&tier: &Tier| culler(scene, strategy, Finder::Neighbours, tier);
    let mut lists: Vec<Culler> = Tier::available().iter().map(of).collect();
    let (mut bodies, mut pairs) = (scene.bodies.clone(), 0);
    for frame in 0..frames {
        step(frame, &mut bodies);
        let wanted = [wanted.cull(&bodies).unwrap().sorted()];
        pairs += wanted[0].len();
        grid.cull(&bodies).unwrap();
        for (tier, culler) in Tier::available().iter().zip(&mut lists) {
            let found = [culler.cull(&bodies).unwrap().sorted()];
            let what = format!("{what}, {strategy}, {tier}, frame {frame}");
            compare(&found, &wanted, &what);
        }
        let counts = lists.iter().map(|culler| *culler.counters());
        assert!(counts.clone().all(|other| other == *lists[0].counters()));
    }
    let tests = [&lists[0], &grid].map(|culler| {
        let counters = culler.counters();
        counters.sphere.tests + counters.aabb.tests + counters.ordop.tests
    });
    (pairs, tests)
}

/// Pairs of balls along x, each pair by itself, `apart` between their centres; R is what the finder
/// is given.
fn couples(apart: impl Fn(usize, f32) -> f32, fixed: bool) -> (Scene, f32) {
    let mut scene = Scene::new("couples", &[1.0], 600, |_, _| [0.0; 3]);
    let radius = scene.shapes[0].ball.radius * (1.0 + 8.0 * 0.5f32.powi(24)) + 0.5f32.powi(70);
    for (pair, centres) in scene.bodies.translation.chunks_exact_mut(2).enumerate() {
        let [y, z] = [pair % 20, pair / 20].map(|k| 4.0 * k as f32);
        centres[0] = [0.0, y, z];
        centres[1] = [apart(pair, radius), y, z];
    }
    for (body, dynamic) in scene.bodies.dynamic.iter_mut().enumerate() {
        *dynamic = body % 2 == 0 || !fixed;
    }
    (scene, radius)
}

/// Two bodies that a list doesn't hold, since they were just out of its reach, come together in one
/// frame: by their skins, by a unit in the last place less or more, by half more, and back again.
#[test]
fn skin_moves_lose_no_pair() {
    for fixed in [false, true] {
        let movers = if fixed { 1.0 } else { 2.0 };
        for share in [0.5, 0.9, 0.99, 1.0, 1.01, 1.5, 2.0, 8.0] {
            for nudge in [-1, 0, 1] {
                // A skin each, and a little more and less than that, beyond touching.
                let beyond = |pair: usize| 1.0 + (pair as f32 - 150.0) * 2e-6;
                let apart = |pair: usize, r: f32| 2.0 * r + movers * FIRST_SKIN * r * beyond(pair);
                let (scene, radius) = couples(apart, fixed);
                let by = f32::to_bits(share * FIRST_SKIN * radius).wrapping_add_signed(nudge);
                let by = f32::from_bits(by);
                let (pairs, _) = judge(&scene, Strategy::Sphere, 8, "couples", |frame, bodies| {
                    let home = scene.bodies.translation.iter();
                    for (body, (t, home)) in bodies.translation.iter_mut().zip(home).enumerate() {
                        let sign = [1.0, -1.0][body % 2];
                        let away = [0.0, 1.0, 0.0, -1.0, 1.0, 1.0, 0.0, 1.0][frame];
                        t[0] = home[0] + if bodies.dynamic[body] { sign * away * by } else { 0.0 };
                    }
                });
                assert!(share < 0.999 || pairs > 300, "{share}, {nudge}: {pairs}");
            }
        }
    }
}

/// Small balls next to wide ones come together as above, by a skin of the same length for both: one
/// of six, since a frame in which all move by half a small one's radius has ended the first list.
#[test]
fn common_length_moves_lose_nothing() {
    let mut scene = Scene::new("small beside wide", &[0.1, 1.0], 240, |_, _| [0.0; 3]);
    let balls = [0, 1].map(|shape| f64::from(scene.shapes[shape].ball.radius));
    let mean = |power| 0.5 * balls.iter().map(|r: &f64| r.powi(power)).sum::<f64>();
    let typical = (mean(3) + 3.0 * mean(1) * mean(2)) / (2.0 * (mean(2) + mean(1) * mean(1)));
    for (sixteenths, fixed) in (1..=6).flat_map(|k| [(k, false), (k, true)]) {
        let length = (typical * f64::from(sixteenths) / 16.0) as f32;
        let movers = if fixed { 1.0 } else { 2.0 };
        for (body, dynamic) in scene.bodies.dynamic.iter_mut().enumerate() {
            *dynamic = body % 2 == 0 || !fixed;
        }
        for share in [0.5, 0.9, 0.99, 1.0, 1.01, 1.5] {
            for (pair, centres) in scene.bodies.translation.chunks_exact_mut(2).enumerate() {
                let beyond = 1.0 + (pair as f32 - 60.0) * 2e-6;
                let [y, z] = [pair % 20, pair / 20].map(|k| 4.0 * k as f32);
                let apart = (balls[0] + balls[1]) as f32 + movers * length * beyond;
                (centres[0], centres[1]) = ([0.0, y, z], [apart, y, z]);
            }
            let what = format!("{}, {sixteenths}, {share}", scene.name);
            let (pairs, _) = judge(&scene, Strategy::Sphere, 8, &what, |frame, bodies| {
                let home = scene.bodies.translation.iter();
                for (body, (t, home)) in bodies.translation.iter_mut().zip(home).enumerate() {
                    if bodies.dynamic[body] {
                        let sign = [1.0, -1.0][body % 2];
                        let away = [0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 1.0, 0.0][frame];
                        let before = if frame < 2 { 0.05 } else { 0.0 };
                        t[0] = home[0] + sign * (away * share * length - before);
                    }
                }
            });
            assert!(share < 1.005 || pairs >= 240, "{what}: {pairs}");
        }
    }
}

/// Moves bodies on straight courses and turns them round now and then. `speed` is in units of the
/// radius that `pace` returns for the body's own, per frame.
fn fly(
    scene: &Scene,
    pace: impl Fn(f32) -> f32,
    speed: f32,
    seed: u64,
) -> impl FnMut(usize, &mut Bodies) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let paces: Vec<f32> = scene.shapes.iter().map(|s| pace(s.ball.radius)).collect();
    let course: Vec<[f32; 3]> = (0..scene.bodies.len())
        .map(|_| uniform(&mut rng, 2.0).map(|x| (x - 1.0) * speed))
        .collect();
    move |frame, bodies| {
        let sign = if frame / 12 % 2 == 0 { 1.0 } else { -1.0 };
        for body in 0..bodies.len() {
            let pace = paces[bodies.shape[body] as usize];
            for (x, by) in bodies.translation[body].iter_mut().zip(course[body]) {
                *x += if bodies.dynamic[body] { sign * pace * by } else { 0.0 };
            }
        }
    }
}

/// Lists are followed at any speed and lose nothing.
#[test]
fn any_speed_loses_no_pair() {
    let scenes = [
        Scene::new("uniform", &[1.0], 500, |_, rng| uniform(rng, 20.0)),
        Scene::new("radii 1:16", &[0.25, 1.0, 4.0], 300, |_, rng| uniform(rng, 30.0)),
        Scene::new("far off", &[0.7], 300, |_, rng| uniform(rng, 14.0).map(|x| x - 3e4)),
    ];
    for scene in &scenes {
        for strategy in
            [Strategy::Sphere, Strategy::Aabb, Strategy::SDopSequential, Strategy::OrDop]
        {
            for speed in [0.0, 0.003, 0.03, 0.3, 3.0] {
                let what = format!("{}, {speed} r a frame", scene.name);
                let fly = fly(scene, |radius| radius, speed, 5);
                let (pairs, [lists, grid]) = judge(scene, strategy, 40, &what, fly);
                assert!(pairs > 500, "{what}: {pairs} pairs");
                let slow = speed < 0.1 && scene.name == "uniform" && strategy == Strategy::Sphere;
                assert!(!slow || 2 * lists < grid, "{what}: {lists} tests, {grid} by the grid");
            }
        }
    }
}

/// All bodies are equally fast, so that a share of their radius wouldn't last for the small ones.
#[test]
fn fast_small_bodies_lose_nothing() {
    let scene = Scene::new("radii 1:16", &[0.25, 1.0, 4.0], 400, |_, rng| uniform(rng, 60.0));
    for strategy in [Strategy::Sphere, Strategy::Aabb, Strategy::OrDop] {
        for speed in [0.03, 0.1] {
            let what = format!("{speed} a frame");
            let fly = fly(&scene, |_| 1.0, speed, 5);
            let (pairs, [lists, grid]) = judge(&scene, strategy, 40, &what, fly);
            assert!(pairs > 1000, "{what}: {pairs} pairs");
            let is_followed = 2 * lists < grid || strategy != Strategy::Sphere;
            assert!(is_followed, "{what}: {lists} tests, {grid} by the grid");
        }
    }
}

/// A body that jumps or grows between two lists is found.
#[test]
fn jumping_or_growing_body_is_found() {
    let scene = Scene::new("jumps", &[1.0], 400, |_, rng| uniform(rng, 18.0));
    for seed in 0..4 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let step = |frame: usize, bodies: &mut Bodies| {
            // One body in every third frame, to anywhere; otherwise nobody moves.
            if frame.is_multiple_of(3) {
                let body = rng.random_range(0..400);
                if bodies.dynamic[body] {
                    bodies.translation[body] = uniform(&mut rng, 18.0);
                }
            }
        };
        judge(&scene, Strategy::SDopSequential, 40, "jumps", step);
    }
    // World-aligned boxes grow and shrink as their bodies turn.
    let mut rng = ChaCha8Rng::seed_from_u64(9);
    let turn = |_: usize, bodies: &mut Bodies| {
        for (q, &moves) in bodies.rotation.iter_mut().zip(&bodies.dynamic) {
            if moves {
                q[rng.random_range(0..4)] += rng.random_range(-0.05..0.05);
            }
        }
    };
    judge(&scene, Strategy::Aabb, 40, "turns", turn);
}
