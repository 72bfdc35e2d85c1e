//! Sweeps what the paper doesn't state: where bodies start, what a wall does, how many frames are
//! counted, and which or-DOP is meant. Each combination is an interpretation of Table 1; its
//! likelihood says how well it explains the table.
//!
//! A cell's error is taken as normal in the logarithm of ours over the paper's, with one width for
//! all sixteen cells that fits best: ln L = −(n/2)(ln 2πσ² + 1), σ² the mean square.
//! Interpretations that differ by less than about 2 in ln L cannot be distinguished. The or-DOP row
//! is taken as sphere × sequential, which the runs support to a percent.

use std::num::NonZeroU32;

use serde::Serialize;
use toml::Spanned;

use super::paper::{TABLE_1, TABLE_1_BODIES};
use super::plan::{ExperimentPlan, ReproduceError};
use crate::effects::walls;
use crate::measure::culling::Culling;
use crate::measure::variant::Variant;
use crate::number::Positive;
use crate::scene::file::Placement;
use crate::scene::{Scene, SceneFile};
use crate::simulate::{SimulationError, Trajectory};
use sdop::choice::choices;
use sdop::counters::Counters;
use sdop::settings::{Axes, CullSettings, DirectionSet, Overlap, Strategy};
use sdop::simd::Tier;
use sdop_judge::contestant::Contestant;

/// Frames after which counts are looked at.
const FRAME_COUNTS: [u32; 4] = [1, 10, 60, 400];
/// The most seeds of each interpretation.
const SEEDS: usize = 4;

choices! {
    /// Where bodies start.
    Start, "start", {
        /// Anywhere in the box.
        Uniform = "uniform",
        /// Each group of alike bodies in a ball of half the box's width.
        Balls = "balls",
        /// In a slice across the box, a quarter as thick.
        Slice = "a slice",
    }
}

choices! {
    /// What a wall does to a velocity.
    Bounce, "bounce", {
        /// Mirrors it.
        Specular = "specular",
        /// Turns it round, as the paper's equation 3 read literally.
        Reverse = "reverse",
    }
}

/// One interpretation and how well it explains Table 1.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Interpretation {
    /// Where bodies start.
    pub start: Start,
    /// What a wall does.
    pub bounce: Bounce,
    /// Frames counted, from the first on.
    pub frames: u32,
    /// The or-DOP's half-spaces.
    pub k: usize,
    /// Its axes.
    pub axes: Axes,
    /// Its test.
    pub overlap: Overlap,
    /// Percentages: sphere, or-DOP, sequential and list, each for N = 50, 150, 300, 500.
    pub percent: [[f64; 4]; 4],
    /// The width of the error that fits best, in ln.
    pub sigma: f64,
    /// ln L.
    pub likelihood: f64,
}

/// Sphere tests and hits, or-DOP tests and hits: for each N of Table 1.
pub type TestCounts = [[u64; 4]; 4];

/// Every way to read what the paper doesn't state.
#[must_use]
pub fn ways() -> Vec<(Start, Bounce)> {
    let bounces = |&start: &Start| Bounce::ALL.iter().map(move |&bounce| (start, bounce));
    Start::ALL.iter().flat_map(bounces).collect()
}

/// What is counted under one reading: after every length, for every kind of or-DOP.
///
/// # Errors
/// Scenes that can't be read, built or simulated.
pub fn counted(
    plan: &ExperimentPlan,
    way: (Start, Bounce),
) -> Result<Vec<TestCounts>, ReproduceError> {
    let lengths = lengths(plan);
    let mut all = vec![[[0; 4]; 4]; lengths.len() * kinds().len()];
    for (column, bodies) in TABLE_1_BODIES.into_iter().enumerate() {
        let counters = count(plan, way, bodies, &lengths)?;
        for (counted, counters) in all.iter_mut().zip(counters.iter().flatten()) {
            let (sphere, ordop) = (counters.sphere, counters.ordop);
            counted[column] = [sphere.tests, sphere.hits, ordop.tests, ordop.hits];
        }
    }
    Ok(all)
}

/// What a reading's counts say of Table 1.
#[must_use]
pub fn interpretations(
    plan: &ExperimentPlan,
    (start, bounce): (Start, Bounce),
    counted: &[TestCounts],
) -> Vec<Interpretation> {
    let lengths = lengths(plan);
    let of = |frames: u32| kinds().into_iter().map(move |kind| (frames, kind));
    let all = lengths.into_iter().flat_map(of).zip(counted);
    let interpretation =
        |((frames, kind), counted)| interpretation((start, bounce, frames), kind, counted);
    all.map(interpretation).collect()
}

/// The likeliest first.
pub fn sort(interpretations: &mut [Interpretation]) {
    interpretations.sort_by(|a, b| b.likelihood.total_cmp(&a.likelihood));
}

/// All interpretations, the likeliest first.
///
/// # Errors
/// Scenes that can't be read, built or simulated.
pub fn sweep(plan: &ExperimentPlan) -> Result<Vec<Interpretation>, ReproduceError> {
    let mut found = Vec::new();
    for way in ways() {
        found.extend(interpretations(plan, way, &counted(plan, way)?));
    }
    sort(&mut found);
    Ok(found)
}

/// After how many frames counts are looked at.
fn lengths(plan: &ExperimentPlan) -> Vec<u32> {
    let mut lengths = FRAME_COUNTS.map(|length| length.min(plan.frames)).to_vec();
    lengths.dedup();
    lengths
}

/// Every kind of or-DOP.
fn kinds() -> Vec<(DirectionSet, Axes, Overlap)> {
    let mut kinds = Vec::new();
    for &k in DirectionSet::ALL {
        for &axes in Axes::ALL {
            kinds.extend(Overlap::ALL.iter().map(|&overlap| (k, axes, overlap)));
        }
    }
    kinds
}

/// Counters of every kind of or-DOP after every length, summed over seeds.
fn count(
    plan: &ExperimentPlan,
    assumed: (Start, Bounce),
    bodies: usize,
    lengths: &[u32],
) -> Result<Vec<Vec<Counters>>, ReproduceError> {
    let mut sums = vec![vec![Counters::default(); kinds().len()]; lengths.len()];
    let path = plan.scenes.join(format!("paper-{bodies}.toml"));
    let usual = SceneFile::read(&path)?;
    for &seed in plan.seeds.iter().take(SEEDS) {
        let mut file = assume(&usual, assumed);
        file.spec.seed = seed;
        let scene = file.build()?;
        for (sums, counted) in sums.iter_mut().zip(run(&scene, lengths, plan.tier)?) {
            for (sum, counted) in sums.iter_mut().zip(counted) {
                sum.sphere.tests += counted.sphere.tests;
                sum.sphere.hits += counted.sphere.hits;
                sum.ordop.tests += counted.ordop.tests;
                sum.ordop.hits += counted.ordop.hits;
            }
        }
    }
    Ok(sums)
}

/// The counters of every kind of or-DOP after every length.
fn run(scene: &Scene, lengths: &[u32], tier: Tier) -> Result<Vec<Vec<Counters>>, SimulationError> {
    let mut cullers: Vec<Culling> = Vec::new();
    for (k, axes, overlap) in kinds() {
        let settings =
            CullSettings { strategy: Strategy::SDopBatch, k, axes, overlap, ..scene.cull.clone() };
        cullers.push(Variant::of(String::new(), settings).culling(scene, tier)?);
    }
    let mut looks = Vec::new();
    let last = lengths.last().copied().unwrap_or(0);
    let mut trajectory = Trajectory::new(scene)?.with_frames(last);
    while let Some(bodies) = trajectory.advance()? {
        cullers.iter_mut().for_each(|culler| culler.frame(bodies));
        if lengths.contains(&trajectory.next_number()) {
            looks.push(cullers.iter().map(Culling::counters).collect());
        }
    }
    cullers.iter().try_for_each(Culling::accepted)?;
    Ok(looks)
}

fn interpretation(
    (start, bounce, frames): (Start, Bounce, u32),
    (k, axes, overlap): (DirectionSet, Axes, Overlap),
    counted: &TestCounts,
) -> Interpretation {
    let share = |hits: u64, tests: u64| 100.0 * hits as f64 / tests as f64;
    let sphere = counted.map(|[tests, hits, ..]| share(hits, tests));
    let sequential = counted.map(|[.., tests, hits]| share(hits, tests));
    let list = counted.map(|[_, listed, tests, hits]| share(hits, tests + listed));
    let alone = counted.map(|[tests, .., hits]| share(hits, tests));
    let percent = [sphere, alone, sequential, list];
    let (sigma, likelihood) = likelihood(&percent);
    Interpretation { start, bounce, frames, k: k.k(), axes, overlap, percent, sigma, likelihood }
}

/// σ and ln L of percentages in the order of the paper's rows.
fn likelihood(percent: &[[f64; 4]; 4]) -> (f64, f64) {
    let rows = percent.iter().zip(&TABLE_1);
    let errors: Vec<f64> = rows
        .flat_map(|(ours, (_, paper))| ours.iter().zip(paper).map(|(o, p)| (o / p).ln()))
        .collect();
    let n = errors.len() as f64;
    let square = errors.iter().map(|error| error * error).sum::<f64>() / n;
    let likelihood = -0.5 * n * ((2.0 * std::f64::consts::PI * square).ln() + 1.0);
    (square.sqrt(), likelihood)
}

/// The scene with another start and another bounce.
fn assume(usual: &SceneFile, (start, bounce): (Start, Bounce)) -> SceneFile {
    let mut file = usual.clone();
    let spec = &mut file.spec;
    let bounds = spec.bounds.as_ref().map(Spanned::get_ref);
    let side = bounds.and_then(|bounds| bounds.side.as_ref());
    let quarter = Positive(0.25 * side.map_or(1.0, |side| side.get_ref().0));
    let placement = match start {
        Start::Uniform => Placement::Uniform,
        Start::Balls => Placement::Clusters { number: NonZeroU32::MIN, radius: quarter },
        Start::Slice => Placement::Plane { thickness: quarter },
    };
    for group in &mut spec.bodies {
        group.get_mut().placement = Some(Spanned::new(0..0, placement));
    }
    if let (Bounce::Reverse, Some(walls)) = (bounce, &mut spec.effects.walls) {
        *walls.get_mut() = walls::Settings::Reverse;
    }
    file
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_paper_explains_itself_best() {
        let exact = TABLE_1.map(|(_, row)| row.map(|x| x * 1.0001));
        let off = TABLE_1.map(|(_, row)| row.map(|x| 1.5 * x));
        let ((narrow, likely), (wide, unlikely)) = (likelihood(&exact), likelihood(&off));
        assert!(narrow < 2e-4 && (wide - 1.5_f64.ln()).abs() < 1e-12);
        assert!(likely > unlikely + 50.0, "{likely} {unlikely}");
    }
}
