//! Cv of or-DOPs after spheres, in every tier: hits alone, misses alone, and pairs as S-DOP lists
//! them. An element is a pair.
//!
//! A miss ends after A's normals, or in the scalar tier at its first separating axis; a hit tries
//! all axes.

mod common;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use sdop::culler::Culler;
use sdop::pairs::PairList;
use sdop::settings::{CullSettings, Overlap, Strategy};
use sdop::simd::Tier;
use sdop::volume::DirectionSet;
use sdop_bench::posed_ordops::PosedOrDops;
use sdop_bench::scene::Scene;

fn pairs(scene: &Scene, strategy: Strategy) -> PairList {
    let settings = CullSettings { strategy, ..scene.cull.clone() };
    let culler = Culler::builder().settings(&settings).build(&scene.shapes, &scene.bodies);
    culler
        .map(|mut culler| culler.cull(&scene.bodies).expect("bodies within the contract").clone())
        .unwrap_or_default()
}

fn ordop(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("or-dop after sphere");
    for &k in DirectionSet::ALL {
        for &overlap in Overlap::ALL {
            let mut scene = common::scene("crowded-500");
            scene.shapes = scene.shapes.into_iter().map(|shape| shape.with_directions(k)).collect();
            (scene.cull.k, scene.cull.overlap) = (k, overlap);
            let (listed, hits) =
                (pairs(&scene, Strategy::Sphere), pairs(&scene, Strategy::SDopBatch));
            let sorted = hits.sorted();
            let misses: PairList =
                listed.iter().filter(|pair| sorted.binary_search(pair).is_err()).collect();
            let shapes = scene.shapes.iter().map(|shape| (shape, &shape.ordop));
            let posed = PosedOrDops::new(shapes, &scene.bodies, Tier::detect());
            let columns = posed.columns(overlap);
            for (name, list) in [("hits", &hits), ("misses", &misses), ("as listed", &listed)] {
                group.throughput(Throughput::Elements(list.len() as u64));
                for tier in Tier::available() {
                    let id = BenchmarkId::new(format!("k = {k}, {overlap}, {tier}"), name);
                    let mut out = PairList::default();
                    group.bench_function(id, |bencher| {
                        bencher.iter(|| {
                            out.clear();
                            columns.test_pairs(tier, list.first(), list.second(), &mut out)
                        });
                    });
                }
            }
        }
    }
}

criterion_group!(benches, ordop);
criterion_main!(benches);
