//! Seeded scenes and the stage clock that every bench shares with the calibration of `sdop cost`.

#![allow(dead_code, reason = "each bench uses its own part")]
#![allow(clippy::unwrap_used, reason = "a bench without its scene can't go on")]

pub mod swarm;

use std::path::Path;
use std::time::Duration;

use criterion::{BenchmarkGroup, BenchmarkId, Throughput, measurement::WallTime};
use sdop::bodies::Bodies;
use sdop::counters::{Counters, Seconds};
use sdop::culler::Culler;
use sdop::lab::cost::calibrate;
use sdop::lab::scene::{Scene, SceneFile};
use sdop::settings::{CullSettings, Strategy};
use sdop::simd::Tier;

/// Frames that a bench goes round in.
pub const FRAMES: usize = 32;

/// A strategy and what is counted of it.
pub type Counted = (Strategy, fn(&Counters) -> u64);

/// A scene of `data/scenes`.
pub fn scene(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("data/scenes")
        .join(name);
    SceneFile::read(&path.with_extension("toml"))
        .unwrap()
        .build()
        .unwrap()
}

/// The calibration scenes of the paper's 500 objects, named by their number of bodies and the side of their box.
pub fn calibration_scenes() -> Vec<(String, Scene)> {
    let named = |scene: Scene| {
        (
            format!("{} in {:.1}", scene.bodies.len(), scene.side.unwrap()),
            scene,
        )
    };
    calibrate::scenes(&scene("paper-500")).map(named).collect()
}

/// The first frames of a scene.
pub fn frames(scene: &Scene) -> Vec<Bodies> {
    let mut effects = scene.start_effects().unwrap();
    let mut bodies = scene.bodies.clone();
    let mut frames = vec![bodies.clone()];
    while frames.len() < FRAMES {
        effects.step(&mut bodies).unwrap();
        frames.push(bodies.clone());
    }
    frames
}

/// Times one stage of a strategy, frame after frame of the scene. Throughput is the stage's count a frame, so that the time
/// an element is the stage's price if it had only one.
pub fn stage(
    group: &mut BenchmarkGroup<'_, WallTime>,
    id: BenchmarkId,
    (scene, strategy): (&Scene, Strategy),
    stage: fn(&Seconds) -> f64,
    count: fn(&Counters) -> u64,
) {
    let settings = CullSettings {
        strategy,
        ..scene.cull.clone()
    };
    let mut culler = Culler::new(&scene.shapes, &scene.bodies, &settings, Tier::detect()).unwrap();
    let frames = frames(scene);
    for bodies in &frames {
        culler.cull(bodies);
    }
    group.throughput(Throughput::Elements(
        count(culler.counters()) / FRAMES as u64,
    ));
    group.bench_function(id, |bencher| {
        bencher.iter_custom(|iterations| {
            let before = stage(culler.seconds());
            for i in 0..iterations as usize {
                culler.cull(&frames[i % FRAMES]);
            }
            Duration::from_secs_f64(stage(culler.seconds()) - before)
        });
    });
}
