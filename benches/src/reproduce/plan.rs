//! The plan of the experiments: the paper's strategies and scenes, and the numbers of seeds and
//! frames.

use std::path::{Path, PathBuf};

use crate::cost::calibrate::Effort;
use sdop::choice::choices;
use sdop::settings::Strategy;
use sdop::simd::Tier;

/// The paper's strategies, in the order of frame rates that it claims.
pub const STRATEGIES: [Strategy; 6] = [
    Strategy::None,
    Strategy::Sphere,
    Strategy::SDopObjectOfInterest,
    Strategy::SDopSequential,
    Strategy::SDopBatch,
    Strategy::OrDop,
];

choices! {
    /// The paper's scenes: its numbers of objects (350 in the text, 300 in Table 1) in one box, and
    /// 500 in a small box.
    PaperScene, "scene of the paper", {
        /// 50 objects.
        Paper50 = "paper-50",
        /// 150 objects.
        Paper150 = "paper-150",
        /// 300 objects, as in Table 1.
        Paper300 = "paper-300",
        /// 350 objects, as in the text.
        Paper350 = "paper-350",
        /// 500 objects.
        Paper500 = "paper-500",
        /// 500 objects in a small box.
        Crowded500 = "crowded-500",
    }
}

impl PaperScene {
    /// Whether it is the small box, for which Table 1 has no column.
    #[must_use]
    pub const fn crowded(self) -> bool {
        matches!(self, Self::Crowded500)
    }
}

/// What to run.
#[derive(Clone, Debug)]
pub struct ExperimentPlan {
    /// Where the scene files are.
    pub scenes: PathBuf,
    /// Which of them.
    pub names: Vec<PaperScene>,
    /// One run of each scene a seed.
    pub seeds: Vec<u64>,
    /// Frames a run.
    pub frames: u32,
    /// How long to calibrate.
    pub effort: Effort,
    /// The tier that culls.
    pub tier: Tier,
}

impl ExperimentPlan {
    /// The paper's scenes in the directory `scenes`, with seeds 1 … `seeds`.
    #[must_use]
    pub fn new(scenes: &Path, seeds: u64, frames: u32, effort: Effort, tier: Tier) -> Self {
        Self {
            scenes: scenes.to_owned(),
            names: PaperScene::ALL.to_vec(),
            seeds: (1..=seeds).collect(),
            frames,
            effort,
            tier,
        }
    }
}
