//! Cu: the update stage of every volume, an element a body.

mod common;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use sdop::settings::Strategy;

fn updates(criterion: &mut Criterion) {
    let scene = common::scene("paper-500");
    let mut group = criterion.benchmark_group("update");
    let volumes: [common::Counted; 5] = [
        (Strategy::Sphere, |c| c.sphere.updates),
        (Strategy::OrDop, |c| c.ordop.updates),
        (Strategy::Aabb, |c| c.aabb.updates),
        (Strategy::KDop, |c| c.kdop.updates),
        (Strategy::Obb, |c| c.obb.updates),
    ];
    for (strategy, count) in volumes {
        let id = BenchmarkId::from_parameter(strategy);
        common::stage(&mut group, id, (&scene, strategy), |s| s.update, count);
    }
}

criterion_group!(benches, updates);
criterion_main!(benches);
