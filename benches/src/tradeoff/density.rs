//! The same scene in other boxes: how the break-even of S-DOP depends on density.
//!
//! Np is proportional to density, while the time of finding pairs stays the same, so an or-DOP test
//! pays earlier in a denser scene. This needs only counts of reported pairs and times, no truth.

use serde::{Deserialize, Serialize};

use super::TradeoffError;
use super::counts::Tally;
use super::pays::{CheapestRange, Line, OrDopKind, break_even, envelope};
use super::timing::{PASSES, measure};
use super::truth::{Sample, samples};
use super::variant::{Variant, s_dops};
use crate::cost::pass::{Pass, SceneFrames, pass};
use crate::measure::turns::{FrameTimes, Regime, median};
use crate::number::Positive;
use crate::scene::{Scene, SceneError, SceneFile};
use sdop::settings::{CullSettings, Overlap, Strategy};
use sdop::simd::Tier;

/// Densities as multiples of the scene's.
pub(super) const FACTORS: [f32; 7] = [0.0625, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0];
/// Approximate number of bodies times frames of a timed run.
const RUN_BODIES: usize = 500_000;
/// Frames of a timed run whose pairs are counted.
const RUN_SAMPLES: u32 = 6;

/// Break-evens at one density.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Density {
    /// Multiple of the scene's own density.
    pub factor: f32,
    /// Mean sphere overlaps per body.
    pub partners: f64,
    /// T and Np of every compared variant.
    pub lines: Vec<Line>,
    /// The cheapest variant as Cp grows.
    pub cheapest: Vec<CheapestRange>,
    /// For each compared S-DOP: the Cp in seconds above which it is cheaper than spheres alone.
    pub break_even: Vec<BreakEven>,
}

/// The price from which an S-DOP pays.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BreakEven {
    /// The variant.
    pub name: String,
    /// Seconds per pair.
    pub cp: f64,
}

/// Runs the scene at a multiple of its density. `None` if its box is too small for that, or if it
/// has no box.
///
/// # Errors
/// Running the scene fails.
pub fn at(
    file: &SceneFile,
    factor: f32,
    tier: Tier,
    count: u32,
) -> Result<Option<Density>, TradeoffError> {
    let scene = crowded(file, factor).map(|file| built_if_possible(&file));
    let Some(scene) = scene.transpose()?.flatten() else {
        return Ok(None);
    };
    let lines = lines(&scene, &variants(&scene.cull), tier, count)?;
    Ok(Some(density(factor, scene.bodies.len(), lines)))
}

/// The scene of a file whose values were changed. `None` if it can't have them, such as spheres
/// larger than its box.
///
/// # Errors
/// Any other problem: files can't be read, or bodies are outside of the contract.
fn built_if_possible(file: &SceneFile) -> Result<Option<Scene>, SceneError> {
    match file.build() {
        Ok(scene) => Ok(Some(scene)),
        Err(SceneError::Text(_)) => Ok(None),
        Err(error) => Err(error),
    }
}

/// Times in separate passes, and pairs per frame, of some variants on a scene's sample frames.
///
/// # Errors
/// The settings can't be carried out, or a body leaves the contract.
pub fn lines(
    scene: &Scene,
    variants: &[Variant],
    tier: Tier,
    count: u32,
) -> Result<Vec<Line>, TradeoffError> {
    let passes = measure(scene, variants, tier, count)?;
    let median = |times: &FrameTimes| times.quartiles(Regime::Warm).median;
    lines_of((scene, variants, tier), &samples(scene, count)?, &passes, median)
}

/// The same on consecutive frames from the scene's first on, with the mean of warm ones, since a
/// finder may do more in some frames than in others.
///
/// # Errors
/// The settings can't be carried out, or a body leaves the contract.
pub fn lines_of_a_run(
    scene: &Scene,
    variants: &[Variant],
    tier: Tier,
) -> Result<Vec<Line>, TradeoffError> {
    let frames = scene.frames.min((RUN_BODIES / scene.bodies.len().max(1)).clamp(24, 80) as u32);
    let mut passes = Vec::new();
    for _ in 0..PASSES {
        let mut run = SceneFrames::new(scene, frames)?;
        passes.push(pass(scene, variants, tier, &mut run, None, &mut ())?);
    }
    let first = Scene { frames, ..scene.clone() };
    let mean = |times: &FrameTimes| times.mean_of(Regime::Warm);
    lines_of((scene, variants, tier), &samples(&first, RUN_SAMPLES)?, &passes, mean)
}

/// One line per variant: times from passes, pairs from sample frames.
fn lines_of(
    (scene, variants, tier): (&Scene, &[Variant], Tier),
    samples: &[Sample],
    passes: &[Pass],
    statistic: impl Fn(&FrameTimes) -> f64,
) -> Result<Vec<Line>, TradeoffError> {
    let mut lines = Vec::new();
    for (at, variant) in variants.iter().enumerate() {
        let tally = Tally::unjudged(scene, variant, tier, samples)?;
        let of = |value: &dyn Fn(&Pass) -> f64| passes.iter().map(value).collect::<Vec<f64>>();
        lines.push(Line {
            name: variant.name.clone(),
            decides: variant.decides(),
            ordop: OrDopKind::of(variant),
            times: of(&|pass| statistic(&pass.culled[at].times)),
            construct: median(of(&|pass| pass.culled[at].construct)),
            pairs: tally.reported_a_frame(),
        });
    }
    Ok(lines)
}

fn density(factor: f32, bodies: usize, lines: Vec<Line>) -> Density {
    let spheres = &lines[0];
    Density {
        factor,
        partners: 2.0 * spheres.pairs / bodies as f64,
        cheapest: envelope(&lines),
        break_even: lines
            .iter()
            .filter(|line| line.pairs < spheres.pairs && line.ordop.is_some())
            .map(|line| BreakEven { name: line.name.clone(), cp: break_even(spheres, line) })
            .collect(),
        lines,
    }
}

/// The scene at another density: the volume of its box, or its partners, scaled.
fn crowded(file: &SceneFile, factor: f32) -> Option<SceneFile> {
    let mut file = file.clone();
    let bounds = file.spec.bounds.as_mut()?.get_mut();
    if let Some(side) = &mut bounds.side {
        side.get_mut().0 /= libm::cbrtf(factor);
    }
    if let Some(Positive(partners)) = bounds.partners.as_mut().map(toml::Spanned::get_mut) {
        *partners *= factor;
    }
    Some(file)
}

/// Spheres, boxes, S-DOP with each k and the scene's axes, and hulls.
#[must_use]
pub fn variants(own: &CullSettings) -> Vec<Variant> {
    let boxes = CullSettings { strategy: Strategy::Aabb, ..own.clone() };
    let mut list = vec![Variant::spheres(own), Variant::of("aabb".into(), boxes)];
    list.extend(s_dops(own).into_iter().filter(|variant| {
        let CullSettings { axes, overlap, .. } = variant.settings;
        axes == own.axes && overlap != Overlap::Full
    }));
    list.push(Variant::hulls(own));
    list
}
