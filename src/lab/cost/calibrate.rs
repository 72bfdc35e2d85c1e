//! Calibration: Cu, Cv and Co of every volume, from seeded runs that no prediction is compared with.
//!
//! The runs resample the scene ([`scenes`]): other numbers of bodies, other boxes, other seeds. Each stage's seconds are
//! then explained by its counts ([`fit`]): an update stage by Nu, a finding stage by frames, bodies, misses and
//! hits. Prices are therefore marginal: a hit costs what one more hit costs among the misses around it, with the vector of
//! lanes that it keeps busy. Dividing a run's own seconds by its own counts would predict nothing.

use super::VolumeCosts;
use super::fit::{self, Measurement};
use super::predict::{Price, Prices, Volume};
use crate::bodies::Bodies;
use crate::lab::measure::turns::{Trial, side_by_side, time};
use crate::lab::number::Interval;
use crate::lab::random::Stream;
use crate::lab::scene::Scene;
use crate::lab::simulate::SimulationError;
use crate::overlap::ordop::PosedOrDops;
use crate::pairs::PairList;
use crate::settings::{Axes, Strategy};
use crate::simd::Tier;
use crate::volume::{Ball, Hull, Shape};

/// Bodies of the calibration scenes, as parts of the scene's number.
const SIZES: [f64; 4] = [0.07, 0.23, 0.64, 1.3];
/// Sides of the calibration scenes' boxes, as multiples of the scene's.
const SIDES: [f64; 3] = [0.6, 1.0, 1.6];
/// Where all calibration draws start; scenes count their seeds from 1.
const SEED: u64 = 0xca11_b8a7_e000_0000;
/// The fewest bodies of a calibration scene.
const FEWEST: usize = 24;
/// Candidate pairs, if all are, after which a calibration run may end.
const PAIRS: f64 = 8e6;

/// The number of calibration scenes.
pub const SCENES: usize = SIZES.len() * SIDES.len();

/// How long to calibrate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// The most frames a calibration scene.
    pub frames: u32,
    /// How often each shape's volumes are built.
    pub builds: usize,
}

/// Prices of the volumes of `strategies` with the scene's shapes, settings and pair finder, in the tier `tier`.
/// `done` hears how many of the [`scenes`] are measured.
///
/// # Errors
/// Settings that can't be carried out, effects that can't be simulated.
pub fn calibrate(
    scene: &Scene,
    strategies: &[Strategy],
    tier: Tier,
    effort: Effort,
    mut done: impl FnMut(usize),
) -> Result<Prices, SimulationError> {
    let volumes: Vec<Volume> = Volume::ALL
        .iter()
        .copied()
        .filter(|volume| strategies.iter().any(|&s| Volume::of(s).contains(volume)))
        .collect();
    let mut runs = Vec::new();
    for (number, scene) in scenes(scene).enumerate() {
        runs.push(Run::new(&scene, &volumes, tier, effort)?);
        done(number + 1);
    }
    let mut prices = Prices::default();
    for volume in volumes {
        let mut costs = price(volume, &runs, &prices);
        let build = |shape| time(effort.builds, || construct(volume, shape, scene.cull.axes));
        costs.construct = scene.shapes.iter().map(build).sum();
        prices.0.push(Price { volume, costs });
    }
    Ok(prices)
}

/// The calibration scenes of a scene: every size in every box.
pub fn scenes(scene: &Scene) -> impl ExactSizeIterator<Item = Scene> + '_ {
    (0..SCENES).map(|number| {
        let (size, side) = (SIZES[number / SIDES.len()], SIDES[number % SIDES.len()]);
        let bodies = (scene.bodies.len() as f64 * size) as usize;
        resample(scene, bodies.max(FEWEST), side as f32, number as u64)
    })
}

/// `n` of the scene's bodies placed and set going afresh in a box of `stretch` times its side.
///
/// They keep the scene's order, in which bodies of one shape stand together: such pairs are faster to test than mixed ones.
fn resample(scene: &Scene, n: usize, stretch: f32, stream: u64) -> Scene {
    let mut draws = Stream::new(SEED, stream);
    let original = &scene.bodies;
    let side = stretch * scene.side.unwrap_or_else(|| extent(scene));
    let widest = scene
        .shapes
        .iter()
        .map(|shape| shape.ball.radius)
        .fold(0.0, f32::max);
    let side = side.max(2.0 * widest);
    let mut bodies = Bodies::default();
    for i in 0..n {
        let body = i * original.len() / n;
        let limit = 0.5 * side - scene.shapes[original.shape[body] as usize].ball.radius;
        bodies.shape.push(original.shape[body]);
        bodies.dynamic.push(original.dynamic[body]);
        bodies.rotation.push(draws.rotation());
        bodies
            .translation
            .push([(); 3].map(|()| draws.between(-limit, limit)));
        for (from, to) in [
            (&original.velocity, &mut bodies.velocity),
            (&original.spin, &mut bodies.spin),
        ] {
            let [x, y, z] = from[body];
            let length = libm::sqrtf(x * x + y * y + z * z);
            to.push(draws.vector(Interval {
                min: length,
                max: length,
            }));
        }
    }
    Scene {
        bodies,
        side: Some(side),
        seed: SEED,
        ..scene.clone()
    }
}

/// The side of the cube about the origin that holds all bodies.
fn extent(scene: &Scene) -> f32 {
    let bodies = &scene.bodies;
    let reach = |body: usize| {
        let [x, y, z] = bodies.translation[body].map(f32::abs);
        x.max(y).max(z) + scene.shapes[bodies.shape[body] as usize].reach
    };
    2.0 * (0..bodies.len()).map(reach).fold(0.0, f32::max)
}

/// One calibration scene, measured.
struct Run {
    bodies: f64,
    frames: f64,
    trials: Vec<Trial>,
    /// A list of or-DOP hits alone, where S-DOP is measured.
    hits: Option<Measurement<4>>,
}

impl Run {
    fn new(
        scene: &Scene,
        volumes: &[Volume],
        tier: Tier,
        effort: Effort,
    ) -> Result<Self, SimulationError> {
        let n = scene.bodies.len() as f64;
        let frames = ((2.0 * PAIRS / (n * n)) as u32).clamp(4, effort.frames.max(4));
        let trial = |&volume: &Volume| Trial::new(scene, measured_by(volume), tier);
        let mut trials = volumes.iter().map(trial).collect::<Result<Vec<_>, _>>()?;
        let mut hits = None;
        let refined = volumes.iter().position(|&volume| volume == Volume::Refined);
        side_by_side(scene, &mut trials, frames, |trial, frame, pairs| {
            if Some(trial) == refined && frame == 0 {
                hits = Some(time_hits(scene, pairs, tier));
            }
        })?;
        Ok(Self {
            bodies: n,
            frames: f64::from(frames),
            trials,
            hits,
        })
    }
}

/// Times the or-DOP test on a list of its hits. Refined pairs always have about the same share of hits, so that no
/// choice of scenes alone could tell the price of a hit from that of a miss.
fn time_hits(scene: &Scene, hits: &PairList, tier: Tier) -> Measurement<4> {
    let shapes = scene.shapes.iter().map(|shape| (shape, &shape.ordop));
    let posed = PosedOrDops::new(shapes, &scene.bodies, tier);
    let columns = posed.columns(scene.cull.overlap);
    let mut out = PairList::default();
    let seconds = time(9, || {
        out.clear();
        columns.test_pairs(tier, hits.first(), hits.second(), &mut out)
    });
    Measurement {
        counts: [1.0, 0.0, 0.0, hits.len() as f64],
        seconds: if hits.is_empty() { 0.0 } else { seconds },
    }
}

/// The strategy whose run shows a volume's prices.
fn measured_by(volume: Volume) -> Strategy {
    match volume {
        Volume::Sphere => Strategy::Sphere,
        Volume::OrDop => Strategy::OrDop,
        Volume::Refined => Strategy::SDopSequential,
        Volume::Aabb => Strategy::Aabb,
        Volume::KDop => Strategy::KDop,
        Volume::Obb => Strategy::Obb,
    }
}

/// Explains the stages of the volume's runs by their counts. `known` has the volumes tested before it.
fn price(volume: Volume, runs: &[Run], known: &Prices) -> VolumeCosts {
    let (mut updates, mut finding) = (Vec::new(), Vec::new());
    for run in runs {
        let Some(trial) = run
            .trials
            .iter()
            .find(|trial| trial.strategy() == measured_by(volume))
        else {
            continue;
        };
        let (medians, all) = (trial.medians(), trial.counters());
        let counters = volume.counters(all);
        let per_frame = |count: u64| count as f64 / run.frames;
        let (misses, hits) = (
            per_frame(counters.tests - counters.hits),
            per_frame(counters.hits),
        );
        let refined = volume == Volume::Refined;
        let spheres = if refined {
            known.get(Volume::Sphere).update(&all.sphere)
        } else {
            0.0
        };
        updates.push(Measurement {
            counts: [per_frame(counters.updates)],
            seconds: medians.update - spheres / run.frames,
        });
        finding.push(Measurement {
            counts: [1.0, if refined { 0.0 } else { run.bodies }, misses, hits],
            seconds: medians.ordop + if refined { 0.0 } else { medians.pair_finding },
        });
        finding.extend(run.hits.filter(|_| refined));
    }
    let [update] = fit::prices(&updates);
    let [frame, body, miss, hit] = fit::prices(&finding);
    VolumeCosts {
        construct: 0.0,
        update,
        frame,
        body,
        hit,
        miss,
    }
}

/// Builds a volume of one shape: the work behind Co.
pub fn construct(volume: Volume, shape: &Shape, axes: Axes) {
    let vertices = &shape.vertices;
    match volume {
        Volume::Sphere => drop(std::hint::black_box(Ball::smallest(vertices))),
        Volume::OrDop | Volume::Refined => {
            drop(std::hint::black_box(
                shape.ordop_along(axes, shape.ordop.directions),
            ));
        }
        Volume::Aabb | Volume::KDop => drop(std::hint::black_box(Hull::of(vertices))),
        Volume::Obb => drop(std::hint::black_box(shape.obb(&Hull::of(vertices)))),
    }
}
