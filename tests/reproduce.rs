//! The paper's experiments, small: counts and hashes that no CPU may change, and verdicts.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};

use sdop::settings::Strategy;
use sdop::simd::Tier;
use sdop_bench::cost::calibrate::Effort;
use sdop_bench::measure::turns::Regime;
use sdop_bench::measure::variant::Variant;
use sdop_bench::reproduce::check::Verdict;
use sdop_bench::reproduce::immediate::{Handing, PairLoop};
use sdop_bench::reproduce::readings::{Reading, cell, table};
use sdop_bench::reproduce::{
    ExperimentPlan, Experiments, PaperScene, Results, StrategyRun, claims, rates, run_scene, study,
};
use sdop_bench::scene::SceneFile;
use sdop_bench::sweep::Sweep as _;
use sdop_judge::contestant::Contestant;

fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes")
}

/// A few frames of the smallest scene and of the crowded one.
fn plan(seeds: u64, tier: Tier) -> ExperimentPlan {
    let effort = Effort { turns: 1, builds: 1 };
    let mut plan = ExperimentPlan::new(&scenes(), seeds, 5, effort, tier);
    plan.names = vec![PaperScene::Paper50, PaperScene::Crowded500];
    plan
}

/// Units travel as text: what is read is what was written, to the bit.
fn run(plan: &ExperimentPlan) -> Results {
    let experiments = Experiments::new(plan).unwrap();
    let header = experiments.header().unwrap();
    assert_eq!(header.units, 2 * plan.seeds.len());
    let mut results = Results::of_header(&header).unwrap();
    for unit in 0..header.units {
        let text = experiments.run(unit).unwrap();
        results.take(&text).unwrap();
        assert_eq!(serde_json::to_string(&results.units[unit]).unwrap(), text);
    }
    results
}

#[test]
fn counts_and_hashes_are_golden() {
    let results = run(&plan(1, Tier::detect()));
    let line = |run: &StrategyRun| {
        let [sphere, ordop] =
            [run.counters.sphere, run.counters.ordop].map(|v| [v.updates, v.tests, v.hits]);
        let hash = run.pairs_sha256.as_deref().map_or("-", |hash| &hash[..16]);
        format!(
            "{} {} {sphere:?} {ordop:?} {} {hash}\n",
            run.scene, run.strategy, run.counters.reported
        )
    };
    let lines: String = results.runs().map(line).collect();
    assert_eq!(lines, include_str!("golden/reproduce.txt"));
}

#[test]
fn every_tier_counts_the_same() {
    let scene = SceneFile::read(&scenes().join("paper-150.toml")).unwrap().build().unwrap();
    let of = |tier| {
        let runs = run_scene(&scene, Strategy::ALL.split_at(6).0, 6, tier).unwrap();
        runs.into_iter()
            .map(|run| (run.strategy, run.counters, run.pairs_sha256))
            .collect::<Vec<_>>()
    };
    let scalar = of(Tier::SCALAR);
    for tier in Tier::available() {
        assert_eq!(of(tier), scalar, "{tier}");
    }
}

/// The loops that test the claim of the paper's sequential algorithm report what the culler does,
/// whatever they wait for.
#[test]
fn pair_loops_match_the_culler() {
    let scene = SceneFile::read(&scenes().join("crowded-500.toml")).unwrap().build().unwrap();
    let variant = Variant::strategy(&scene.cull, Strategy::SDopSequential);
    let mut culling = variant.culling(&scene, Tier::detect()).unwrap();
    culling.frame(&scene.bodies);
    let sorted = |mut pairs: Vec<[u32; 2]>| {
        pairs.sort_unstable();
        pairs
    };
    let expected = sorted(culling.pairs());
    assert!(expected.len() > 1000);
    for &handing in Handing::ALL {
        let mut pair_loop = PairLoop::new(&scene, handing, Tier::detect());
        for _ in 0..2 {
            pair_loop.frame(&scene.bodies);
            assert_eq!(sorted(pair_loop.pairs()), expected, "{handing}");
        }
    }
}

/// Tables and verdicts follow from the runs.
#[test]
fn tables_follow_from_runs() {
    let results = run(&plan(3, Tier::detect()));
    assert_eq!(table(&results).len(), 2 * 4 * Reading::ALL.len());
    assert_eq!(rates::table(&results).len(), 2 * 6 * 2);
    for &regime in Regime::ALL {
        assert_eq!(results.costs(regime).len(), 2 * 5);
    }
    let crowded = cell(&results, "crowded-500", Strategy::Sphere, Reading::OwnTests);
    assert_eq!((crowded.bodies, crowded.paper), (500, None), "the paper's box is another");
    let small = cell(&results, "paper-50", Strategy::SDopBatch, Reading::TestsAndList);
    let whole = cell(&results, "paper-50", Strategy::SDopBatch, Reading::OwnTests);
    assert_eq!((small.paper, whole.measured.mean), (Some(16.88), 2.0 * small.measured.mean));
    for claim in claims::all(&results).iter().chain(&study::all(&results)) {
        assert!(!claim.checks.is_empty(), "{}", claim.claim);
    }
    // What counts alone decide.
    let verdict = |text: &str| {
        let all = claims::all(&results).into_iter().chain(study::all(&results));
        let mut found = all.filter(|claim| claim.claim.contains(text));
        found.next().map(|claim| claim.verdict())
    };
    assert_eq!(verdict("highest percentage in all experiments"), Some(Verdict::InPart));
    assert_eq!(verdict("or-DOP row contradicts"), Some(Verdict::Supported));
    assert_eq!(verdict("can't exceed the sphere row."), Some(Verdict::Supported));
}
