//! The price of safety, in time and in extra pairs: culling with and without margins, in f32 and in
//! f64, in each tier.
//!
//! Margins are in the volumes, not in the tests. "No margins" is therefore the same culler on
//! volumes that are shrunk by the margins it will add, so that it tests the true ones to within a
//! bit or two. Only this measurement can do that, since it loses touching pairs. f64 is the
//! reference's plain scalar loops: the same predicate without margins.

use sdop_reference as reference;
use serde::{Deserialize, Serialize};

use super::TradeoffError;
use super::truth::windows;
use crate::measure::culling::Culling;
use crate::measure::turns::{Quartiles, Regime, Turns, turn_frames};
use crate::scene::Scene;
use sdop::bodies::Bodies;
use sdop::choice::choices;
use sdop::rounding::pose::norm;
use sdop::rounding::slab::{SLAB_FLOOR, SLAB_MARGIN};
use sdop::rounding::sphere::inflate_radius;
use sdop::settings::{CullSettings, Strategy, Updates};
use sdop::simd::Tier;
use sdop::volume::Shape;
use sdop_judge::contestant::Contestant;
use sdop_judge::ours::reference_shapes::{Shapes, overlap};

choices! {
    /// How the same predicate is computed.
    Arithmetic, "arithmetic", {
        /// The culler's.
        F32 = "f32",
        /// The culler's, on volumes shrunk by the margins.
        Bare = "f32, no margins",
        /// The reference's plain loops.
        F64 = "f64",
    }
}

/// One arithmetic in one tier.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SafetyRow {
    /// The strategy.
    pub strategy: Strategy,
    /// How it is computed.
    pub arithmetic: Arithmetic,
    /// The SIMD tier.
    pub simd: String,
    /// Pairs reported on the sample frames.
    pub reported: u64,
    /// Pairs reported here, but not by the f64 predicate.
    pub extra: u64,
    /// Pairs reported by the f64 predicate, but not here.
    pub lost: u64,
    /// Seconds of a warm frame.
    pub seconds: Quartiles,
}

/// The measured strategies: those with the volumes that [`without_margins`] shrinks, first one
/// alone, then both. Volumes that are refitted each frame get their margins in the frame.
pub const STRATEGIES: [Strategy; 2] = [Strategy::Sphere, Strategy::SDopSequential];

/// The [`STRATEGIES`] with the scene's or-DOPs, in every tier of this CPU, in turns on `count`
/// sample frames and the frames after each.
///
/// # Errors
/// The settings can't be carried out, or the reference rejects a number.
pub fn compare(scene: &Scene, count: u32) -> Result<Vec<SafetyRow>, TradeoffError> {
    let bare: Vec<Shape> = scene.shapes.iter().map(without_margins).collect();
    let shapes = Shapes::new(scene.shapes.clone())?;
    let mut rows = Vec::new();
    for strategy in STRATEGIES {
        let settings = CullSettings { strategy, updates: Updates::Eager, ..scene.cull.clone() };
        let mut labels = vec![(Arithmetic::F64, None)];
        let mut contestants: Vec<Box<dyn Contestant + '_>> =
            vec![Box::new(F64Contestant::new(&shapes, &settings))];
        for tier in Tier::available() {
            for (arithmetic, shapes) in
                [(Arithmetic::F32, &scene.shapes), (Arithmetic::Bare, &bare)]
            {
                let culling = Culling::new(shapes, &scene.bodies, &settings, tier)?;
                contestants.push(Box::new(culling));
                labels.push((arithmetic, Some(tier)));
            }
        }
        let mut found = vec![ContestantPairs::default(); contestants.len()];
        let mut turns = Turns::default();
        for (_, poses) in windows(scene, count, turn_frames(scene.bodies.len()))? {
            // The reference accepts all poses of the contract.
            poses.iter().try_for_each(|bodies| shapes.bodies(bodies).map(drop))?;
            turns.round(&mut contestants, &poses, |timed| {
                let found = &mut found[timed.number];
                if timed.frame == 0 {
                    let mut pairs = timed.contestant.pairs();
                    pairs.sort_unstable();
                    found.frames.push(pairs);
                }
                if timed.regime == Regime::Warm {
                    found.seconds.push(timed.seconds);
                }
            });
        }
        let row = |(label, of)| safety_row(strategy, label, of, &found[0].frames);
        rows.extend(labels.iter().zip(&found).map(row));
    }
    Ok(rows)
}

/// The reference's plain loops, including its updates.
struct F64Contestant<'a> {
    shapes: &'a Shapes,
    strategy: reference::Strategy<'static>,
    overlap: reference::Overlap,
    pairs: Vec<[u32; 2]>,
}

impl<'a> F64Contestant<'a> {
    fn new(shapes: &'a Shapes, settings: &CullSettings) -> Self {
        Self {
            shapes,
            strategy: match settings.strategy {
                Strategy::Sphere => reference::Strategy::Sphere,
                _ => reference::Strategy::Sequential,
            },
            overlap: overlap(settings.overlap),
            pairs: Vec::new(),
        }
    }
}

impl Contestant for F64Contestant<'_> {
    fn frame(&mut self, bodies: &Bodies) {
        let judged = self.shapes.bodies(bodies).unwrap_or_default();
        let pairs = reference::pairs(&judged, self.strategy, self.overlap);
        self.pairs.clear();
        self.pairs.extend(pairs.into_iter().map(|(i, j)| [i, j]));
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.pairs.clone()
    }
}

type Frames = Vec<Vec<[u32; 2]>>;

/// The pairs of one contestant, and the seconds of its warm frames.
#[derive(Clone, Default)]
struct ContestantPairs {
    frames: Frames,
    seconds: Vec<f64>,
}

fn safety_row(
    strategy: Strategy,
    (arithmetic, tier): &(Arithmetic, Option<Tier>),
    found: &ContestantPairs,
    plain: &Frames,
) -> SafetyRow {
    let beyond = |some: &Frames, others: &Frames| {
        let frames = some.iter().zip(others);
        let new = frames.map(|(some, others)| {
            some.iter().filter(|pair| others.binary_search(pair).is_err()).count() as u64
        });
        new.sum()
    };
    SafetyRow {
        strategy,
        arithmetic: *arithmetic,
        simd: tier.map_or("plain", |tier| tier.name()).to_owned(),
        reported: found.frames.iter().map(|pairs| pairs.len() as u64).sum(),
        extra: beyond(&found.frames, plain),
        lost: beyond(plain, &found.frames),
        seconds: Quartiles::of(found.seconds.clone()),
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
    let reach = f64::from(shape.reach) + norm(shape.ball.centre);
    let ordop = &mut bare.ordop;
    let coefficients = ordop.directions.coefficients().iter();
    for ((lo, hi), &c) in ordop.lo.iter_mut().zip(&mut ordop.hi).zip(coefficients) {
        let direction = ordop.basis.direction(c);
        let margin = norm(direction) * (SLAB_MARGIN * reach + SLAB_FLOOR);
        *lo = (f64::from(*lo) + margin) as f32;
        *hi = (f64::from(*hi) - margin) as f32;
    }
    bare
}
