//! The experiments `cost/quiet` and `cost/loaded`: `sdop cost` on all scenes like the paper's, on
//! an idle machine and on a loaded one.

use super::step::ExperimentStep;

/// The same steps for each scene, which are named once.
macro_rules! costs {
    ($($scene:literal),+) => {
        /// Nothing else runs.
        pub(super) const QUIET: &[ExperimentStep] = &[$(ExperimentStep::SdopPrints(
            concat!($scene, ".json"),
            &["cost", concat!("data/scenes/", $scene, ".toml"), "--seeds", "15", "--format", "json"],
        )),+];

        /// The same scenes with as many other processes as processors.
        pub(super) const LOADED: &[ExperimentStep] = &[$(ExperimentStep::Script(
            concat!($scene, ".json"),
            &[
                ".ci/beside_load", "cargo", "run", "--release", "--quiet", "--",
                "cost", concat!("data/scenes/", $scene, ".toml"), "--seeds", "15", "--format", "json",
            ],
        )),+];
    };
}

costs! {
    "paper-50", "paper-150", "paper-300", "paper-350", "paper-500", "crowded-500", "sparse-500"
}
