//! Batches with many bodies compute or-DOP rows just before they are tested; the sequential
//! strategy computes all rows before the pairs. Both give the same pairs and counts, in every tier
//! and on any number of threads.

use super::*;

/// Bodies of which those move that say so: enough for a batch to make rows by itself.
fn many(
    name: &'static str,
    radii: &[f32],
    bodies: usize,
    side: f32,
    moves: fn(usize) -> bool,
) -> Scene {
    let mut scene = Scene::new(name, radii, bodies, |_, rng| uniform(rng, side));
    scene.bodies.dynamic = (0..bodies).map(moves).collect();
    scene
}

fn batches_equal_sequences(scene: &Scene, finders: &[Finder], tiers: &[Tier]) {
    for &finder in finders {
        let by = |strategy, tier, threads| trace(scene, &settings(strategy, finder), tier, threads);
        let wanted = by(Strategy::SDopSequential, Tier::detect(), 1);
        assert!(wanted[2].0.len() > 1000);
        for &tier in tiers {
            for threads in [1, 3] {
                let found = by(Strategy::SDopBatch, tier, threads);
                let name = scene.name;
                assert!(found == wanted, "{name}, {finder}, {tier}, {threads}");
            }
        }
    }
}

/// Near places share windows in every tier.
#[test]
fn near_places_share_windows() {
    let finders = [Finder::Neighbours, Finder::Grid, Finder::Sweep];
    let radii = [1.0, 0.8];
    let scene = many("some static", &radii, 20_000, 72.0, |body| body % 7 != 3);
    batches_equal_sequences(&scene, &finders, &Tier::available());
    let scene = many("all moving", &radii, 20_000, 72.0, |_| true);
    batches_equal_sequences(&scene, &finders, &[Tier::detect()]);
}

/// Wide bodies and small ones have slots of their own, so that those of a pair lie farther apart
/// than a window is long: those that move, or those that don't.
#[test]
fn far_places_use_all_rows() {
    let radii = [0.3, 0.3, 0.3, 0.3, 4.0];
    let moving = many("all moving", &radii, 90_000, 110.0, |_| true);
    let still = many("most static", &radii, 120_000, 120.0, |body| body % 7 == 3);
    for scene in [moving, still] {
        batches_equal_sequences(&scene, &[Finder::Neighbours], &[Tier::detect()]);
    }
}
