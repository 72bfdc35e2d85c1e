//! Which volume and k to use for one scene: every candidate timed and counted on it, without an
//! exact truth.
//!
//! All variants report every pair that meets, so fewer reported pairs are fewer false ones: T +
//! Np·Cp needs no truth.

use serde::Serialize;

use super::TradeoffError;
use super::decide::choose_measured;
use super::density::{lines, variants};
use super::pays::{Line, Stretch, envelope};
use crate::measure::conditions::Conditions;
use crate::measure::estimate::Estimate;
use crate::scene::SceneFile;
use sdop::simd::Tier;

/// The most frames of the scene that are looked at: enough to see its pairs, few enough for a
/// minute.
pub const FRAMES: u32 = 200;
/// Sample frames among them.
const SAMPLES: u32 = 10;

/// What to use, and the numbers behind it.
#[derive(Clone, Debug, Serialize)]
pub struct Advice {
    /// The scene.
    pub scene: String,
    /// Its bodies.
    pub bodies: usize,
    /// Frames that were looked at, from the first on.
    pub frames: u32,
    /// Seconds of a narrow-phase check.
    pub check: f64,
    /// The cheapest variant in total.
    pub best: String,
    /// Its total T + Np·Cp, seconds per frame.
    pub total: f64,
    /// What can't be told from it.
    pub tied: Vec<String>,
    /// The cheapest variant as a check grows dearer.
    pub cheapest: Vec<Stretch>,
    /// Every candidate.
    pub candidates: Vec<Candidate>,
    /// What else the machine did.
    pub conditions: Conditions,
}

/// One candidate.
#[derive(Clone, Debug, Serialize)]
pub struct Candidate {
    /// The variant.
    pub name: String,
    /// T, seconds per warm frame.
    pub time: Estimate,
    /// Np: pairs that it leaves per frame.
    pub pairs: f64,
    /// T + Np·Cp, seconds per frame.
    pub total: f64,
    /// By how much that lies above the best one's, pass by pass.
    pub beyond: Estimate,
}

/// Looks at a scene. `check` is what a narrow-phase check takes, in seconds.
///
/// # Errors
/// A scene that can't be built or run.
pub fn advise(file: &SceneFile, check: f64, tier: Tier) -> Result<Option<Advice>, TradeoffError> {
    let before = Conditions::before();
    let mut scene = file.build()?;
    scene.frames = scene.frames.min(FRAMES);
    let lines = lines(&scene, &variants(&scene.cull), tier, SAMPLES)?;
    let Some(choice) = choose_measured(&lines, check) else {
        return Ok(None);
    };
    let Some(best) = lines.iter().find(|line| line.name == choice.best) else {
        return Ok(None);
    };
    let candidate = |line: &Line| Candidate {
        name: line.name.clone(),
        time: Estimate::in_order(&line.times),
        pairs: line.pairs,
        total: line.time() + check * line.pairs,
        beyond: line.beyond(best, check, [line.pairs, best.pairs]),
    };
    let mut candidates: Vec<Candidate> = lines.iter().map(candidate).collect();
    candidates.sort_by(|a, b| a.total.total_cmp(&b.total));
    Ok(Some(Advice {
        scene: scene.name,
        bodies: scene.bodies.len(),
        frames: scene.frames,
        check,
        best: choice.best,
        total: choice.total,
        tied: choice.tied,
        cheapest: envelope(&lines),
        conditions: before.after(candidates.iter().map(|candidate| candidate.time)),
        candidates,
    }))
}
