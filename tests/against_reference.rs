//! The optimised culler against the plain reference: it reports every pair that the reference
//! predicate reports, in every tier the same list.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::support;
use std::collections::BTreeSet;

use sdop::bodies::Bodies;
use sdop::culler::Culler;
use sdop::pairs::PairList;
use sdop::settings::{Axes, Budget, CullSettings, Flow, Interest, Overlap, Strategy, Updates};
use sdop::simd::Tier;
use sdop::volume::DirectionSet;
use sdop_judge::truth::{Shapes, reference_shapes};
use sdop_reference as reference;
use support::{random_bodies, shapes};

/// A frame as both sides take it.
struct Frame {
    shapes: Shapes,
    bodies: Bodies,
}

fn frame(seed: u64, k: DirectionSet, axes: Axes) -> Frame {
    let shapes = shapes(k, axes);
    Frame {
        bodies: random_bodies(seed, 120, 7.0, shapes.len()),
        shapes: Shapes::new(shapes).unwrap(),
    }
}

fn settings(strategy: Strategy, k: DirectionSet, overlap: Overlap) -> CullSettings {
    CullSettings {
        strategy,
        k,
        overlap,
        interest: Some(Interest::Bodies(vec![1, 5, 8])),
        // What a budget leaves untested is reported on top.
        budget: Some(Budget::Tests(u64::MAX)),
        ..CullSettings::all_pairs()
    }
}

fn cull(frame: &Frame, settings: &CullSettings, tier: Tier) -> PairList {
    let mut culler = Culler::builder()
        .settings(settings)
        .tier(tier)
        .build(&frame.shapes.built, &frame.bodies)
        .unwrap();
    culler.cull(&frame.bodies).unwrap().clone()
}

fn judge(frame: &Frame, settings: &CullSettings) -> Vec<[u32; 2]> {
    let bodies = frame.shapes.bodies(&frame.bodies).unwrap();
    let interest: Vec<bool> = (0..bodies.len()).map(|i| [1, 5, 8].contains(&i)).collect();
    let strategy = match settings.strategy {
        Strategy::Sphere => reference::Strategy::Sphere,
        Strategy::OrDop => reference::Strategy::OrDop,
        Strategy::SDopSequential | Strategy::SDopTimeCritical => reference::Strategy::Sequential,
        Strategy::SDopBatch => reference::Strategy::Batch,
        Strategy::SDopObjectOfInterest => reference::Strategy::ObjectOfInterest(&interest),
        Strategy::Aabb => reference::Strategy::Aabb,
        Strategy::KDop => reference::Strategy::KDop(reference_shapes::directions(settings.k)),
        Strategy::Obb => reference::Strategy::Obb,
        Strategy::None => reference::Strategy::None,
    };
    let pairs = reference::pairs(&bodies, strategy, reference_shapes::overlap(settings.overlap));
    pairs.into_iter().map(|(i, j)| [i, j]).collect()
}

/// No strategy misses a pair of the reference.
#[test]
fn no_strategy_misses_a_pair() {
    let mut report = String::new();
    for &k in DirectionSet::ALL {
        for &axes in Axes::ALL {
            let frame = frame(7, k, axes);
            for &overlap in Overlap::ALL {
                for &strategy in Strategy::ALL {
                    let settings = settings(strategy, k, overlap);
                    let found = cull(&frame, &settings, Tier::detect()).sorted();
                    let wanted = judge(&frame, &settings);
                    let missed: Vec<_> =
                        wanted.iter().filter(|pair| found.binary_search(pair).is_err()).collect();
                    report += &format!(
                        "{strategy} k={k} {axes} {overlap}: {} of {}, missed {}\n",
                        found.len(),
                        wanted.len(),
                        missed.len()
                    );
                    assert!(missed.is_empty(), "{strategy} k={k} {axes} {overlap}: {missed:?}");
                }
            }
        }
    }
    println!("{report}");
}

#[test]
fn every_tier_reports_the_same_list() {
    for &k in DirectionSet::ALL {
        let frame = frame(11, k, Axes::Principal);
        for &overlap in Overlap::ALL {
            for &strategy in Strategy::ALL {
                let settings = settings(strategy, k, overlap);
                let scalar: Vec<_> = cull(&frame, &settings, Tier::SCALAR).iter().collect();
                for tier in Tier::available() {
                    let list: Vec<_> = cull(&frame, &settings, tier).iter().collect();
                    assert_eq!(list, scalar, "{tier} {strategy} k={k} {overlap}");
                }
            }
        }
    }
}

/// Few shapes' slabs are looked up, those of many are loaded as rows.
#[test]
fn shape_count_changes_no_list() {
    for &k in DirectionSet::ALL {
        let few = frame(13, k, Axes::Principal);
        let once = &few.shapes.built;
        let (n, twice) = (once.len(), [once.as_slice(), once].concat());
        assert!(n <= 16 && twice.len() > 16);
        let mut bodies = few.bodies.clone();
        for shape in bodies.shape.iter_mut().step_by(2) {
            *shape += n as u32;
        }
        let shapes = Shapes::new(twice).unwrap();
        let many = Frame { shapes, bodies };
        for &overlap in Overlap::ALL {
            let settings = settings(Strategy::SDopBatch, k, overlap);
            for tier in Tier::available() {
                let lists = [&few, &many].map(|frame| cull(frame, &settings, tier).sorted());
                assert_eq!(lists[0], lists[1], "{tier} k={k} {overlap}");
                assert!(!lists[0].is_empty());
            }
        }
    }
}

#[test]
fn strategies_relate_as_the_paper_says() {
    for seed in 0..4 {
        let frame = frame(seed, DirectionSet::K18, Axes::Principal);
        let run = |strategy| {
            let settings = settings(strategy, DirectionSet::K18, Overlap::TwoSided);
            cull(&frame, &settings, Tier::detect()).sorted()
        };
        let (sphere, ordop) = (run(Strategy::Sphere), run(Strategy::OrDop));
        let both: Vec<_> =
            sphere.iter().filter(|pair| ordop.binary_search(pair).is_ok()).copied().collect();
        let sequential = run(Strategy::SDopSequential);
        assert_eq!(sequential, both, "S-DOP is sphere and or-DOP");
        assert_eq!(run(Strategy::SDopBatch), sequential);
        let looked_at = run(Strategy::SDopObjectOfInterest);
        assert!(sequential.iter().all(|pair| looked_at.binary_search(pair).is_ok()));
        assert!(looked_at.len() > sequential.len() && looked_at.len() < sphere.len());
        assert_eq!(run(Strategy::None), Vec::<[u32; 2]>::new());
    }
}

/// Lazy updates change the count of updates and nothing else.
#[test]
fn lazy_updates_only_change_counts() {
    let frame = frame(3, DirectionSet::K18, Axes::Principal);
    for &strategy in Strategy::ALL.iter().filter(|strategy| strategy.scheme().has_overlap_test()) {
        let eager = settings(strategy, DirectionSet::K18, Overlap::TwoSided);
        let lazy = CullSettings { updates: Updates::Lazy, ..eager.clone() };
        let mut cullers = [eager, lazy].map(|settings| {
            Culler::builder().settings(&settings).build(&frame.shapes.built, &frame.bodies).unwrap()
        });
        let mut tested = 0;
        for _ in 0..2 {
            let [eager, lazy] =
                cullers.each_mut().map(|culler| culler.cull(&frame.bodies).unwrap().sorted());
            assert_eq!(eager, lazy);
            let bodies = cullers[1].potentially_colliding().flatten();
            let moving = bodies.filter(|&body| frame.bodies.dynamic[body as usize]);
            tested += moving.collect::<BTreeSet<_>>().len() as u64;
        }
        let [eager, lazy] = cullers.each_ref().map(|culler| culler.counters().ordop);
        assert_eq!(eager.updates, 2 * 108);
        assert!(lazy.updates <= eager.updates);
        if matches!(strategy.scheme().flow, Flow::Sequential | Flow::Batch) {
            assert_eq!(lazy.updates, tested, "{strategy}: once for each moving body of a pair");
        }
        assert_eq!((eager.tests, eager.hits), (lazy.tests, lazy.hits));
    }
}
