//! Crowds: pairs taken in portions are those of the list, in its order, in bounded memory; a limit
//! is an error that says how many pairs there are.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use sdop::bodies::Bodies;
use sdop::counters::Counters;
use sdop::culler::{CullError, Culler};
use sdop::mesh::shapes::ProceduralShape;
use sdop::settings::{
    Budget, CullSettings, Finder, Flow, Interest, Order, Overlap, Strategy, Updates,
};
use sdop::volume::{Shape, ShapeSpec};

/// The bytes that all lists may take when pairs are taken in portions on two threads: eight tasks
/// with a portion each, and an eighth more.
const BOUND: usize = 8 * 9 * (1 << 16) + (1 << 20);

fn shapes() -> Vec<Shape> {
    let mesh = ProceduralShape::Box { x: 1.0, y: 1.5, z: 2.0 };
    vec![Shape::build(&mesh.build().unwrap(), &ShapeSpec::default()).unwrap()]
}

/// `n` bodies within a millionth of each other, turned in eight ways, and every seventh of them
/// static.
fn crowd(n: usize) -> Bodies {
    let mut bodies = Bodies::default();
    for body in 0..n {
        let turn = [(body % 8) as f32, 1.0, 2.0, 5.0];
        let place = [(body % 5) as f32 * 1e-6, 0.0, 0.0];
        bodies.push(0, body % 7 != 0, turn, place);
    }
    bodies
}

fn settings(strategy: Strategy, pairs: Finder) -> CullSettings {
    CullSettings {
        strategy,
        pairs,
        interest: Some(Interest::Bodies((0..100).collect())),
        budget: Some(Budget::Tests(70_000)),
        ..CullSettings::default()
    }
}

/// Every way in which pairs flow: strategies, updates, orders of refinement.
fn ways() -> impl Iterator<Item = CullSettings> {
    Strategy::ALL.iter().flat_map(|&strategy| {
        let settings = settings(strategy, Finder::Grid);
        let timed = strategy.scheme().flow == Flow::TimeCritical;
        let orders = if timed { Order::ALL } else { &Order::ALL[..1] };
        let with = move |updates| {
            let settings = settings.clone();
            orders.iter().map(move |&order| CullSettings { updates, order, ..settings.clone() })
        };
        Updates::ALL.iter().copied().flat_map(with)
    })
}

fn culler(shapes: &[Shape], bodies: &Bodies, settings: &CullSettings, threads: usize) -> Culler {
    let culler = Culler::builder().settings(settings).threads(threads).worth_waking(0);
    culler.build(shapes, bodies).unwrap()
}

/// What passes one test is what the next one gets, and what passes the last is reported.
fn assert_counted(counters: &Counters, settings: &CullSettings, reported: u64) {
    let scheme = settings.strategy.scheme();
    let every_hit_is_refined = matches!(scheme.flow, Flow::Sequential | Flow::Batch);
    let of = |volume: Option<_>| volume.map(|volume| *counters.of(volume));
    match (of(scheme.first), of(scheme.refining)) {
        (Some(first), Some(refining)) if every_hit_is_refined => {
            assert_eq!(first.hits, refining.tests, "{settings:?}");
            assert_eq!(refining.hits, reported, "{settings:?}");
        }
        (Some(only), None) | (None, Some(only)) => {
            assert_eq!(only.hits, reported, "{settings:?}");
        }
        _ => assert_eq!(counters.reported, reported, "{settings:?}"),
    }
}

/// Whether a list of all candidates is kept: portions need one to sort it alone.
fn keeps_candidates(settings: &CullSettings, in_portions: bool) -> bool {
    let sorts = settings.order != Order::AsFound;
    match settings.strategy.scheme().flow {
        Flow::Nothing | Flow::FirstTest => false,
        Flow::TimeCritical => sorts || !in_portions,
        Flow::Batch => !in_portions,
        Flow::Sequential | Flow::OfInterest => settings.updates == Updates::Lazy && !in_portions,
    }
}

/// Culls three frames in both ways, in which the crowd of so many bodies spreads.
fn assert_same(settings: &CullSettings, threads: usize, bodies: usize) {
    let (shapes, mut bodies) = (shapes(), crowd(bodies));
    let mut whole = culler(&shapes, &bodies, settings, 1);
    let mut taken = culler(&shapes, &bodies, settings, threads);
    let mut total = 0;
    for frame in 0..3 {
        let expected: Vec<_> = whole.cull(&bodies).unwrap().iter().collect();
        let (mut pairs, mut portions) = (Vec::new(), 0);
        let reported = taken.cull_in_portions(&bodies, |portion| {
            pairs.extend(portion.iter());
            portions += 1;
        });
        let reported = reported.unwrap();
        let way = format!("{settings:?}, {threads} threads, frame {frame}");
        assert!(pairs == expected, "{way}");
        assert_eq!(reported, expected.len() as u64, "{way}");
        assert_eq!(taken.counters(), whole.counters(), "{way}");
        for (culler, in_portions) in [(&whole, false), (&taken, true)] {
            let kept = culler.potentially_colliding().len() > 0;
            assert_eq!(kept, keeps_candidates(settings, in_portions), "{way}");
        }
        total += reported;
        if frame == 0 && expected.len() > 1 << 17 {
            assert!(portions > 1, "{way}");
        }
        for (body, place) in bodies.translation.iter_mut().enumerate() {
            if bodies.dynamic[body] {
                place[1] += 0.01 * (body % 16) as f32;
            }
        }
    }
    assert_counted(taken.counters(), settings, total);
}

/// Few pairs come as the list in every way too.
#[test]
fn few_pairs_match_the_list() {
    for settings in ways() {
        assert_same(&settings, 1, 120);
        assert_same(&settings, 3, 120);
    }
}

/// Portions are the list in every way that pairs flow.
#[test]
fn portions_match_in_every_flow() {
    for settings in ways() {
        for threads in [1, 2, 3] {
            assert_same(&settings, threads, 640);
        }
    }
}

/// Portions are the list of every finder.
#[test]
fn portions_match_every_finder() {
    for &pairs in Finder::ALL {
        for strategy in [Strategy::Sphere, Strategy::SDopSequential, Strategy::KDop] {
            assert_same(&settings(strategy, pairs), 2, 640);
        }
    }
}

/// Memory is bounded whatever the number of pairs.
#[test]
fn memory_of_portions_is_bounded() {
    let (shapes, bodies) = (shapes(), crowd(5000));
    for settings in ways() {
        let sorts = settings.order != Order::AsFound;
        let refines = settings.strategy.scheme().refining.is_some();
        if sorts || (refines && settings.strategy != Strategy::SDopBatch) {
            continue;
        }
        let settings = CullSettings { overlap: Overlap::OneSided, ..settings };
        let mut culler = culler(&shapes, &bodies, &settings, 2);
        let pairs = culler.cull_in_portions(&bodies, |_| {}).unwrap();
        let reports = settings.strategy != Strategy::None;
        let static_bodies = 5000_u64.div_ceil(7);
        let all = 5000 * 4999 / 2 - static_bodies * (static_bodies - 1) / 2;
        assert_eq!(pairs, if reports { all } else { 0 }, "{settings:?}");
        let bytes = culler.pair_bytes();
        assert!(bytes < BOUND, "{bytes}: {settings:?}");
    }
}

/// Memory of a crowd is counted and given back.
#[test]
fn crowd_memory_is_freed() {
    let (shapes, bodies) = (shapes(), crowd(120));
    for settings in ways() {
        let mut culler = culler(&shapes, &bodies, &settings, 1);
        let pairs = culler.cull(&bodies).unwrap().len();
        let listed = pairs + culler.potentially_colliding().len();
        let crowded = culler.pair_bytes();
        assert!(crowded >= 8 * listed, "{crowded}: {settings:?}");
        culler.shrink_to_fit();
        let kept = culler.pair_bytes();
        // A vector more after each column.
        assert!(kept <= 8 * (listed + 2 * 16), "{kept}: {settings:?}");
    }
}

/// A limit is kept and an error says how many pairs there are.
#[test]
fn pair_limit_reports_the_count() {
    let (shapes, bodies) = (shapes(), crowd(640));
    let settings = settings(Strategy::SDopSequential, Finder::Grid);
    let mut culler = culler(&shapes, &bodies, &settings, 1);
    let expected: Vec<_> = culler.cull(&bodies).unwrap().iter().collect();
    let crowded = culler.pair_bytes();
    assert!(crowded > 8 * expected.len());
    culler.shrink_to_fit();
    assert!(culler.pairs().iter().eq(expected.iter().copied()));
    assert!(culler.pair_bytes() < crowded);

    let limit = expected.len();
    let kept = culler.cull_up_to(&bodies, limit).unwrap();
    assert!(kept.iter().eq(expected.iter().copied()));
    for limit in [0, 1, limit - 1] {
        let pairs = expected.len() as u64;
        let error = culler.cull_up_to(&bodies, limit).unwrap_err();
        assert_eq!(error, CullError::TooManyPairs { pairs, limit });
        assert!(culler.pairs().is_empty());
        assert!(error.to_string().contains(&pairs.to_string()));
    }
    culler.shrink_to_fit();
    culler.cull_up_to(&bodies, 10).unwrap_err();
    let bytes = culler.pair_bytes();
    assert!(bytes < 8 * 9 * (1 << 16), "nothing is kept of a crowd: {bytes}");
}

#[test]
#[should_panic(expected = "the sink gives up")]
fn a_sink_that_panics_hangs_nobody() {
    let (shapes, bodies) = (shapes(), crowd(640));
    let settings = settings(Strategy::Sphere, Finder::Grid);
    let mut culler = culler(&shapes, &bodies, &settings, 3);
    let _ = culler.cull_in_portions(&bodies, |_| panic!("the sink gives up"));
}
