//! Cu: the update stage of every volume, an element a body.

mod common;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};

fn updates(criterion: &mut Criterion) {
    let scene = common::scene("paper-500");
    let mut group = criterion.benchmark_group("update");
    for (strategy, volume) in common::one_volume() {
        let id = BenchmarkId::from_parameter(strategy);
        common::stage(
            &mut group,
            id,
            (&scene, strategy),
            |s| s.update,
            |c| c.of(volume).updates,
        );
    }
}

criterion_group!(benches, updates);
criterion_main!(benches);
