//! One world on many ranks, each a thread here: the same pairs as one process, whatever the ranks,
//! strategy and finder.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod borders;
mod corpus;
mod scenes;

use crate::support;
use std::path::Path;

use sdop::Culler;
use sdop::bodies::Bodies;
use sdop::settings::CullSettings;
use sdop::simd::Tier;
use sdop::volume::Shape;
use sdop_bench::domain::{DomainError, DomainSummary, Rank, RankLine, run};
use sdop_bench::effects::{EffectsSpec, Velocities};
use sdop_bench::network::{Network as _, on_ranks};
use sdop_bench::scene::{Scene, SceneFile, Share};
use sdop_bench::simulate::SimulationError;

/// One, halves, an odd number, and eight about a corner.
const RANKS: [usize; 4] = [1, 2, 3, 8];

fn parse(text: &str) -> SceneFile {
    SceneFile::parse(text, "scene.toml", Path::new("")).unwrap()
}

fn build(text: &str) -> Scene {
    parse(text).build().unwrap()
}

/// A scene on so many ranks, as rank 0 reports it.
fn on(ranks: usize, scene: &Scene) -> Result<DomainSummary, DomainError> {
    let mut all = on_ranks(ranks, |net| {
        let share = share_of(scene, net.rank(), ranks);
        run(Rank::new(net, share, Tier::detect(), 1)?, |_| ())
    });
    all.swap_remove(0)
}

/// A scene in one process.
fn alone(scene: &Scene) -> sdop_bench::simulate::Summary {
    sdop_bench::simulate::run::<SimulationError>(scene, Tier::detect(), |_| Ok(())).unwrap()
}

/// A scene of given bodies, for frames whose poses come from the test.
fn scene_of(shapes: &[Shape], bodies: &Bodies, settings: &CullSettings) -> Scene {
    let still = vec![[0.0; 3]; bodies.len()];
    Scene {
        name: "given".to_owned(),
        seed: 1,
        frames: 1,
        dt: 1.0,
        side: None,
        shapes: shapes.to_vec(),
        velocities: Velocities { linear: still.clone(), angular: still },
        bodies: bodies.clone(),
        fine: Default::default(),
        share: None,
        effects: EffectsSpec::default(),
        cull: settings.clone(),
        construct_seconds: 0.0,
    }
}

/// A rank's share of a scene.
fn share_of(scene: &Scene, rank: usize, ranks: usize) -> Scene {
    let all = scene.share();
    let share = Share::of_rank(rank, ranks, all.all, all.moving);
    let held = share.held.clone();
    let Bodies { shape, dynamic, rotation, translation } = &scene.bodies;
    Scene {
        bodies: Bodies {
            shape: shape[held.clone()].to_vec(),
            dynamic: dynamic[held.clone()].to_vec(),
            rotation: rotation[held.clone()].to_vec(),
            translation: translation[held.clone()].to_vec(),
        },
        velocities: Velocities {
            linear: scene.velocities.linear[held.clone()].to_vec(),
            angular: scene.velocities.angular[held].to_vec(),
        },
        share: Some(share),
        ..scene.clone()
    }
}

/// The sorted pairs of each frame that so many ranks report of bodies at given poses; each pair as
/// often as it is reported.
fn pairs_on(
    ranks: usize,
    shapes: &[Shape],
    frames: &[Bodies],
    settings: &CullSettings,
) -> Vec<Vec<[u32; 2]>> {
    let scene = scene_of(shapes, &frames[0], settings);
    let each = on_ranks(ranks, |net| {
        let share = share_of(&scene, net.rank(), ranks);
        let mut rank = Rank::new(net, share, Tier::detect(), 1).unwrap();
        let frames = frames.iter().map(|poses| rank.frame_at(poses).unwrap().pairs.to_vec());
        frames.collect::<Vec<_>>()
    });
    let sorted = |frame: usize| {
        let mut pairs: Vec<_> = each.iter().flat_map(|rank| rank[frame].clone()).collect();
        pairs.sort_unstable();
        pairs
    };
    (0..frames.len()).map(sorted).collect()
}

/// The same in one process.
fn pairs_alone(shapes: &[Shape], frames: &[Bodies], settings: &CullSettings) -> Vec<Vec<[u32; 2]>> {
    let culler = Culler::builder().settings(settings).build(shapes, &frames[0]);
    let mut culler = culler.unwrap();
    let cull = |poses: &Bodies| culler.cull(poses).unwrap().sorted();
    frames.iter().map(cull).collect()
}

fn ghosts(lines: &[RankLine]) -> u64 {
    lines.iter().map(|line| line.ghosts).sum()
}
