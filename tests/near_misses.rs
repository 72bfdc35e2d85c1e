//! Bodies that nearly touch, drawn by proptest: every strategy with every finder, in every SIMD
//! tier, reports what the exact reference reports.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::sync::LazyLock;

use proptest::prelude::*;
use proptest::test_runner::{FileFailurePersistence, TestRunner};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use sdop::bodies::Bodies;
use sdop::settings::Strategy;
use sdop::simd::Tier;
use sdop::volume::{Axes, DirectionSet};
use sdop_judge::configuration::coverage::Cell;
use sdop_judge::configuration::{Mode, Rotation, cullers, variants, ways};
use sdop_judge::draw::arbitrary;
use sdop_judge::draw::bodies::add;
use sdop_judge::draw::contact::{Contact, PlacedShape};
use sdop_judge::draw::forms::{self, Form};
use sdop_judge::truth::{Answers, Predicate, Shapes, compare};
use sdop_judge::verify::{Ledger, Run};

/// Forms and sizes that the draws choose from: round and flat, long and short, centred and not.
static SHAPES: LazyLock<Vec<((DirectionSet, Axes), Shapes)>> = LazyLock::new(|| {
    let mut forms: Vec<Form> = ["box", "l-shape", "needle", "plate", "tetrahedron", "point"]
        .iter()
        .map(|form| Form::of(form, [-1.0, 1.0]))
        .collect();
    for form in &mut forms {
        if form.form == "point" {
            form.radius = None;
        }
    }
    forms.push(Form {
        radius: None,
        offset: Some([0.7, -0.3, 0.4]),
        ..Form::of("l-shape", [0.0; 2])
    });
    let build = |(k, axes)| {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let shapes = forms::build(&forms, 1, k, axes, &mut rng).unwrap();
        ((k, axes), shapes)
    };
    variants().map(build).collect()
});

const FORMS: usize = 7;
const PARTNERS: usize = 12;
/// Probes for each or-DOP and tier.
const CASES: u32 = 24;

type DrawnContacts = (PlacedShape, Vec<(usize, [f32; 4], Contact)>);

/// The probe in the middle of its partners; only the probe moves.
fn frame(shapes: &Shapes, (probe, partners): &DrawnContacts) -> Bodies {
    let mut bodies = Bodies::default();
    for (n, (shape, rotation, contact)) in partners.iter().enumerate() {
        if n == partners.len() / 2 {
            add(&mut bodies, probe, true);
        }
        if let Some(translation) = contact.place(shapes, probe, *shape, *rotation) {
            let partner = PlacedShape { shape: *shape, rotation: *rotation, translation };
            add(&mut bodies, &partner, false);
        }
    }
    bodies
}

fn runner() -> TestRunner {
    let seeds = FileFailurePersistence::Direct("tests/near_misses.regressions");
    TestRunner::new(ProptestConfig {
        failure_persistence: Some(Box::new(seeds)),
        ..ProptestConfig::with_cases(CASES)
    })
}

/// Every strategy, overlap test and finder on one tier, updates and threads in turn. Returns what
/// was judged.
fn never_misses(tier: Tier) -> Ledger {
    let mut all = Ledger::default();
    let rotation = Rotation::new(&[tier]);
    for (variant, shapes) in &*SHAPES {
        let turn = std::cell::Cell::new(0);
        let ledger = std::cell::RefCell::new(Ledger::default());
        let property = |drawn: DrawnContacts| {
            let bodies = frame(shapes, &drawn);
            let answers = [Answers::judge(shapes, &bodies, variant.0, &Predicate::ALL).unwrap()];
            let mut ledger = ledger.borrow_mut();
            ledger.note(&answers[0]);
            let frames = [bodies];
            let run = Run { shapes, frames: &frames, answers: &answers };
            let modes = rotation.turn(turn.replace(turn.get() + 1));
            run.check(*variant, &modes, &mut ledger).unwrap();
            if let Some(failure) = ledger.failures.pop() {
                return Err(TestCaseError::fail(format!(
                    "{:?} missed (or, {}, found by one finder alone) by {:?}, {:?}",
                    failure.pair, !failure.missed, failure.settings, failure.mode
                )));
            }
            Ok(())
        };
        let result = runner().run(&arbitrary::probe(FORMS, PARTNERS), property);
        assert!(result.is_ok(), "{}", result.unwrap_err());
        all.add(ledger.into_inner());
    }
    all
}

/// Stamps the suite on a tier. A tier that this CPU lacks has nothing to test.
macro_rules! on_tiers {
    ($($module:ident = $tier:expr,)+) => {$(
        mod $module {
            use super::*;

            #[test]
            fn near_contacts_are_never_missed() {
                let tier: Option<Tier> = $tier;
                let Some(tier) = tier else {
                    return eprintln!("{} is not on this CPU", stringify!($module));
                };
                let ledger = never_misses(tier);
                let empty = ledger.coverage.empty(Cell::of_all_meshes(&Rotation::new(&[tier])));
                assert_eq!(empty, [], "cases for every way in every mode");
                // Beyond the margins only the slabs' bound of a support reports more; spheres and
                // boxes have none.
                for (row, count) in &ledger.rows {
                    let volume = row.strategy;
                    if matches!(volume, Strategy::Sphere | Strategy::Aabb | Strategy::KDop) {
                        assert_eq!(count.bound, 0, "{volume}: beyond the stated bound");
                        assert!(count.margin > 0, "{volume}: the draws ask for no margin");
                    }
                }
                // The draws must bite: of every predicate a good part is true and a good part is
                // false.
                for ((overlaps, tally), predicate) in
                    ledger.predicates.iter().zip(Predicate::ALL)
                {
                    let share = *overlaps as f64 / tally.total() as f64;
                    assert!((0.05..0.95).contains(&share), "{predicate:?}: {share}");
                }
            }
        }
    )+};
}

on_tiers! {
    scalar = Some(Tier::SCALAR),
    scalar_flush = Some(Tier::SCALAR_FLUSH),
    sse2 = "sse2".parse().ok(),
    avx2 = "avx2".parse().ok(),
    avx512 = "avx512".parse().ok(),
    neon = "neon".parse().ok(),
}

/// The suite is stamped on every tier.
#[test]
fn suite_covers_every_tier() {
    let stamped = ["scalar", "sse2", "avx2", "avx512", "neon"];
    assert_eq!(stamped, Tier::NAMES, "a new tier: stamp it in on_tiers!");
    let names: Vec<_> = Tier::available().iter().map(|tier| tier.name()).collect();
    assert!(names.iter().all(|name| stamped.contains(name)), "{names:?}");
}

/// A list that lacks one required pair is caught.
#[test]
fn missing_pair_is_caught() {
    let (variant, shapes) = &SHAPES[0];
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let spec = sdop_judge::draw::bodies::ContactSpec::default();
    let bodies = sdop_judge::draw::bodies::probe(shapes, &spec, 0, 32, &mut rng);
    let answers = Answers::judge(shapes, &bodies, variant.0, &Predicate::ALL).unwrap();
    for way in ways(variant.0, variant.1) {
        let settings = cullers::settings(way.strategy, &way, bodies.len());
        let mode = Mode::plain(Tier::SCALAR);
        let mut culler = cullers::culler(&settings, mode).build(&shapes.built, &bodies).unwrap();
        let list = culler.cull(&bodies).unwrap().sorted();
        let (count, missed, _) = compare(&answers, &settings, &list);
        assert_eq!((count.missed, missed), (0, vec![]));
        if count.required == 0 {
            continue;
        }
        for n in 0..list.len() {
            let mut lacking = list.clone();
            let pair = lacking.remove(n);
            let at = answers.pairs.binary_search(&pair).unwrap();
            let required = answers.required(way.strategy, way.overlap, &[0, 7, 14, 21, 28], at)
                || answers.of(Predicate::Mesh)[at];
            let (count, ..) = compare(&answers, &settings, &lacking);
            assert_eq!(count.missed, u64::from(required), "{way:?}");
        }
    }
}
