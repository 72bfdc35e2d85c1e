//! Whole frames: culling the paper's 500 objects with every strategy, in the usual and in the
//! crowded box.

mod common;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use sdop_bench::reproduce::STRATEGIES;

fn frames(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("cull");
    for name in ["paper-500", "crowded-500"] {
        let scene = common::scene(name);
        for strategy in STRATEGIES {
            let id = BenchmarkId::new(name, strategy);
            common::stage(
                &mut group,
                id,
                (&scene, strategy),
                |s| s.total,
                |_| common::FRAMES as u64,
            );
        }
    }
}

criterion_group!(benches, frames);
criterion_main!(benches);
