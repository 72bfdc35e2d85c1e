//! The experiments `cost/quiet` and `cost/loaded`: `sdop cost` on all scenes like the paper's, on
//! an idle machine and on a loaded one.

use super::step::ExperimentStep;

/// One run for all scenes, and one step for each of them.
macro_rules! costs {
    ($first:literal, $($other:literal),+) => {
        /// Nothing else runs. All scenes have the same prices.
        pub(super) const QUIET: &[ExperimentStep] = &[ExperimentStep::Sdop(&[
            "cost", concat!("data/scenes/", $first, ".toml"), "--seeds", "15",
            $("--also", concat!("data/scenes/", $other, ".toml")),+
        ])];

        /// The same scenes with as many other processes as processors.
        pub(super) const LOADED: &[ExperimentStep] = &[
            costs!(loaded $first), $(costs!(loaded $other)),+
        ];
    };
    (loaded $scene:literal) => {
        ExperimentStep::Script(
            concat!($scene, ".json"),
            &[
                ".ci/beside_load", "cargo", "run", "--release", "--quiet", "--",
                "cost", concat!("data/scenes/", $scene, ".toml"), "--seeds", "15", "--format", "json",
            ],
        )
    };
}

costs! {
    "paper-50", "paper-150", "paper-300", "paper-350", "paper-500", "crowded-500", "sparse-500"
}
