//! The corpus of hard cases: recorded answers, every way to cull on every tier, and its own
//! completeness.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeSet;
use std::path::Path;

use rayon::prelude::*;
use sdop::mesh::ReadOptions;
use sdop::settings::{CullSettings, Finder, Overlap, Strategy};
use sdop::simd::Tier;
use sdop::volume::{Axes, DirectionSet};
use sdop_judge::configuration::coverage::Cell;
use sdop_judge::configuration::cullers::{culler, settings};
use sdop_judge::configuration::{Mode, Rotation, variants, ways};
use sdop_judge::draw::hard::{
    FILES, HardCaseError, HardCaseGroup, HardCases, naive_misses, page, spell, variant_name,
};
use sdop_judge::truth::{Answers, Predicate};
use sdop_judge::verify::rounds::group;
use sdop_judge::verify::{Ledger, Run};

type OrDopChoice = (DirectionSet, Axes);

/// Every group for every or-DOP, with its exact answers.
fn for_all(test: impl Fn(&str, &HardCaseGroup, OrDopChoice, &HardCases, &[Vec<Answers>]) + Sync) {
    let jobs: Vec<_> =
        FILES.iter().flat_map(|file| variants().map(move |variant| (file, variant))).collect();
    jobs.par_iter().for_each(|((name, text), variant)| {
        let group = HardCaseGroup::parse(text).unwrap();
        let cases = group.cases(variant.0, variant.1).unwrap();
        let answers = group.judge(&cases, variant.0).unwrap();
        test(name, &group, *variant, &cases, &answers);
    });
}

/// No way to cull misses a pair on the scalar tier and kernels agree on all.
#[test]
fn hard_cases_are_never_missed() {
    let faster = Tier::available().into_iter().filter(|tier| *tier != Tier::SCALAR);
    let faster: Vec<Tier> = faster.collect();
    for_all(|name, group, (k, axes), cases, answers| {
        let recorded = group.answers.get(&variant_name(k, axes));
        assert_eq!(recorded, Some(&spell(answers)), "{name}: the recorded answers");
        known_by_construction(name, group, cases, answers);
        for (frames, answers) in cases.runs.iter().zip(answers) {
            let shapes = &cases.shapes;
            let run = Run { shapes, frames, answers };
            let mut ledger = Ledger::default();
            // Flush-to-zero decides otherwise here and there, but never misses.
            for tier in [Tier::SCALAR, Tier::SCALAR_FLUSH] {
                run.check((k, axes), &[Mode::plain(tier)], &mut ledger).unwrap();
            }
            let failure = ledger.failures.first();
            let failure = failure.map(|f| (&f.settings, f.mode, f.pair, f.missed));
            assert!(failure.is_none(), "{name}: {failure:?}");
            for way in ways(k, axes) {
                let scalar = lists(cases, frames, &way, Mode::plain(Tier::SCALAR));
                for &tier in &faster {
                    assert_eq!(
                        lists(cases, frames, &way, Mode::plain(tier)),
                        scalar,
                        "{name}: {way:?} on {tier}"
                    );
                }
            }
        }
    });
}

/// The lists of a run in list order, and its counters.
fn lists(
    cases: &HardCases,
    frames: &[sdop::bodies::Bodies],
    way: &CullSettings,
    mode: Mode,
) -> (Vec<Vec<[u32; 2]>>, sdop::counters::Counters) {
    let settings = settings(way.strategy, way, frames[0].len());
    let mut culler = culler(&settings, mode).build(&cases.shapes.built, &frames[0]).unwrap();
    let lists = frames.iter().map(|frame| culler.cull(frame).unwrap().iter().collect()).collect();
    (lists, *culler.counters())
}

#[test]
fn more_threads_report_the_same_lists() {
    for (name, text) in FILES {
        if !["counts", "duplicates", "teleports"].contains(name) {
            continue;
        }
        let (k, axes) = (DirectionSet::K18, Axes::Principal);
        let cases = HardCaseGroup::parse(text).unwrap().cases(k, axes).unwrap();
        for way in ways(k, axes) {
            for frames in &cases.runs {
                let alone = Mode::plain(Tier::detect());
                let shared = Mode { threads: 3, ..alone };
                assert_eq!(
                    lists(&cases, frames, &way, shared),
                    lists(&cases, frames, &way, alone),
                    "{name}: {way:?}"
                );
            }
        }
    }
}

/// What integer arithmetic says of a recipe needs no reference.
fn known_by_construction(
    name: &str,
    group: &HardCaseGroup,
    cases: &HardCases,
    answers: &[Vec<Answers>],
) {
    for known in &group.known {
        assert_eq!(known, Predicate::Sphere.name(), "{name}");
        for (frame, answers) in cases.runs.iter().flatten().zip(answers.iter().flatten()) {
            for (&[i, j], &touch) in answers.pairs.iter().zip(answers.of(Predicate::Sphere)) {
                let [i, j] = [i, j].map(|body| body as usize);
                let d2: i128 = (0..3)
                    .map(|axis| {
                        (frame.translation[i][axis] as i128 - frame.translation[j][axis] as i128)
                            .pow(2)
                    })
                    .sum();
                let radius = |body: usize| {
                    cases.shapes.built[frame.shape[body] as usize].ball.radius as i128
                };
                assert_eq!(d2, (radius(i) + radius(j)).pow(2), "{name}: an exact touch");
                assert!(touch, "{name}: the reference denies an exact touch");
            }
        }
    }
}

/// Every group defeats a naive test and the page says so.
#[test]
fn every_group_defeats_naive_tests() {
    let naive: Vec<_> = FILES
        .par_iter()
        .map(|(name, text)| {
            (name, naive_misses(&HardCaseGroup::parse(text).unwrap()).unwrap().0.total())
        })
        .collect();
    let toothless: Vec<_> = naive.iter().filter(|(_, misses)| *misses == 0).collect();
    assert!(toothless.is_empty(), "naive f32 misses nothing in {toothless:?}");
    let recorded = std::fs::read_to_string("data/hard_cases/README.md").unwrap();
    assert_eq!(recorded, page(FILES.iter().copied()).unwrap());
}

/// Every file is a group and every group has its answers.
#[test]
fn every_group_has_its_answers() {
    let mut files: BTreeSet<String> = BTreeSet::new();
    for entry in std::fs::read_dir("data/hard_cases").unwrap() {
        let path = entry.unwrap().path();
        if path.extension() == Some("toml".as_ref()) && path.file_stem() != Some("refused".as_ref())
        {
            files.insert(path.file_stem().unwrap().to_string_lossy().into_owned());
        }
    }
    let listed: BTreeSet<String> = FILES.iter().map(|(name, _)| (*name).to_owned()).collect();
    assert_eq!(files, listed);
    for (name, text) in FILES {
        let group = HardCaseGroup::parse(text).unwrap();
        let expected: BTreeSet<String> =
            variants().map(|(k, axes)| variant_name(k, axes)).collect();
        assert_eq!(group.answers.keys().cloned().collect::<BTreeSet<_>>(), expected, "{name}");
        assert!(!group.why.is_empty(), "{name}");
    }
}

/// What `sdop verify` does first, on as many tiers as any CPU has: whatever else it is asked for,
/// no cell stays empty.
#[test]
fn hard_cases_fill_the_matrix() {
    // Small cases, so that this counts turns; the others are culled by the test above.
    let small = r#"{ kind = "chain", bodies = [3] }"#;
    let any = HardCaseGroup::parse(&format!(
        "why = \"few bodies\"\nseed = 1\nrecipe = {small}\n[[forms]]\nform = \"box\"\n"
    ))
    .unwrap();
    let tiers = [Tier::available(), vec![Tier::SCALAR_FLUSH]].concat();
    for tiers in [tiers, vec![Tier::SCALAR]] {
        let rotation = Rotation::new(&tiers);
        assert!(FILES.len() >= rotation.modes().len(), "more groups are needed");
        let turns: Vec<_> =
            (0..FILES.len()).flat_map(|n| variants().map(move |variant| (n, variant))).collect();
        let judge = |(n, variant)| group(n, &any, variant, &rotation).unwrap();
        let ledgers: Vec<Ledger> = turns.into_par_iter().map(judge).collect();
        let mut all = Ledger::default();
        ledgers.into_iter().for_each(|ledger| all.add(ledger));
        assert_eq!(all.coverage.empty(Cell::of_all_meshes(&rotation)), []);
        assert_eq!((all.missed(), all.differing()), (0, 0));
    }
}

/// A new strategy, finder, overlap test or volume shows up here by itself: the ways are counted,
/// not assumed.
#[test]
fn ways_cover_every_choice() {
    let mut seen = BTreeSet::new();
    for (k, axes) in variants() {
        for way in ways(k, axes) {
            seen.insert((way.strategy, way.pairs, way.overlap, way.k, way.axes));
        }
    }
    for &strategy in Strategy::ALL {
        for &finder in Finder::ALL {
            for &k in DirectionSet::ALL {
                for &axes in Axes::ALL {
                    for &overlap in Overlap::ALL {
                        let expected =
                            strategy.scheme().has_overlap_test() || overlap == Overlap::TwoSided;
                        let way = (strategy, finder, overlap, k, axes);
                        assert_eq!(seen.remove(&way), expected, "{way:?}");
                    }
                }
            }
        }
    }
    assert!(seen.is_empty());
    // Every predicate is required by some strategy, so no volume goes unjudged.
    let judged = |predicate: Predicate| match predicate {
        Predicate::Sphere => Strategy::Sphere,
        Predicate::OrDop(_) => Strategy::OrDop,
        Predicate::Aabb => Strategy::Aabb,
        Predicate::KDop => Strategy::KDop,
        Predicate::Obb => Strategy::Obb,
        Predicate::Mesh => Strategy::SDopBatch,
    };
    for predicate in Predicate::ALL {
        assert!(Strategy::ALL.contains(&judged(predicate)));
    }
}

#[test]
fn what_must_be_refused_is_refused() {
    #[derive(serde::Deserialize)]
    struct Refused {
        scene: Vec<Case>,
        mesh: Vec<Case>,
    }
    #[derive(serde::Deserialize)]
    struct Case {
        what: String,
        text: String,
        says: String,
    }
    impl Case {
        fn assert_refused<T, E: ToString>(&self, made: Result<T, E>) {
            let error = made.map_or_else(|error| error.to_string(), |_| "nothing".to_owned());
            assert!(error.contains(&self.says), "{}: {error}", self.what);
        }
    }
    let text = std::fs::read_to_string("data/hard_cases/refused.toml").unwrap();
    let refused: Refused = toml::from_str(&text).unwrap();
    for case in refused.scene {
        let scene = sdop_bench::scene::SceneFile::parse(
            &case.text,
            "refused.toml",
            Path::new("data/scenes"),
        )
        .and_then(|file| file.build());
        case.assert_refused(scene);
    }
    for case in refused.mesh {
        let obj = sdop::mesh::MeshFormat::Obj;
        let read =
            sdop::mesh::read_bytes("refused", obj, case.text.as_bytes(), &ReadOptions::default());
        case.assert_refused(read);
    }
}

/// An invalid group is rejected.
#[test]
fn invalid_group_is_rejected() {
    assert!(matches!(HardCaseGroup::parse("why = 3"), Err(HardCaseError::File(_))));
}
