//! The cost formula's counts: equal on every tier, as many as the finder's arithmetic says, and calibrated on other scenes
//! than it predicts.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;

use sdop::counters::{Counters, pair_count};
use sdop::lab::cost::calibrate::{Effort, calibrate, scenes};
use sdop::lab::cost::predict::Volume;
use sdop::lab::measure::turns::{Trial, side_by_side};
use sdop::lab::scene::{Scene, SceneFile};
use sdop::settings::Strategy;
use sdop::simd::Tier;

const STRATEGIES: [Strategy; 9] = [
    Strategy::None,
    Strategy::Sphere,
    Strategy::OrDop,
    Strategy::SDopSequential,
    Strategy::SDopBatch,
    Strategy::SDopObjectOfInterest,
    Strategy::Aabb,
    Strategy::KDop,
    Strategy::Obb,
];
const FRAMES: u32 = 4;

fn scene() -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes/paper-150.toml");
    SceneFile::read(&path).unwrap().build().unwrap()
}

fn counters(scene: &Scene, tier: Tier) -> Vec<Counters> {
    let trial = |&strategy: &Strategy| Trial::new(scene, strategy, tier).unwrap();
    let mut trials: Vec<Trial> = STRATEGIES.iter().map(trial).collect();
    let mut reported = vec![0; trials.len()];
    side_by_side(scene, &mut trials, FRAMES, |trial, _, pairs| {
        reported[trial] += pairs.len() as u64;
    })
    .unwrap();
    let counted: Vec<Counters> = trials.iter().map(|trial| *trial.counters()).collect();
    assert_eq!(
        reported,
        counted.iter().map(|c| c.reported).collect::<Vec<_>>()
    );
    counted
}

#[test]
fn counts_follow_the_formula_and_are_equal_on_every_tier() {
    let scene = scene();
    let moving = scene
        .bodies
        .dynamic
        .iter()
        .filter(|&&dynamic| dynamic)
        .count() as u64;
    let all = scene.bodies.len() as u64;
    let pairs = u64::from(FRAMES) * pair_count(all, all - moving);
    let counted = counters(&scene, Tier::SCALAR);
    for (strategy, run) in STRATEGIES.iter().zip(&counted) {
        for &volume in Volume::ALL {
            let (used, own) = (
                Volume::of(*strategy).contains(&volume),
                volume.counters(run),
            );
            let twin = matches!(volume, Volume::OrDop | Volume::Refined);
            if used {
                assert_eq!(
                    own.updates,
                    u64::from(FRAMES) * moving,
                    "{strategy} {volume}"
                );
            } else if !twin {
                assert_eq!(own, Default::default(), "{strategy} {volume}");
            }
            if used && volume != Volume::Refined {
                assert_eq!(own.tests, pairs, "{strategy} {volume}");
            }
        }
    }
    let by = |strategy| counted[STRATEGIES.iter().position(|&s| s == strategy).unwrap()];
    let (sequential, batch) = (by(Strategy::SDopSequential), by(Strategy::SDopBatch));
    assert_eq!(sequential, batch);
    assert_eq!(sequential.ordop.tests, sequential.sphere.hits);
    assert_eq!(by(Strategy::None), Counters::default());
    for tier in Tier::available() {
        assert_eq!(counters(&scene, tier), counted, "{tier}");
    }
}

#[test]
fn calibration_never_sees_the_scene_it_predicts() {
    let scene = scene();
    let mut sizes = Vec::new();
    for calibration in scenes(&scene) {
        let n = calibration.bodies.len();
        assert_ne!(n, scene.bodies.len());
        assert!(
            scene
                .bodies
                .translation
                .iter()
                .all(|t| !calibration.bodies.translation.contains(t))
        );
        let half = 0.5 * calibration.side.unwrap();
        let inside = |t: &[f32; 3]| t.iter().all(|x| x.abs() <= half);
        assert!(calibration.bodies.translation.iter().all(inside));
        sizes.push((n, calibration.side.unwrap().to_bits()));
    }
    let cases = sizes.len();
    sizes.sort_unstable();
    sizes.dedup();
    assert_eq!(sizes.len(), cases, "two calibration scenes are alike");
}

#[test]
fn every_volume_gets_prices() {
    let effort = Effort {
        frames: 4,
        builds: 1,
    };
    let mut heard = Vec::new();
    let prices = calibrate(&scene(), &STRATEGIES, Tier::detect(), effort, |done| {
        heard.push(done)
    })
    .unwrap();
    assert_eq!(heard, (1..=scenes(&scene()).len()).collect::<Vec<_>>());
    assert_eq!(
        prices
            .0
            .iter()
            .map(|price| price.volume)
            .collect::<Vec<_>>(),
        Volume::ALL
    );
    for price in &prices.0 {
        let costs = price.costs;
        assert!(costs.construct > 0.0 && costs.update > 0.0, "{price:?}");
        assert!(costs.hit + costs.miss > 0.0, "{price:?}");
        let all = [
            costs.construct,
            costs.update,
            costs.frame,
            costs.body,
            costs.hit,
            costs.miss,
        ];
        assert!(
            all.iter().all(|cost| (0.0..1.0).contains(cost)),
            "{price:?}"
        );
    }
}
