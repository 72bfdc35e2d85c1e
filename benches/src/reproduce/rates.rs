//! Frame rates (Figs 12 and 13): fps = 1/(F + t), where t is the time of culling a frame and F the
//! time of everything else in it.
//!
//! The paper's frames included rendering at an unknown price. Rates are therefore shown for two
//! values of F: zero, and a whole frame of 60 Hz, which hides all but the slowest culling.

use serde::{Deserialize, Serialize};

use super::Estimate;
use super::experiment::Results;
use super::plan::STRATEGIES;
use sdop::settings::Strategy;

/// Per-frame costs F of everything else, in seconds.
pub const OTHER_FRAME_SECONDS: [f64; 2] = [0.0, 16.7e-3];

/// One strategy's frame rate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rate {
    /// The scene.
    pub scene: String,
    /// N.
    pub bodies: usize,
    /// The strategy.
    pub strategy: Strategy,
    /// F in seconds.
    pub elsewhere: f64,
    /// t in seconds: the median over frames, averaged over seeds.
    pub culling: Estimate,
    /// Frames a second.
    pub fps: Estimate,
}

/// All frame rates: F by F, scene by scene, strategy by strategy.
#[must_use]
pub fn table(results: &Results) -> Vec<Rate> {
    let mut rates = Vec::new();
    for elsewhere in OTHER_FRAME_SECONDS {
        for scene in results.scenes() {
            rates.extend(STRATEGIES.map(|strategy| rate(results, scene, strategy, elsewhere)));
        }
    }
    rates
}

fn rate(results: &Results, scene: &str, strategy: Strategy, elsewhere: f64) -> Rate {
    let culling = results.by_seed(scene, strategy, |run| run.warm);
    let fps: Vec<f64> = culling.iter().map(|t| 1.0 / (elsewhere + t)).collect();
    Rate {
        scene: scene.to_owned(),
        bodies: results.example(scene).map_or(0, |run| run.bodies),
        strategy,
        elsewhere,
        culling: Estimate::of(&culling),
        fps: Estimate::of(&fps),
    }
}

/// Frame rate of the first strategy over that of the second, seed by seed: what both share of a
/// seed cancels.
#[must_use]
pub fn ratio(results: &Results, scene: &str, of: [Strategy; 2], elsewhere: f64) -> Estimate {
    let [one, other] = of.map(|strategy| results.by_seed(scene, strategy, |run| run.warm));
    let ratios: Vec<f64> = one
        .iter()
        .zip(&other)
        .map(|(one, other)| (elsewhere + other) / (elsewhere + one))
        .collect();
    Estimate::of(&ratios)
}
