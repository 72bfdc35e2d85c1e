//! A culler's accounts: the stages' seconds add up to the frames', count nothing twice and exclude
//! the caller's time; a budget of tests is spent in the requested order.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::HashMap;
use std::time::{Duration, Instant};

use sdop::bodies::Bodies;
use sdop::counters::Seconds;
use sdop::culler::Culler;
use sdop::mesh::shapes::ProceduralShape;
use sdop::settings::{Budget, CullSettings, Finder, Interest, Order, Strategy, Updates};
use sdop::volume::{Shape, ShapeSpec};

/// Clocks are read in nanoseconds, and sums of f64 round.
const SLACK: f64 = 1e-6;

/// Two hundred boxes within a millionth of each other: tests take most of a frame.
fn culler(strategy: Strategy, updates: Updates, threads: usize) -> (Culler, Bodies) {
    let mesh = ProceduralShape::default_of("box").unwrap().build().unwrap();
    let shapes = [Shape::build(&mesh, &ShapeSpec::default()).unwrap()];
    let mut bodies = Bodies::default();
    for body in 0..200 {
        let turn = [(body % 8) as f32, 1.0, 2.0, 5.0];
        bodies.push(0, true, turn, [(body % 5) as f32 * 1e-6, 0.0, 0.0]);
    }
    let settings = CullSettings { strategy, updates, ..CullSettings::default() };
    let culler = Culler::builder().settings(&settings).threads(threads).worth_waking(0);
    (culler.build(&shapes, &bodies).unwrap(), bodies)
}

/// A frame's seconds, and those that the caller sees go by.
fn timed(culler: &mut Culler, cull: impl FnOnce(&mut Culler)) -> (Seconds, f64) {
    let (before, start) = (*culler.seconds(), Instant::now());
    cull(culler);
    let wall = start.elapsed().as_secs_f64();
    (culler.seconds().since(&before), wall)
}

/// Seconds of stages add up to those of frames.
#[test]
fn stage_seconds_add_up() {
    for strategy in
        [Strategy::Sphere, Strategy::SDopSequential, Strategy::SDopBatch, Strategy::KDop]
    {
        for &updates in Updates::ALL {
            for threads in [1, 2] {
                let (mut culler, bodies) = culler(strategy, updates, threads);
                assert!(culler.seconds().construct > 0.0);
                let way = format!("{strategy}, {updates}, {threads} threads");
                let mut most_is_accounted_for = false;
                for _ in 0..8 {
                    let cull =
                        |culler: &mut Culler| assert!(!culler.cull(&bodies).unwrap().is_empty());
                    let (own, wall) = timed(&mut culler, cull);
                    let stages = own.update + own.pair_finding + own.ordop;
                    assert!(0.0 < own.total && own.total <= wall, "{way}: {own:?} of {wall}");
                    assert!(own.update > 0.0 && own.pair_finding > -SLACK, "{way}: {own:?}");
                    let refines = strategy.scheme().refining.is_some();
                    assert_eq!(own.ordop > 0.0, refines, "{way}: {own:?}");
                    assert!(stages <= own.total + SLACK, "{way}: {own:?}");
                    most_is_accounted_for |= stages > 0.9 * own.total;
                }
                // A frame during which another program ran may have gaps; not each of them.
                assert!(most_is_accounted_for, "{way}");
            }
        }
    }
}

/// What the caller does with portions is not counted.
#[test]
fn caller_time_is_not_counted() {
    for threads in [1, 2] {
        let (mut culler, bodies) = culler(Strategy::SDopSequential, Updates::Eager, threads);
        let mut rested = Duration::ZERO;
        let (own, wall) = timed(&mut culler, |culler| {
            let take = |_: &_| {
                let start = Instant::now();
                std::thread::sleep(Duration::from_millis(20));
                rested += start.elapsed();
            };
            culler.cull_in_portions(&bodies, take).unwrap();
        });
        let rested = rested.as_secs_f64();
        assert!(rested > 0.0 && own.total <= wall - rested + SLACK, "{own:?}: {wall}, {rested}");
        let stages = own.update + own.pair_finding + own.ordop;
        assert!(stages <= own.total + SLACK, "{own:?}");
        assert!(threads > 1 || own.pair_finding > -SLACK, "{own:?}");
    }
}

/// The body that the order `interest-first` puts in front.
const OF_INTEREST: u32 = 5;

/// Whether candidates stand in the order asked for; `refined` has the frame in which each pair was
/// refined last.
fn is_in_order(
    order: Order,
    list: &[[u32; 2]],
    bodies: &Bodies,
    refined: &HashMap<[u32; 2], usize>,
) -> bool {
    let away = |[a, b]: [u32; 2]| {
        let [a, b] = [a, b].map(|body| bodies.translation[body as usize][0]);
        (a - b).abs() as usize
    };
    let rank = |pair: &[u32; 2]| match order {
        Order::AsFound => 0,
        Order::InterestFirst => usize::from(!pair.contains(&OF_INTEREST)),
        Order::LargestOverlap => away(*pair),
        Order::OldestAnswer => refined.get(pair).copied().unwrap_or(0),
    };
    order == Order::AsFound || list.is_sorted_by_key(|pair| (rank(pair), *pair))
}

/// Boxes in a row, whose distances are integers: what is refined, and in which order, is known.
#[test]
fn budget_follows_the_requested_order() {
    let mesh = ProceduralShape::Box { x: 2.0, y: 9.0, z: 9.0 };
    let shapes = [Shape::build(&mesh.build().unwrap(), &ShapeSpec::default()).unwrap()];
    let mut bodies = Bodies::default();
    for x in [0u8, 14, 3, 30, 7, 1, 20, 9, 12, 40, 33, 26] {
        bodies.push(0, true, [0.0, 0.0, 0.0, 1.0], [f32::from(x), 0.0, 0.0]);
    }
    let culler = |strategy, order, budget| {
        let culler = Culler::builder().strategy(strategy).order(order);
        let culler = culler.interest(Interest::Bodies(vec![OF_INTEREST]));
        culler.budget(budget).build(&shapes, &bodies).unwrap()
    };
    let mut whole = culler(Strategy::SDopBatch, Order::AsFound, Budget::Tests(0));
    let touching = whole.cull(&bodies).unwrap().sorted();
    let as_found: Vec<_> = whole.potentially_colliding().collect();
    assert!(as_found.len() > 20 && 3 < touching.len() && touching.len() < 10);
    for &order in Order::ALL {
        for (budget, spent) in [
            (Budget::Tests(0), 0),
            (Budget::Tests(1), 1),
            (Budget::Tests(7), 7),
            (Budget::Tests(1000), as_found.len()),
            (Budget::Microseconds(0), 0),
            (Budget::Microseconds(60_000_000), as_found.len()),
        ] {
            let mut culler = culler(Strategy::SDopTimeCritical, order, budget);
            let mut refined = HashMap::new();
            for frame in 1..9 {
                let before = *culler.counters();
                let found = culler.cull(&bodies).unwrap().sorted();
                let list: Vec<_> = culler.potentially_colliding().collect();
                let way = format!("{order}, {budget:?}, frame {frame}: {list:?}");
                assert_eq!(list.len(), as_found.len(), "{way}");
                assert!(order != Order::AsFound || list == as_found, "{way}");
                assert!(is_in_order(order, &list, &bodies, &refined), "{way}");
                let (paid, rest) = list.split_at(spent);
                let mut wanted: Vec<_> = rest.to_vec();
                wanted.extend(paid.iter().filter(|pair| touching.contains(pair)));
                wanted.sort_unstable();
                assert_eq!(found, wanted, "{way}");
                let own = culler.counters().since(&before);
                assert_eq!((own.ordop.tests, own.untested), (spent as u64, rest.len() as u64));
                let hits = found.len() - rest.len();
                assert_eq!(own.ordop.hits, hits as u64, "{way}");
                assert_eq!(own.sphere.hits, list.len() as u64, "{way}");
                refined.extend(paid.iter().map(|&pair| (pair, frame)));
            }
        }
    }
}

/// A body that no other is near to is no candidate, whatever volume represents it.
#[test]
fn oriented_volumes_use_ball_bins() {
    let mesh = ProceduralShape::default_of("box").unwrap().build().unwrap();
    let shapes = [Shape::build(&mesh, &ShapeSpec::default()).unwrap()];
    let mut bodies = Bodies::default();
    for body in 0..300u16 {
        bodies.push(0, true, [0.0, 0.0, 0.0, 1.0], [f32::from(body) * 10.0, 0.0, 0.0]);
    }
    let oriented = Strategy::ALL.iter().filter(|strategy| strategy.scheme().is_oriented_alone());
    for &strategy in oriented {
        let culler = Culler::builder().strategy(strategy).finder(Finder::Grid);
        let mut culler = culler.build(&shapes, &bodies).unwrap();
        culler.cull(&bodies).unwrap();
        let counted = culler.counters();
        let tests = [counted.ordop, counted.obb].map(|volume| volume.tests);
        assert!(tests.iter().sum::<u64>() < 300, "{strategy}: {tests:?}");
    }
}
