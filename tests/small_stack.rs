//! Everything that culls fits into a thread's stack of 2 MB. Without optimisation, each vector of
//! an inlined function has a separate place on the stack, which once took 10 MB.
//!
//! `.ci/run` also runs this test with a library that isn't optimised. It uses only `sdop` itself,
//! so that nothing else has to be compiled for that.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::thread;

use sdop::settings::{Budget, CullSettings, Finder, Interest, Overlap, Strategy, Updates};
use sdop::volume::{DirectionSet, ShapeSpec};
use sdop::{Bodies, Body, Culler, ProceduralShape, Shape, Tier, World};

/// Bytes: what a thread of Rust has unless it asks for more.
const STACK: usize = 2 << 20;

fn on_a_small_stack(run: impl FnOnce() + Send + 'static) {
    let thread = thread::Builder::new().stack_size(STACK).spawn(run);
    thread.unwrap().join().unwrap();
}

/// Needles on a grid, turned in different ways, so that balls meet whose or-DOPs don't.
fn needles(k: DirectionSet) -> ([Shape; 1], Bodies) {
    let needle = ProceduralShape::Needle { length: 4.0, radius: 0.25, sides: 8 };
    let spec = ShapeSpec { directions: k, ..ShapeSpec::default() };
    let mut bodies = Bodies::default();
    for i in 0..64_u8 {
        let [x, y, z] = [i % 4, i / 4 % 4, i / 16].map(f32::from);
        bodies.push(0, i % 7 > 0, [x - y, y + 0.5, z - x, 1.0], [x, y, z]);
    }
    ([Shape::build(&needle.build().unwrap(), &spec).unwrap()], bodies)
}

/// Every strategy with each of its overlap tests.
fn strategies(k: DirectionSet) -> Vec<CullSettings> {
    let mut all = Vec::new();
    for &strategy in Strategy::ALL {
        let overlaps = Overlap::ALL.iter();
        let tests = if strategy.scheme().has_overlap_test() { 3 } else { 1 };
        for &overlap in overlaps.take(tests) {
            all.push(CullSettings {
                strategy,
                overlap,
                k,
                interest: Some(Interest::Bodies(vec![3, 20])),
                budget: Some(Budget::Tests(100)),
                ..CullSettings::default()
            });
        }
    }
    all
}

/// Every strategy culls in every tier, with any updates, and by more threads, and reports the same
/// pairs.
#[test]
fn strategies_fit_the_stack() {
    on_a_small_stack(|| {
        for &k in DirectionSet::ALL {
            let (shapes, bodies) = needles(k);
            for settings in strategies(k) {
                let mut lists = Vec::new();
                for tier in Tier::available() {
                    for (&updates, threads) in Updates::ALL.iter().zip([1, 3]) {
                        let culler = Culler::builder().settings(&settings).updates(updates);
                        let culler = culler.tier(tier).threads(threads).worth_waking(0);
                        let mut culler = culler.build(&shapes, &bodies).unwrap();
                        lists.push(culler.cull(&bodies).unwrap().sorted());
                    }
                }
                let strategy = settings.strategy;
                assert_eq!(lists[0].is_empty(), strategy == Strategy::None, "{strategy}");
                assert!(lists.iter().all(|list| *list == lists[0]), "{strategy}");
            }
        }
    });
}

/// Every finder finds the pairs of S-DOP in every tier.
#[test]
fn finders_fit_the_stack() {
    on_a_small_stack(|| {
        let (shapes, bodies) = needles(DirectionSet::K26);
        let mut lists = Vec::new();
        for tier in Tier::available() {
            for &finder in Finder::ALL {
                let culler = Culler::builder().finder(finder).k(DirectionSet::K26);
                let mut culler = culler.tier(tier).build(&shapes, &bodies).unwrap();
                for _ in 0..2 {
                    lists.push(culler.cull(&bodies).unwrap().sorted());
                }
            }
        }
        assert!(!lists[0].is_empty() && lists.iter().all(|list| *list == lists[0]));
    });
}

/// So does a world, whose bodies come, move and go.
#[test]
fn world_fits_the_stack() {
    on_a_small_stack(|| {
        let (shapes, bodies) = needles(DirectionSet::K18);
        let mut world = World::new(shapes.into()).unwrap();
        let at = |i: usize| Body::at(0, bodies.rotation[i], bodies.translation[i].map(f64::from));
        let ids: Vec<_> = (0..bodies.len()).map(|i| world.insert(at(i)).unwrap()).collect();
        world.cull().unwrap();
        let before = world.pairs().len();
        world.remove(ids[21]).unwrap();
        world.set_pose(ids[0], bodies.rotation[1], [100.0; 3]).unwrap();
        world.cull().unwrap();
        assert!(world.pairs().len() < before);
    });
}
