//! The calibration scenes: which counts vary, and which stay the same.
//!
//! They depend on a scene's shapes and settings and on the [level](super::level) of its working
//! set, but not on its number of bodies, box, poses or seed. Therefore scenes of one kind share
//! their prices, and no price is measured on the scene that it predicts. Every size is placed at
//! every density. At one size, all densities have the same updates, bodies and (with all pairs)
//! tests, so that their times differ by the price of hits. At one density, sizes differ in all
//! counts, and tests grow faster than bodies. The smallest size is below every level: there the
//! price per frame is most of the time, while with hundreds of bodies it is small compared with the
//! price of tests. (Without the smallest size, times that scatter by 2 % would determine the price
//! per frame to ± 200 % and the price per body to ± 40 %.)

use super::level::CacheLevel;
use crate::effects::Velocities;
use crate::measure::variant::Variant;
use crate::number::Interval;
use crate::random::Stream;
use crate::scene::Scene;
use sdop::bodies::Bodies;
use sdop::settings::{Finder, Interest};

/// Sizes of one level, the smallest one included.
const SIZES: usize = 4;
/// Densities of each size.
pub(super) const DENSITIES: usize = 5;
/// Bodies of the smallest calibration scene.
const FEWEST_BODIES: usize = 16;
/// A level's largest size is at most this multiple of its fewest bodies: all pairs of more would
/// take too long, and would be in the same caches.
const MOST_SIZE_RATIO: f64 = 4.0;
/// Densities if every pair is tested: shares of pairs whose balls meet.
const MEETING_SHARES: [f64; DENSITIES] = [0.0002, 0.002, 0.01, 0.04, 0.12];
/// Densities if a finder rejects most pairs: numbers of balls that meet one ball.
pub(super) const PARTNERS: [f64; DENSITIES] = [0.25, 1.0, 2.0, 5.0, 12.0];
/// The seed of all calibration draws; scenes count their seeds from 1.
const SEED: u64 = 0xca11_b8a7_e000_0000;

/// The number of calibration scenes.
pub const SCENES: usize = SIZES * DENSITIES;

/// The step from a calibration scene of a round to the next one. It shares no divisor with the
/// number of scenes.
pub(super) const SCENE_STEP: usize = 7;

/// The calibration scenes of a scene.
pub fn scenes(scene: &Scene) -> impl ExactSizeIterator<Item = Scene> + '_ {
    let tests_all = scene.cull.pairs == Finder::AllPairs;
    let grid = grid(CacheLevel::of(scene.bodies.len()));
    (0..SCENES).map(move |number| {
        let (bodies, mut share) = grid[number];
        if !tests_all {
            share = share.min(PARTNERS[number % DENSITIES] / bodies as f64);
        }
        resample(scene, bodies, share, number as u64)
    })
}

/// Every size of a level at every share of pairs whose balls meet.
pub(super) fn grid(level: CacheLevel) -> [(usize, f64); SCENES] {
    let sizes = sizes(level);
    std::array::from_fn(|number| (sizes[number / DENSITIES], MEETING_SHARES[number % DENSITIES]))
}

/// The smallest size, and those of a level, in a geometric sequence.
pub(super) fn sizes(level: CacheLevel) -> [usize; SIZES] {
    let [fewest, most] = level.bodies().map(|bodies| bodies as f64);
    let fewest = fewest.max(FEWEST_BODIES as f64);
    let most = match level {
        CacheLevel::L1 => most,
        _ => most.min(MOST_SIZE_RATIO * fewest),
    };
    std::array::from_fn(|number| {
        let Some(number) = number.checked_sub(1) else {
            return FEWEST_BODIES;
        };
        let place = (number as f64 + 0.5) / (SIZES - 1) as f64;
        (fewest * (most / fewest).powf(place)).round() as usize
    })
}

/// `n` of the scene's bodies with new poses and velocities, in a box in which this share of their
/// balls meets.
///
/// They keep the scene's order, in which bodies of one shape are together: such pairs are faster to
/// test than mixed ones.
pub(super) fn resample(scene: &Scene, n: usize, share: f64, stream: u64) -> Scene {
    let mut draws = Stream::new(SEED, stream);
    let original = &scene.bodies;
    let body = |i: usize| i * original.len() / n;
    let radius = |i: usize| scene.shapes[original.shape[body(i)] as usize].ball.radius;
    let side = side((0..n).map(radius), share);
    let (mut bodies, mut velocities) = (Bodies::default(), Velocities::default());
    for i in 0..n {
        let (body, limit) = (body(i), 0.5 * side - radius(i));
        bodies.shape.push(original.shape[body]);
        bodies.dynamic.push(original.dynamic[body]);
        bodies.rotation.push(draws.rotation());
        let at = [(); 3].map(|()| draws.between(-limit, limit));
        bodies.translation.push(at);
        for (from, to) in [
            (&scene.velocities.linear, &mut velocities.linear),
            (&scene.velocities.angular, &mut velocities.angular),
        ] {
            let [x, y, z] = from[body];
            let length = libm::sqrtf(x * x + y * y + z * z);
            to.push(draws.vector(Interval { min: length, max: length }));
        }
    }
    Scene { bodies, velocities, side: Some(side), seed: SEED, share: None, ..scene.clone() }
}

/// The side of the box in which this share of balls with these radii meets, at least as wide as the
/// widest.
fn side(radii: impl Iterator<Item = f32> + Clone, share: f64) -> f32 {
    let n = radii.clone().count() as f64;
    let mean = |power: i32| radii.clone().map(|r| f64::from(r).powi(power)).sum::<f64>() / n;
    // The mean of (r + s)³ over two independent radii.
    let reach = 2.0 * mean(3) + 6.0 * mean(2) * mean(1);
    let volume = 4.0 / 3.0 * std::f64::consts::PI * reach / share;
    let widest = radii.clone().fold(0.0, f32::max);
    // Centres are at least a radius away from the walls.
    (libm::cbrt(volume) as f32 + 2.0 * widest).max(3.0 * widest)
}

/// A variant for a calibration scene of `n` bodies: bodies of interest are the first ones, as many
/// as there are among all.
pub(super) fn adapted(variant: &Variant, n: usize) -> Variant {
    let fitting = |body: u32| body.min(n as u32 - 1);
    let mut variant = variant.clone();
    match &mut variant.settings.interest {
        Some(Interest::Bodies(list)) => {
            list.iter_mut().for_each(|body| *body = fitting(*body));
            list.sort_unstable();
            list.dedup();
        }
        Some(Interest::Cone(cone)) => cone.body = cone.body.map(fitting),
        None => {}
    }
    variant
}
