//! Golden pair lists: reported pairs and counts are equal to the bit on every CPU, in every SIMD
//! tier and build.
//!
//! The hashes were recorded once and change only with the volumes, the trajectories or the deciding
//! arithmetic. Run this test's binary under an emulated CPU to see it: `qemu-x86_64 -cpu Nehalem
//! target/debug/deps/golden_pairs-…`.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;

use sdop::settings::{Budget, Overlap, Strategy, Updates};
use sdop::simd::Tier;
use sdop::volume::DirectionSet;
use sdop_bench::scene::{Scene, SceneFile};
use sdop_bench::simulate::{self, SimulationError};

fn scene(name: &str, frames: u32, k: DirectionSet) -> Scene {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes");
    let mut file = SceneFile::read(&directory.join(name)).unwrap();
    file.spec.cull.k = k;
    let mut scene = file.build().unwrap();
    scene.frames = frames;
    scene
}

fn summary(scene: &Scene, tier: Tier) -> simulate::Summary {
    simulate::run(scene, tier, |_| -> Result<(), SimulationError> { Ok(()) }).unwrap()
}

#[test]
fn every_strategy_reports_what_was_recorded() {
    let mut scene = scene("paper-150.toml", 10, DirectionSet::K18);
    scene.cull.budget = Some(Budget::Tests(40));
    // Nothing is culled by the control, and there is nothing to record.
    for &strategy in Strategy::ALL.iter().filter(|s| **s != Strategy::None) {
        let recorded = STRATEGIES.iter().find(|row| row.0 == strategy);
        let &(_, reported, golden) = recorded.expect("a strategy: record its list in STRATEGIES");
        scene.cull.strategy = strategy;
        for tier in Tier::available() {
            let summary = summary(&scene, tier);
            let hash = summary.pairs_sha256.as_deref().unwrap();
            let seen = (summary.counters.reported, &hash[..16]);
            assert_eq!(seen, (reported, golden), "{strategy} in {tier}");
        }
    }
}

/// Every ordop test reports what was recorded.
#[test]
fn every_ordop_test_matches_record() {
    for k in DirectionSet::ALL {
        let recorded = OVERLAPS.iter().any(|row| row.0 == *k);
        assert!(recorded, "k = {k}: record its list in OVERLAPS");
    }
    for overlap in Overlap::ALL {
        let recorded = OVERLAPS.iter().any(|row| row.1 == *overlap);
        assert!(recorded, "{overlap}: record its list in OVERLAPS");
    }
    for (k, overlap, reported, golden) in OVERLAPS {
        let mut scene = scene("crowded-500.toml", 2, k);
        scene.cull.overlap = overlap;
        for &updates in Updates::ALL {
            scene.cull.updates = updates;
            for tier in Tier::available() {
                let summary = summary(&scene, tier);
                let hash = summary.pairs_sha256.as_deref().unwrap();
                let seen = (summary.counters.reported, &hash[..16]);
                assert_eq!(seen, (reported, golden), "{k} {overlap} {updates} in {tier}");
            }
        }
    }
}

/// A choice that is added gets a golden value.
#[test]
fn every_choice_has_golden_pairs() {
    let culling = Strategy::ALL.iter().copied();
    let culling: Vec<_> = culling.filter(|strategy| strategy.scheme().culls()).collect();
    assert_eq!(STRATEGIES.map(|(strategy, ..)| strategy)[..], culling);
    for k in DirectionSet::ALL {
        assert!(OVERLAPS.iter().any(|row| row.0 == *k), "{k}");
    }
    for overlap in Overlap::ALL {
        assert!(OVERLAPS.iter().any(|row| row.1 == *overlap), "{overlap}");
    }
}

const STRATEGIES: [(Strategy, u64, &str); 9] = [
    (Strategy::Sphere, 1070, "69a1e008ec8579de"),
    (Strategy::OrDop, 501, "1b67adbe6c474c43"),
    (Strategy::SDopSequential, 499, "b1e6dabf5d1679d0"),
    (Strategy::SDopBatch, 499, "b1e6dabf5d1679d0"),
    (Strategy::SDopObjectOfInterest, 1061, "903743471b915974"),
    (Strategy::SDopTimeCritical, 907, "a4d0b61d69dddfc9"),
    (Strategy::Aabb, 704, "691b0579b30272f6"),
    (Strategy::KDop, 461, "004531c86eef400a"),
    (Strategy::Obb, 945, "d69303b5ddbbdf9c"),
];

const OVERLAPS: [(DirectionSet, Overlap, u64, &str); 6] = [
    (DirectionSet::K6, Overlap::TwoSided, 9343, "d92b73219a646484"),
    (DirectionSet::K14, Overlap::TwoSided, 6683, "6f75b5c98b07fb7e"),
    (DirectionSet::K18, Overlap::OneSided, 6406, "49f468aed7c60fd9"),
    (DirectionSet::K18, Overlap::TwoSided, 5874, "d97f9551bfb7fc31"),
    (DirectionSet::K18, Overlap::Full, 5721, "67db780da2b14ab0"),
    (DirectionSet::K26, Overlap::TwoSided, 5402, "4b9db0b9168cb392"),
];
