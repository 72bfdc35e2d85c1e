//! F and Cv of the first test: finding pairs in the calibration scenes, an element a test.
//!
//! Scenes of one number of bodies differ in their box, and so in their hits: the difference prices a hit.

mod common;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use sdop::scene::settings::Strategy;

fn pair_finding(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("pair finding");
    group.sample_size(20);
    let volumes: [common::Counted; 5] = [
        (Strategy::Sphere, |c| c.sphere.tests),
        (Strategy::OrDop, |c| c.ordop.tests),
        (Strategy::Aabb, |c| c.aabb.tests),
        (Strategy::KDop, |c| c.kdop.tests),
        (Strategy::Obb, |c| c.obb.tests),
    ];
    for (name, scene) in common::calibration_scenes() {
        for (strategy, count) in volumes {
            let id = BenchmarkId::new(strategy.name(), &name);
            common::stage(
                &mut group,
                id,
                (&scene, strategy),
                |s| s.pair_finding + s.ordop,
                count,
            );
        }
    }
}

criterion_group!(benches, pair_finding);
criterion_main!(benches);
