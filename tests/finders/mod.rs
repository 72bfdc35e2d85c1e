//! Every pair finder reports what all-pairs reports, on scenes made to be hard for it: the same
//! set, in every tier and on any number of threads the same list and the same counts.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod borders;
mod neighbours;
mod outside;
mod plan;
mod scenes;
mod sizes;
mod windows;

use crate::support;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sdop::bodies::Bodies;
use sdop::bodies::Groups;
use sdop::counters::Counters;
use sdop::culler::Culler;
use sdop::settings::{Budget, CullSettings, Finder, Interest, Strategy, ViewCone};
use sdop::simd::Tier;

use scenes::{Scene, hard_scenes, near_touching, unequal_near_touching, uniform};

/// Whatever a strategy needs: a cone that holds some bodies, and a budget that doesn't run out,
/// since what is refined before it does depends on the order of candidates.
fn settings(strategy: Strategy, pairs: Finder) -> CullSettings {
    let cone = ViewCone {
        body: None,
        apex: Some([-1.0, -2.0, 1.0]),
        direction: [1.0, 1.0, 1.0],
        half_angle: 30.0,
        range: None,
    };
    CullSettings {
        strategy,
        pairs,
        interest: Some(Interest::Cone(cone)),
        budget: Some(Budget::Tests(u64::MAX)),
        ..CullSettings::all_pairs()
    }
}

/// Culls some frames in which bodies move; `take` sees the culler after each.
fn run(
    scene: &Scene,
    settings: &CullSettings,
    tier: Tier,
    threads: usize,
    frames: usize,
    mut take: impl FnMut(&Culler),
) {
    let mut rng = ChaCha8Rng::seed_from_u64(99);
    let mut bodies = scene.bodies.clone();
    let mut culler = Culler::builder()
        .settings(settings)
        .tier(tier)
        .threads(threads)
        .worth_waking(0)
        .build(&scene.shapes, &bodies)
        .unwrap();
    for _ in 0..frames {
        culler.cull(&bodies).unwrap();
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
    run(scene, &settings(strategy, finder), Tier::detect(), 1, frames, |culler| {
        found.push(culler.pairs().sorted());
    });
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
        assert_eq!(found.len(), wanted.len(), "{what}, frame {frame}: reported twice");
    }
}

/// Every finder reports what all pairs reports.
#[test]
fn every_finder_matches_all_pairs() {
    for scene in hard_scenes() {
        for &strategy in Strategy::ALL {
            let wanted = found(&scene, strategy, Finder::AllPairs, 4);
            for &finder in Finder::ALL {
                let found = found(&scene, strategy, finder, 4);
                compare(&found, &wanted, &format!("{}, {strategy}, {finder}", scene.name));
            }
        }
    }
}

/// No finder loses a near touching pair.
#[test]
fn near_touching_pairs_are_found() {
    for seed in 0..30 {
        let (radius, offset) = [(1.0, 0.0), (0.77, -31.0), (1e-3, 0.25)][seed as usize % 3];
        let scene = near_touching(seed, radius, offset);
        let wanted = found(&scene, Strategy::Sphere, Finder::AllPairs, 1);
        assert!(wanted[0].len() > 300, "about half of them touch");
        let unequal = unequal_near_touching(seed);
        for &finder in Finder::ALL {
            let found = |scene| found(scene, Strategy::Sphere, finder, 1);
            compare(&found(&scene), &wanted, &format!("{finder}, seed {seed}"));
            let wanted = self::found(&unequal, Strategy::Sphere, Finder::AllPairs, 1);
            compare(&found(&unequal), &wanted, &format!("{finder}, unequal, seed {seed}"));
        }
    }
}

/// A ball just this side of a border between cells, and one that touches it from as far beyond as
/// can be: cells a hundred-thousandth too small put a whole cell between them.
#[test]
fn pairs_across_cells_are_found() {
    for axis in 0..3 {
        let mut scene = Scene::new("across a cell", &[1.0], 800, |_, _| [0.0; 3]);
        scene.bodies.dynamic.fill(true);
        let radius = scene.shapes[0].ball.radius;
        for (pair, centres) in scene.bodies.translation.chunks_exact_mut(2).enumerate() {
            // Half a cell from the lowest centre, less a few millionths of it.
            let at = radius * (1.0 - pair as f32 / (1 << 21) as f32);
            let place = |at: f32| {
                let mut centre = [at, 2.5 * (pair % 20) as f32, 2.5 * (pair / 20) as f32];
                centre.rotate_right(axis);
                centre
            };
            (centres[0], centres[1]) = (place(at), place(at + 2.0 * radius));
        }
        // The lowest.
        scene.bodies.translation[0] = [0.0; 3];
        let wanted = found(&scene, Strategy::Sphere, Finder::AllPairs, 1);
        assert_eq!(wanted[0].len(), 399);
        for &finder in Finder::ALL {
            let found = found(&scene, Strategy::Sphere, finder, 1);
            compare(&found, &wanted, &format!("across a cell, {finder}"));
        }
    }
}

/// Far clusters wrap the table of cells: rows of touching balls lie across its end in some of these
/// scenes, and so do the tiny ones that other levels look for.
#[test]
fn pairs_at_table_end_are_found() {
    for (seeds, rows, radii) in [(80, 20, vec![1.0]), (16, 70, vec![1.0, 0.1])] {
        for seed in 0..seeds {
            let tiny = 8 * (radii.len() - 1);
            let n = 3 * rows * (1 + tiny);
            let mut far = ChaCha8Rng::seed_from_u64(seed);
            let starts: [[f32; 3]; 3] = std::array::from_fn(|_| uniform(&mut far, 1e5));
            let mut scene = Scene::new("table's end", &radii, n, |i, rng| {
                // Two rows side by side, half a ball apart.
                let (k, second) = ((i / 6 % (rows / 2)) as f32, (i / 3 % 2) as f32);
                let along = [1.9 * k + 1.2 * second, 1.5 * second];
                let by = uniform(rng, if i < 3 * rows { 0.01 } else { 1.2 });
                let start = starts[i % 3];
                [start[0] + along[0] + by[0], start[1] + along[1] + by[1], start[2] + by[2]]
            });
            scene.bodies.dynamic.fill(true);
            for (i, shape) in scene.bodies.shape.iter_mut().enumerate() {
                *shape = u32::from(i >= 3 * rows);
            }
            let wanted = found(&scene, Strategy::Sphere, Finder::AllPairs, 2);
            assert!(2 * wanted[0].len() > n, "{} of {n}", wanted[0].len());
            let found = found(&scene, Strategy::Sphere, Finder::Grid, 2);
            compare(&found, &wanted, &format!("table's end, seed {seed}"));
        }
    }
}

/// Cells of far clusters share places in the table, so a giant that looked through more than three
/// of them each way would come upon some bodies twice.
#[test]
fn giants_meet_far_tiny_bodies() {
    let mut scene = Scene::new("giants in far clusters", &[0.02, 0.5], 12_000, |i, rng| {
        let (centre, by) = ([1e4, -3e4, 7e3], uniform(rng, 1.0));
        std::array::from_fn(|k| centre[k] * (i % 5) as f32 + by[k])
    });
    scene.bodies.shape.fill(0);
    scene.bodies.shape[..5].fill(1);
    let wanted = found(&scene, Strategy::Sphere, Finder::AllPairs, 2);
    assert!(wanted[0].len() > 5000, "{}", wanted[0].len());
    let found = found(&scene, Strategy::Sphere, Finder::Grid, 2);
    compare(&found, &wanted, scene.name);
}

/// What must not depend on tier or threads.
fn trace(
    scene: &Scene,
    settings: &CullSettings,
    tier: Tier,
    threads: usize,
) -> Vec<(Vec<[u32; 2]>, Counters)> {
    let mut trace = Vec::new();
    run(scene, settings, tier, threads, 3, |culler| {
        trace.push((culler.pairs().iter().collect(), *culler.counters()));
    });
    trace
}

/// Groups leave of every list the pairs that may collide.
#[test]
fn groups_filter_every_list() {
    let scene = Scene::new("groups", &[0.5, 1.0, 4.0], 500, |_, rng| uniform(rng, 22.0));
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    let mut bits = || rng.random_range(0..16u32) & rng.random_range(0..16u32);
    let groups: Vec<Groups> =
        (0..500).map(|_| Groups { member: bits(), mask: bits() | 1 }).collect();
    let may = |&[a, b]: &[u32; 2]| {
        let (a, b) = (groups[a as usize], groups[b as usize]);
        a.member & b.mask != 0 && b.member & a.mask != 0
    };
    for &strategy in Strategy::ALL {
        let mut wanted = found(&scene, strategy, Finder::AllPairs, 3);
        if strategy == Strategy::None {
            continue;
        }
        let all: usize = wanted.iter().map(Vec::len).sum();
        wanted.iter_mut().for_each(|pairs| pairs.retain(may));
        let kept: usize = wanted.iter().map(Vec::len).sum();
        assert!(0 < kept && 4 * kept < 3 * all, "{kept} of {all} are kept");
        for &finder in Finder::ALL {
            for threads in [1, 3] {
                let settings = settings(strategy, finder);
                let mut culler = Culler::builder()
                    .settings(&settings)
                    .threads(threads)
                    .worth_waking(0)
                    .build(&scene.shapes, &scene.bodies)
                    .unwrap();
                culler.set_groups(Some(groups.clone())).unwrap();
                let (mut rng, mut bodies) = (ChaCha8Rng::seed_from_u64(99), scene.bodies.clone());
                let mut found = Vec::new();
                for _ in 0..3 {
                    found.push(culler.cull(&bodies).unwrap().sorted());
                    advance(&mut bodies, scene.step, &mut rng);
                }
                compare(&found, &wanted, &format!("{strategy}, {finder}, {threads}"));
            }
        }
    }
}

/// Enough bodies for threads to share updates and sorts too, which they don't for fewer.
#[test]
fn threads_match_for_many_bodies() {
    let scene = Scene::new("many", &[1.0], 40_000, |_, rng| uniform(rng, 96.0));
    for strategy in [Strategy::Sphere, Strategy::SDopSequential] {
        let settings = settings(strategy, Finder::Grid);
        let wanted = trace(&scene, &settings, Tier::detect(), 1);
        assert!(wanted[2].0.len() > 10_000);
        for threads in [2, 3] {
            let found = trace(&scene, &settings, Tier::detect(), threads);
            // Lists of this length are not worth printing.
            assert!(found == wanted, "{strategy}, {threads} threads");
        }
    }
}

/// Auto is one of the others in list and count.
#[test]
fn auto_equals_its_choice() {
    for (n, side, wanted) in [(60, 9.0, Finder::AllPairs), (400, 16.0, Finder::Neighbours)] {
        let scene = Scene::new("auto", &[1.0], n, |_, rng| uniform(rng, side));
        let [auto, named] = [Finder::Auto, wanted].map(|finder| {
            let settings = settings(Strategy::SDopSequential, finder);
            run(&scene, &settings, Tier::detect(), 1, 1, |culler| {
                assert_eq!(culler.finder(), wanted);
            });
            trace(&scene, &settings, Tier::detect(), 1)
        });
        assert_eq!(auto, named);
    }
}

/// Lists and counts are the same in every tier and on every number of threads.
#[test]
fn tiers_and_threads_match() {
    for scene in hard_scenes().iter().filter(|scene| scene.bodies.shape.len() >= 300) {
        for &finder in Finder::ALL {
            for &strategy in Strategy::ALL {
                let settings = settings(strategy, finder);
                let wanted = trace(scene, &settings, Tier::SCALAR, 1);
                for tier in Tier::available() {
                    let found = trace(scene, &settings, tier, 1);
                    assert!(found == wanted, "{}, {finder}, {strategy}, {tier}", scene.name);
                }
                let found = trace(scene, &settings, Tier::detect(), 3);
                assert!(found == wanted, "{}, {finder}, {strategy}, threads", scene.name);
            }
        }
    }
}

/// Bodies may gather and part over many frames.
#[test]
fn gathering_bodies_lose_no_pair() {
    // Everybody falls to the middle and flies apart again: levels are planned anew, places
    // reordered.
    let mut scene = Scene::new("gathering", &[0.3, 1.0, 4.0], 400, |_, rng| {
        uniform(rng, 100.0).map(|x| x - 50.0)
    });
    scene.bodies.dynamic.fill(true);
    scene.bodies.dynamic[7] = false;
    let start = scene.bodies.translation.clone();
    let cullers = [Finder::AllPairs].iter().chain(Finder::ALL).map(|&finder| {
        let settings = settings(Strategy::SDopSequential, finder);
        Culler::builder().settings(&settings).build(&scene.shapes, &scene.bodies).unwrap()
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
        let wanted = first.cull(&scene.bodies).unwrap().sorted();
        for culler in rest {
            let found = culler.cull(&scene.bodies).unwrap().sorted();
            compare(&[found], std::slice::from_ref(&wanted), &format!("frame {frame}"));
        }
    }
}
