//! The price of safety: one frame of the paper's scene culled with margins and without, in every tier.
//!
//! `sdop tradeoff` prints the extra pairs beside times like these.

#![allow(missing_docs, reason = "criterion's macros make items without docs")]
#![allow(
    clippy::unwrap_used,
    reason = "a bench that cannot build its input has failed"
)]

use std::path::Path;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use sdop::pipeline::Culler;
use sdop::scene::SceneFile;
use sdop::scene::settings::Strategy;
use sdop::simd::Level;
use sdop::tradeoff::safety::without_margins;

fn margins(criterion: &mut Criterion) {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes/paper-500.toml");
    let scene = SceneFile::read(&file).unwrap().build().unwrap();
    let bare: Vec<_> = scene.shapes.iter().map(without_margins).collect();
    for strategy in [Strategy::Sphere, Strategy::SDopSequential] {
        let mut settings = scene.cull.clone();
        settings.strategy = strategy;
        let mut group = criterion.benchmark_group(format!("margins/{strategy}"));
        for level in Level::available() {
            for (name, shapes) in [("on", &scene.shapes), ("off", &bare)] {
                let mut culler = Culler::new(shapes, &scene.bodies, &settings, level).unwrap();
                group.bench_function(BenchmarkId::new(name, level.name()), |bencher| {
                    bencher.iter(|| culler.cull(&scene.bodies).len());
                });
            }
        }
        group.finish();
    }
}

criterion_group!(benches, margins);
criterion_main!(benches);
