//! The calibration scenes of worlds: how many bodies are queried, thawed and kept, and how many
//! others are near them.
//!
//! As [`design`](super::design) has it, sizes are those of a cache level, and bodies are sampled
//! from the scene. Most of them sleep. A mover wakes the bodies that it touches, and these sleep
//! again as soon as it has left. At each size, the share of bodies that are queried takes each
//! value once, and so does the density; slow and fast movers alternate, so that few or many of the
//! queried bodies have just been woken.

use super::design::{DENSITIES, PARTNERS, SCENES, resample, sizes};
use super::level::CacheLevel;
use crate::effects::{EffectsSpec, motion, rest, walls};
use crate::number::{Interval, Positive};
use crate::random::Stream;
use crate::scene::Scene;
use toml::Spanned;

/// The fewest bodies of a calibration scene: of fewer, one mover is too many to keep the others.
const FEWEST_BODIES: usize = 512;
/// The intended shares of bodies that are queried per frame, below a sixteenth.
const QUERIED_SHARES: [f64; DENSITIES] = [0.003, 0.006, 0.012, 0.022, 0.04];
/// Bodies that a mover keeps awake per partner that it would touch.
const WOKEN_PER_PARTNER: f64 = 1.0;
/// Radii that slow and fast movers travel per step.
const RADII_PER_STEP: [f32; 2] = [0.05, 1.0];
/// The limit of speed for rest, and the speed of bodies that aren't movers, in radii per step.
const REST_LIMIT: f32 = 0.01;
const SLOW_SPEED: f32 = 0.002;
/// The seed of all calibration draws of worlds.
const SEED: u64 = 0xca11_b8a7_e002_0000;

/// The calibration scenes of a scene with rest.
pub(super) fn scenes(scene: &Scene) -> impl ExactSizeIterator<Item = Scene> + '_ {
    let sizes = sizes(CacheLevel::of(scene.bodies.len()));
    (0..SCENES).map(move |number| {
        let (size, share) = (number / DENSITIES, number % DENSITIES);
        let bodies = sizes[size].max(FEWEST_BODIES);
        let partners = PARTNERS[(2 * share + size) % DENSITIES];
        let movers = QUERIED_SHARES[share] / (1.0 + WOKEN_PER_PARTNER * partners);
        sleeping(
            resample(scene, bodies, partners / bodies as f64, number as u64),
            (movers * bodies as f64).ceil() as usize,
            RADII_PER_STEP[(share + size) % 2],
            number as u64,
        )
    })
}

/// The scene with this number of movers, which travel so far per step; all others sleep until they
/// are touched.
fn sleeping(mut scene: Scene, movers: usize, radii_per_step: f32, stream: u64) -> Scene {
    let mut draws = Stream::new(SEED, stream);
    let bodies = &scene.bodies;
    let dynamic: Vec<usize> = (0..bodies.len()).filter(|&b| bodies.dynamic[b]).collect();
    let radii = bodies.shape.iter().map(|&shape| scene.shapes[shape as usize].ball.radius);
    let radius = radii.sum::<f32>() / bodies.len() as f32;
    let speed = |radii: f32| radii * radius / scene.dt;
    let movers = movers.min(dynamic.len());
    let mut is_mover = vec![false; bodies.len()];
    (0..movers).for_each(|n| is_mover[dynamic[n * dynamic.len() / movers]] = true);
    for &body in &dynamic {
        let speed = speed(if is_mover[body] { radii_per_step } else { SLOW_SPEED });
        scene.velocities.linear[body] = draws.vector(Interval { min: speed, max: speed });
    }
    scene.effects = EffectsSpec {
        motion: listed(motion::Settings),
        walls: listed(walls::Settings::Specular),
        rest: listed(rest::Settings {
            speed: Positive(speed(REST_LIMIT)),
            rate: None,
            after: Positive(scene.dt),
        }),
        spin: scene.effects.spin.take(),
        ..EffectsSpec::default()
    };
    scene
}

fn listed<T>(settings: T) -> Option<Spanned<T>> {
    Some(Spanned::new(0..0, settings))
}
