//! The price of safety: margins on against off, f32 against f64, tier by tier: time and extra pairs side by side.
//!
//! Margins live in the volumes, not in the tests. "Off" is therefore the same culler on volumes shrunk by what it will add,
//! so that it tests the true ones to the last bit or two; nobody can ask for that from outside of this measurement,
//! since it loses touching pairs. f64 is the reference's plain scalar loops: the same predicate, uninflated.

use std::time::Instant;

use sdop_reference as reference;
use serde::{Deserialize, Serialize};

use super::TradeoffError;
use super::truth::Sample;
use crate::culler::Culler;
use crate::lab::measure::turns::median;
use crate::lab::scene::Scene;
use crate::lab::verify::judged::{Shapes, overlap};
use crate::rounding::pose::norm;
use crate::rounding::slab::{SLAB_FLOOR, SLAB_MARGIN};
use crate::rounding::sphere::inflate_radius;
use crate::settings::{CullSettings, Strategy, Updates};
use crate::simd::Tier;
use crate::volume::Shape;

/// One arithmetic in one tier.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SafetyRow {
    /// The strategy.
    pub strategy: String,
    /// "f32", "f32, no margins" or "f64".
    pub arithmetic: String,
    /// The SIMD tier.
    pub simd: String,
    /// Pairs reported on the sample frames.
    pub reported: u64,
    /// Reported here, not by the f64 predicate.
    pub extra: u64,
    /// Reported by the f64 predicate, not here.
    pub lost: u64,
    /// Median seconds a frame.
    pub seconds: f64,
}

/// Spheres alone and S-DOP with the scene's or-DOPs, in every tier that this CPU has.
///
/// # Errors
/// Settings that can't be carried out, numbers that the reference refuses.
pub fn compare(scene: &Scene, samples: &[Sample]) -> Result<Vec<SafetyRow>, TradeoffError> {
    let bare: Vec<Shape> = scene.shapes.iter().map(without_margins).collect();
    let mut rows = Vec::new();
    for strategy in [Strategy::Sphere, Strategy::SDopSequential] {
        let settings = CullSettings {
            strategy,
            updates: Updates::Eager,
            ..scene.cull.clone()
        };
        let (plain, seconds) = in_f64(scene, &settings, samples)?;
        for tier in Tier::available() {
            for (arithmetic, shapes) in [("f32", &scene.shapes), ("f32, no margins", &bare)] {
                let mut culler = Culler::new(shapes, &scene.bodies, &settings, tier)?;
                let (mut frames, mut seconds) = (Vec::new(), Vec::new());
                for sample in samples {
                    for _ in 0..3 {
                        let start = Instant::now();
                        culler.cull(&sample.bodies);
                        seconds.push(start.elapsed().as_secs_f64());
                    }
                    frames.push(culler.pairs().sorted());
                }
                rows.push(row(
                    strategy,
                    arithmetic,
                    tier.name(),
                    &frames,
                    &plain,
                    seconds,
                ));
            }
        }
        rows.push(row(strategy, "f64", "plain", &plain, &plain, seconds));
    }
    Ok(rows)
}

type Frames = Vec<Vec<[u32; 2]>>;

fn row(
    strategy: Strategy,
    arithmetic: &str,
    simd: &str,
    frames: &Frames,
    plain: &Frames,
    seconds: Vec<f64>,
) -> SafetyRow {
    let beyond = |some: &Frames, others: &Frames| {
        let frames = some.iter().zip(others);
        let new = frames.map(|(some, others)| {
            some.iter()
                .filter(|pair| others.binary_search(pair).is_err())
                .count() as u64
        });
        new.sum()
    };
    SafetyRow {
        strategy: strategy.to_string(),
        arithmetic: arithmetic.to_owned(),
        simd: simd.to_owned(),
        reported: frames.iter().map(|pairs| pairs.len() as u64).sum(),
        extra: beyond(frames, plain),
        lost: beyond(plain, frames),
        seconds: median(seconds),
    }
}

/// The shape with its volumes shrunk by the margins that the culler adds.
#[must_use]
pub fn without_margins(shape: &Shape) -> Shape {
    let mut bare = shape.clone();
    let radius = &mut bare.ball.radius;
    while *radius > 0.0 && inflate_radius(*radius) > shape.ball.radius {
        *radius = radius.next_down();
    }
    let reach = f64::from(shape.reach) + norm(shape.ball.centre.to_array());
    let ordop = &mut bare.ordop;
    let coefficients = ordop.directions.coefficients().iter();
    for ((lo, hi), &c) in ordop.lo.iter_mut().zip(&mut ordop.hi).zip(coefficients) {
        let direction = ordop.basis.direction(c).to_array();
        let margin = norm(direction) * (SLAB_MARGIN * reach + SLAB_FLOOR);
        *lo = (f64::from(*lo) + margin) as f32;
        *hi = (f64::from(*hi) - margin) as f32;
    }
    bare
}

/// The reference's pairs and median seconds.
fn in_f64(
    scene: &Scene,
    settings: &CullSettings,
    samples: &[Sample],
) -> Result<(Frames, Vec<f64>), TradeoffError> {
    let shapes = Shapes::new(scene.shapes.clone())?;
    let strategy = match settings.strategy {
        Strategy::Sphere => reference::Strategy::Sphere,
        _ => reference::Strategy::Sequential,
    };
    let (mut frames, mut seconds) = (Vec::new(), Vec::new());
    for sample in samples {
        let judged = shapes.bodies(&sample.bodies)?;
        let start = Instant::now();
        let pairs = reference::pairs(&judged, strategy, overlap(settings.overlap));
        seconds.push(start.elapsed().as_secs_f64());
        frames.push(pairs.into_iter().map(|(i, j)| [i, j]).collect());
    }
    Ok((frames, seconds))
}
