//! The cost formula: its counts are equal in every tier and those that the finder's arithmetic
//! gives, and its prices come from scenes that it doesn't predict.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::num::NonZeroU32;
use std::path::Path;
use std::sync::LazyLock;

use sdop::counters::{RestCounters, pair_count};
use sdop::settings::Strategy;
use sdop::simd::Tier;
use sdop_bench::cost::PRICES;
use sdop_bench::cost::calibrate::{Calibration, Effort};
use sdop_bench::cost::design::scenes;
use sdop_bench::cost::pass::{Observer, SceneFrames, pass};
use sdop_bench::cost::table::cost;
use sdop_bench::cost::terms::Terms;
use sdop_bench::measure::counts::{Counts, Volume};
use sdop_bench::measure::culling::Culling;
use sdop_bench::measure::turns::Regime;
use sdop_bench::measure::variant::Variant;
use sdop_bench::scene::{Scene, SceneFile};
use sdop_judge::contestant::Contestant;

/// All but the time-critical one, which tests as much as its budget says.
static STRATEGIES: LazyLock<Vec<Strategy>> = LazyLock::new(|| {
    let all = Strategy::ALL.iter().copied();
    all.filter(|&strategy| strategy != Strategy::SDopTimeCritical).collect()
});
const FRAMES: u32 = 4;

fn scene() -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes/paper-150.toml");
    SceneFile::read(&path).unwrap().build().unwrap()
}

/// How many pairs each variant reports.
struct ReportCounter(Vec<u64>);

impl Observer for ReportCounter {
    fn frame(&mut self, number: usize, _: u32, culling: &Culling) {
        self.0[number] += culling.pairs().len() as u64;
    }
}

fn counters(scene: &Scene, tier: Tier) -> Vec<Counts> {
    let variant = |&strategy: &Strategy| Variant::strategy(&scene.cull, strategy);
    let variants: Vec<Variant> = STRATEGIES.iter().map(variant).collect();
    let mut reported = ReportCounter(vec![0; variants.len()]);
    let mut frames = SceneFrames::new(scene, FRAMES).unwrap();
    let pass = pass(scene, &variants, tier, &mut frames, None, &mut reported).unwrap();
    let counted: Vec<Counts> = pass.culled.iter().map(|culled| culled.counts).collect();
    assert!(pass.culled.iter().all(|culled| culled.frames == FRAMES));
    assert_eq!(reported.0, counted.iter().map(|c| c.culler.reported).collect::<Vec<_>>());
    counted
}

/// Counts follow the formula and are equal on every tier.
#[test]
fn counts_equal_in_tiers() {
    let scene = scene();
    let moving = scene.bodies.dynamic.iter().filter(|&&dynamic| dynamic).count() as u64;
    let all = scene.bodies.len() as u64;
    let pairs = u64::from(FRAMES) * pair_count(all, all - moving);
    let counted = counters(&scene, Tier::SCALAR);
    for (strategy, run) in STRATEGIES.iter().zip(&counted) {
        for &volume in Volume::ALL {
            let (volumes, own) = (Volume::of(*strategy), run.of(volume));
            if volumes.contains(&volume) {
                assert_eq!(own.updates, u64::from(FRAMES) * moving, "{strategy} {volume}");
            } else {
                assert_eq!(own, Default::default(), "{strategy} {volume}");
            }
            if volumes.first() == Some(&volume) {
                assert_eq!(own.tests, pairs, "{strategy} {volume}");
            }
        }
    }
    let by = |strategy| counted[STRATEGIES.iter().position(|&s| s == strategy).unwrap()];
    let (sequential, batch) = (by(Strategy::SDopSequential), by(Strategy::SDopBatch));
    assert_eq!(sequential, batch);
    assert_eq!(sequential.culler.ordop.tests, sequential.culler.sphere.hits);
    assert_eq!(by(Strategy::None), Counts::default());
    for tier in Tier::available() {
        assert_eq!(counters(&scene, tier), counted, "{tier}");
    }
}

/// The pairs that each variant reports, frame by frame.
#[derive(Default)]
struct PairRecorder(Vec<Vec<Vec<[u32; 2]>>>);

impl Observer for PairRecorder {
    fn frame(&mut self, number: usize, _: u32, culling: &Culling) {
        let mut pairs = culling.pairs();
        pairs.sort_unstable();
        self.0[number].push(pairs);
    }
}

/// A world reports the pairs of a culler, and each frame either queries or keeps each body.
#[test]
fn worlds_query_or_keep_each_body() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes/sleep-10k.toml");
    let mut file = SceneFile::read(&path).unwrap();
    for (group, count) in file.spec.bodies.iter_mut().zip([588, 12]) {
        *group.get_mut().count.as_mut().unwrap().get_mut() = NonZeroU32::new(count).unwrap();
    }
    let (scene, frames) = (file.build().unwrap(), 40);
    for tier in Tier::available() {
        for strategy in [Strategy::Sphere, Strategy::Aabb, Strategy::KDop, Strategy::SDopSequential]
        {
            let culler = Variant::strategy(&scene.cull, strategy);
            assert!(culler.may_be_in_world());
            let variants = [culler.clone(), culler.in_world()];
            let mut pairs = PairRecorder(vec![Vec::new(); 2]);
            let mut poses = SceneFrames::new(&scene, frames).unwrap();
            let pass = pass(&scene, &variants, tier, &mut poses, None, &mut pairs).unwrap();
            assert_eq!(pairs.0[0], pairs.0[1], "{strategy}, {tier}");
            let [culler, world] = [0, 1].map(|at| pass.culled[at].counts.culler);
            assert_eq!(culler.rest, RestCounters::default());
            let RestCounters { queried, thawed, kept } = world.rest;
            assert_eq!(queried + kept, u64::from(frames) * 600);
            // Twelve bodies move, and wake some others.
            assert!((39 * 12..39 * 37).contains(&queried), "{queried}");
            assert!((12..queried / 2).contains(&thawed), "{thawed}");
        }
    }
}

/// Calibration never sees the scene it predicts.
#[test]
fn calibration_is_independent_of_scene() {
    let scene = scene();
    let mut kinds = Vec::new();
    for calibration in scenes(&scene) {
        let placed = &calibration.bodies.translation;
        assert!(scene.bodies.translation.iter().all(|t| !placed.contains(t)));
        let half = 0.5 * calibration.side.unwrap();
        assert!(placed.iter().all(|t| t.iter().all(|x| x.abs() <= half)));
        kinds.push((calibration.bodies.len(), half.to_bits()));
    }
    let cases = kinds.len();
    kinds.sort_unstable();
    kinds.dedup();
    assert_eq!(kinds.len(), cases, "two calibration scenes are alike");
}

/// Prices belong to a kind of scene: what is peculiar to one must not enter.
#[test]
fn equal_kinds_share_calibration() {
    let mut other = scene();
    other.seed += 1;
    other.side = other.side.map(|side| 3.0 * side);
    other.bodies.translation.iter_mut().for_each(|t| t[0] += 1.0);
    for (one, other) in scenes(&scene()).zip(scenes(&other)) {
        assert_eq!(one.bodies.translation, other.bodies.translation);
        assert_eq!((one.seed, one.side), (other.seed, other.side));
    }
}

/// Calibration can separate prices: at one size only hits vary, and tests are not proportional to
/// bodies.
#[test]
fn calibration_varies_one_count() {
    let scene = scene();
    let mut by_size = std::collections::BTreeMap::new();
    for calibration in scenes(&scene) {
        let (tier, spheres) = (Tier::detect(), [Variant::spheres(&calibration.cull)]);
        let mut frames = SceneFrames::new(&calibration, FRAMES).unwrap();
        let passed = pass(&calibration, &spheres, tier, &mut frames, None, &mut ()).unwrap();
        let sphere = passed.culled[0].counts.culler.sphere;
        let all = by_size.entry(calibration.bodies.len()).or_insert_with(Vec::new);
        all.push(sphere);
    }
    assert!(by_size.len() >= 4);
    let mut tests_per_body = Vec::new();
    for (bodies, all) in &by_size {
        let first = all[0];
        let fixed = |of: &sdop::counters::VolumeCounters| (of.updates, of.tests);
        assert!(all.iter().all(|of| fixed(of) == fixed(&first)), "{bodies}");
        tests_per_body.push(first.tests as f64 / *bodies as f64);
        let hits: Vec<u64> = all.iter().map(|of| of.hits).collect();
        assert!(hits.is_sorted(), "{bodies}: {hits:?}");
        let [least, most] = [hits[0], hits[hits.len() - 1]];
        assert!(most > 20 * least.max(1), "{bodies}: {hits:?}");
    }
    let [fewest, .., most] = tests_per_body[..] else {
        panic!("one size");
    };
    assert!(most > 5.0 * fewest, "{tests_per_body:?}");
}

/// Every volume gets prices and terms that add up.
#[test]
fn prices_and_terms_add_up() {
    let scene = scene();
    let effort = Effort { turns: 1, builds: 1 };
    let strategies = STRATEGIES.iter().filter(|&&s| s != Strategy::None);
    let mut variants: Vec<Variant> =
        strategies.map(|&strategy| Variant::strategy(&scene.cull, strategy)).collect();
    variants.push(Variant::hulls(&scene.cull));
    let tier = Tier::detect();
    let mut calibration = Calibration::new(&scene, &variants, tier, effort).unwrap();
    let mut frames = SceneFrames::new(&scene, 17).unwrap();
    let passed =
        pass(&scene, &variants, tier, &mut frames, Some(calibration.round().unwrap()), &mut ())
            .unwrap();
    for (regime, prices) in Regime::ALL.iter().zip(&passed.prices) {
        assert_eq!(prices.len(), variants.len());
        for (at, (variant, prices)) in variants.iter().zip(prices).enumerate() {
            let named: Vec<Volume> = prices.volumes.iter().map(|p| p.volume).collect();
            assert_eq!(named, variant.volumes(), "{}", variant.name);
            for price in &prices.volumes {
                let costs = price.costs;
                let what = format!("{} {regime} {price:?}", variant.name);
                // So few frames may give the tests' time to the call; the stage has a price all the
                // same.
                let bodies = costs.body + costs.row;
                let stage = costs.frame + bodies + costs.handle + costs.hit + costs.miss;
                let tests = passed.culled[at].counts.of(price.volume).tests;
                let many = tests > 32 * u64::from(passed.culled[at].frames);
                assert!(stage > 0.0 || !many, "{what}");
                let all = PRICES.map(|kind| kind.value(costs));
                assert!(all.iter().all(|cost| (0.0..1.0).contains(cost)), "{what}");
            }
        }
        for of in variants.iter().enumerate() {
            let cost =
                cost((&scene.name, scene.bodies.len()), of, (&[&passed], &[&passed]), *regime)
                    .unwrap();
            let sum = cost.sum(Terms::recurring);
            let parts = cost.sum(|t| t.update) + cost.sum(|t| t.finding) + cost.sum(|t| t.test);
            assert!((sum / cost.frame.predicted.mean - 1.0).abs() < 1e-12);
            assert!((parts / sum - 1.0).abs() < 1e-12 && sum > 0.0);
            let total = cost.sum(|t| t.construct) + f64::from(cost.frames) * sum;
            assert!((total / cost.total.predicted.mean - 1.0).abs() < 1e-12);
            let residual = cost.frame.measured.mean / sum - 1.0;
            assert!((residual - cost.frame.residual.mean).abs() < 1e-9);
        }
    }
}
