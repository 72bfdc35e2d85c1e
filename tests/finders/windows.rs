//! or-DOP rows that are made where they are tested, as batches do with many bodies, against rows that are all made before, as the
//! sequential strategy has them: the same pairs and counts, in every tier and on any number of threads.

use super::*;

/// Many enough for a batch to make rows by itself, all of them moving.
fn many(name: &'static str, radii: &[f32], bodies: usize, side: f32) -> Scene {
    let mut scene = Scene::new(name, radii, bodies, |_, rng| uniform(rng, side));
    scene.bodies.dynamic.fill(true);
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

#[test]
fn near_places_share_windows_in_every_tier() {
    let scene = many("many", &[1.0, 0.8], 20_000, 72.0);
    let finders = [Finder::Neighbours, Finder::Grid, Finder::Sweep];
    batches_equal_sequences(&scene, &finders, &Tier::available());
}

/// Wide bodies and small ones have slots of their own, so that those of a pair lie farther apart than a window is long.
#[test]
fn pairs_whose_places_are_far_apart_are_tested_by_rows_that_are_all_made() {
    let scene = many("wide and small", &[0.3, 0.3, 0.3, 0.3, 4.0], 90_000, 110.0);
    batches_equal_sequences(&scene, &[Finder::Neighbours], &[Tier::detect()]);
}
