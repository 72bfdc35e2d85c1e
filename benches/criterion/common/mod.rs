//! Seeded scenes and timing of single stages, shared by all benches and the calibration of
//! `sdop cost`.

#![allow(dead_code, reason = "each bench uses its own part")]
#![allow(clippy::unwrap_used, reason = "a bench without its scene can't go on")]

pub mod swarm;

use std::path::Path;
use std::time::Duration;

use criterion::{BenchmarkGroup, BenchmarkId, Throughput, measurement::WallTime};
use sdop::bodies::Bodies;
use sdop::counters::{Counters, Seconds};
use sdop::culler::Culler;
use sdop::settings::{CullSettings, Strategy, TestedVolume};
use sdop_bench::cost::design;
use sdop_bench::scene::{Scene, SceneFile};
use sdop_bench::simulate::Trajectory;

/// Frames that a bench repeats in a cycle.
pub const FRAMES: usize = 32;

/// The strategies with a single volume, whose stages belong to that volume.
pub fn one_volume() -> impl Iterator<Item = (Strategy, TestedVolume)> {
    Strategy::ALL.iter().filter_map(|&strategy| {
        let mut volumes = strategy.scheme().volumes();
        let first = volumes.next()?;
        volumes.next().is_none().then_some((strategy, first))
    })
}

/// A scene file of `data/scenes`.
pub fn scene_file(name: &str) -> SceneFile {
    let path =
        Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("data/scenes").join(name);
    SceneFile::read(&path.with_extension("toml")).unwrap()
}

/// A scene of `data/scenes`.
pub fn scene(name: &str) -> Scene {
    scene_file(name).build().unwrap()
}

/// The calibration scenes of the paper's objects, for as many as fit the cache of 500: named by
/// their number of bodies and the side of their box.
pub fn calibration_scenes() -> Vec<(String, Scene)> {
    let named =
        |scene: Scene| (format!("{} in {:.1}", scene.bodies.len(), scene.side.unwrap()), scene);
    design::scenes(&scene("paper-500")).map(named).collect()
}

/// The first frames of a scene.
pub fn frames(scene: &Scene) -> Vec<Bodies> {
    let trajectory = Trajectory::new(scene).unwrap();
    let frames = trajectory.with_frames(FRAMES as u32);
    frames.collect::<Result<_, _>>().unwrap()
}

/// Times one stage of a strategy, frame after frame of the scene. Throughput is the stage's count
/// per frame, so that the time per element is the stage's price if it has only one.
pub fn stage(
    group: &mut BenchmarkGroup<'_, WallTime>,
    id: BenchmarkId,
    (scene, strategy): (&Scene, Strategy),
    stage: fn(&Seconds) -> f64,
    count: impl Fn(&Counters) -> u64,
) {
    let settings = CullSettings { strategy, ..scene.cull.clone() };
    let mut culler =
        Culler::builder().settings(&settings).build(&scene.shapes, &scene.bodies).unwrap();
    let frames = frames(scene);
    for bodies in &frames {
        culler.cull(bodies).unwrap();
    }
    group.throughput(Throughput::Elements(count(culler.counters()) / FRAMES as u64));
    group.bench_function(id, |bencher| {
        bencher.iter_custom(|iterations| {
            let before = stage(culler.seconds());
            for i in 0..iterations as usize {
                culler.cull(&frames[i % FRAMES]).unwrap();
            }
            Duration::from_secs_f64(stage(culler.seconds()) - before)
        });
    });
}
