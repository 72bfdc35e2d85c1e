//! F and Cv of the first test: finding pairs in the calibration scenes; an element is a test. Then
//! all pair finders: update and finding; an element is a body.
//!
//! Calibration scenes with the same number of bodies have different boxes and therefore different
//! numbers of hits; the difference gives the price of a hit. The finders' scenes are those of
//! [`common::swarm`]. `sdop-field boxes` times one thread and two.

#![allow(clippy::unwrap_used, reason = "a bench without its scene can't go on")]

mod common;

use std::time::Duration;

use criterion::measurement::WallTime;
use criterion::{
    BenchmarkGroup, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main,
};
use sdop::settings::Finder;

use common::swarm::{Kind, Swarm};

fn pair_finding(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("pair finding");
    group.sample_size(20);
    for (name, scene) in common::calibration_scenes() {
        for (strategy, volume) in common::one_volume() {
            let id = BenchmarkId::new(strategy.name(), &name);
            common::stage(
                &mut group,
                id,
                (&scene, strategy),
                |s| s.pair_finding + s.ordop,
                |c| c.of(volume).tests,
            );
        }
    }
}

fn bench_finder(
    group: &mut BenchmarkGroup<'_, WallTime>,
    (kind, n): (Kind, usize),
    finder: Finder,
    threads: usize,
) {
    let mut swarm = Swarm::new(kind, n);
    let mut culler = swarm.culler(finder, threads);
    group.throughput(Throughput::Elements(n as u64));
    let kind = format!("{kind:?}").to_lowercase();
    let id = BenchmarkId::new(format!("{finder}/{kind}"), format!("{n}/{threads}"));
    group.bench_function(id, |bencher| {
        bencher.iter_custom(|iterations| {
            let before = culler.seconds().total;
            for _ in 0..iterations {
                swarm.sway();
                culler.cull(&swarm.bodies).unwrap();
            }
            Duration::from_secs_f64(culler.seconds().total - before)
        });
    });
}

fn finders(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("finders");
    group.sample_size(10);
    group.measurement_time(Duration::from_secs(2));
    group.warm_up_time(Duration::from_millis(200));
    for &finder in Finder::ALL {
        // The most bodies at which a frame still takes less than seconds. `auto` is one of the
        // others.
        let most = match finder {
            Finder::AllPairs => 1000,
            Finder::Sweep => 10_000,
            Finder::Grid | Finder::Neighbours => 1_000_000,
            Finder::Auto => continue,
        };
        for n in [64, 500, 1000, 10_000, 100_000, 1_000_000] {
            if n <= most {
                bench_finder(&mut group, (Kind::Uniform, n), finder, 1);
            }
        }
    }
    for kind in [Kind::Plane, Kind::Clusters, Kind::Mixed, Kind::Wild] {
        bench_finder(&mut group, (kind, 10_000), Finder::Sweep, 1);
        for n in [1000, 10_000, 100_000] {
            bench_finder(&mut group, (kind, n), Finder::Grid, 1);
        }
    }
    for n in [100_000, 1_000_000] {
        bench_finder(&mut group, (Kind::Uniform, n), Finder::Grid, 2);
    }
}

criterion_group!(benches, pair_finding, finders);
criterion_main!(benches);
