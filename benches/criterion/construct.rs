//! Co: building each volume of the shipped meshes, once per mesh.

mod common;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use sdop_bench::cost::construct::construct;
use sdop_bench::measure::counts::Volume;

fn constructions(criterion: &mut Criterion) {
    let scene = common::scene("paper-500");
    let mut group = criterion.benchmark_group("construct");
    for shape in &scene.shapes {
        for volume in [Volume::Sphere, Volume::OrDop, Volume::KDop, Volume::Obb] {
            let id = BenchmarkId::new(volume.name(), &shape.name);
            group.bench_function(id, |bencher| {
                bencher.iter(|| construct(volume, shape, scene.cull.axes))
            });
        }
    }
}

criterion_group!(benches, constructions);
criterion_main!(benches);
