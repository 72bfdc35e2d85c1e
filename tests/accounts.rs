//! What a culler keeps account of: seconds of stages that add up to those of frames, none of which is counted twice or is the
//! caller's own.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::time::{Duration, Instant};

use sdop::bodies::Bodies;
use sdop::counters::Seconds;
use sdop::culler::Culler;
use sdop::mesh::shapes::ProceduralShape;
use sdop::settings::{CullSettings, Strategy, Updates};
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
    let settings = CullSettings {
        strategy,
        updates,
        ..CullSettings::default()
    };
    let culler = Culler::builder().settings(&settings).threads(threads);
    (culler.build(&shapes, &bodies).unwrap(), bodies)
}

/// A frame's seconds, and those that the caller sees go by.
fn timed(culler: &mut Culler, cull: impl FnOnce(&mut Culler)) -> (Seconds, f64) {
    let (before, start) = (*culler.seconds(), Instant::now());
    cull(culler);
    let wall = start.elapsed().as_secs_f64();
    (culler.seconds().since(&before), wall)
}

#[test]
fn seconds_of_stages_add_up_to_those_of_frames() {
    for strategy in [
        Strategy::Sphere,
        Strategy::SDopSequential,
        Strategy::SDopBatch,
        Strategy::KDop,
    ] {
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
                    assert!(
                        0.0 < own.total && own.total <= wall,
                        "{way}: {own:?} of {wall}"
                    );
                    assert!(
                        own.update > 0.0 && own.pair_finding > -SLACK,
                        "{way}: {own:?}"
                    );
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

#[test]
fn what_the_caller_does_with_portions_is_not_counted() {
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
        assert!(
            rested > 0.0 && own.total <= wall - rested + SLACK,
            "{own:?}: {wall}, {rested}"
        );
        let stages = own.update + own.pair_finding + own.ordop;
        assert!(stages <= own.total + SLACK, "{own:?}");
        assert!(threads > 1 || own.pair_finding > -SLACK, "{own:?}");
    }
}
