//! The experiments that can be recorded: their steps, and which files must be the same on every
//! machine.

use super::costs;
use super::engines::{BULLET, RAPIER_CONTACTS, RAPIER_TIMES};
use super::peers::PEERS;
use super::step::{Experiment, ExperimentStep, PAPER_500};

impl Experiment {
    /// The experiment of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Self> {
        experiments().find(|experiment| experiment.name == name)
    }
}

const PAPER: &[&str] = &[
    "data/scenes/paper-50.toml",
    "data/scenes/paper-150.toml",
    "data/scenes/paper-300.toml",
    "data/scenes/paper-350.toml",
    "data/scenes/paper-500.toml",
    "data/scenes/crowded-500.toml",
    "data/scenes/sparse-500.toml",
];

/// A bench of kernels.
const fn kernels(
    name: &'static str,
    about: &'static str,
    steps: &'static [ExperimentStep],
) -> Experiment {
    Experiment { name, about, steps, deterministic: &[], scenes: PAPER_500 }
}

/// Every experiment.
pub fn experiments() -> impl Iterator<Item = &'static Experiment> {
    [OWN_EXPERIMENTS, PEERS].into_iter().flatten()
}

/// Those of the culler and of its filters in physics engines.
const OWN_EXPERIMENTS: &[Experiment] = &[
    Experiment {
        name: "reproduce",
        about: "the paper's experiments",
        steps: &[ExperimentStep::Sdop(&["reproduce"])],
        deterministic: &["counts.csv", "table_1.csv"],
        scenes: PAPER,
    },
    Experiment {
        name: "tradeoff",
        about: "precision against time on the paper's 500 bodies",
        steps: &[ExperimentStep::Sdop(&["tradeoff", "data/scenes/paper-500.toml"])],
        deterministic: &["tradeoff-seeds.csv"],
        scenes: PAPER_500,
    },
    Experiment {
        name: "cost/quiet",
        about: "the formula predicted against measured, every strategy and scene",
        steps: costs::QUIET,
        deterministic: &[],
        scenes: PAPER,
    },
    Experiment {
        name: "cost/loaded",
        about: "the same while all processors do other work",
        steps: costs::LOADED,
        deterministic: &[],
        scenes: PAPER,
    },
    Experiment {
        name: "cost/bench",
        about: "the formula by criterion in one run",
        steps: &[ExperimentStep::Bench("total_cost.md", "total_cost")],
        deterministic: &[],
        scenes: PAPER_500,
    },
    Experiment {
        name: "verify",
        about: "the culler judged by the exact reference",
        steps: &[ExperimentStep::SdopPrints(
            "verify.json",
            &[
                "verify",
                "--seeds",
                "128",
                "--frames",
                "100",
                "data/scenes/paper-500.toml",
                "--format",
                "json",
            ],
        )],
        deterministic: &[],
        scenes: PAPER_500,
    },
    kernels(
        "kernels/tests",
        "ns per or-DOP test",
        &[ExperimentStep::Estimates("tests.csv", &["ordop"])],
    ),
    kernels(
        "kernels/stages",
        "ns per update and per construction",
        &[ExperimentStep::Estimates("stages.csv", &["update", "construct"])],
    ),
    kernels(
        "kernels/finders",
        "ns per body and per first test, by finder",
        &[ExperimentStep::Estimates("finders.csv", &["pair_finding"])],
    ),
    kernels(
        "kernels/tiers",
        "full S-DOP on 500 bodies in every tier",
        &[ExperimentStep::Estimates("tiers.csv", &["tiers"])],
    ),
    kernels(
        "kernels/radii",
        "the cost per reported pair with one size of bodies, with radii 1 : 16 and 1 : 1000",
        &[ExperimentStep::Bench("radii.md", "radii")],
    ),
    kernels(
        "kernels/motion",
        "the finders that auto chooses between, by motion: p50, p99 and the worst frame",
        &[ExperimentStep::Bench("motion.md", "motion")],
    ),
    kernels(
        "kernels/far",
        "pairs and time by distance from the origin: f32, f64 and many places",
        &[ExperimentStep::Bench("far.csv", "far")],
    ),
    kernels(
        "kernels/roofline",
        "each kernel compared with the CPU's limits",
        &[ExperimentStep::Bench("roofline.md", "roofline")],
    ),
    kernels(
        "kernels/safety",
        "the same frames with margins and without",
        &[ExperimentStep::Bench("safety.md", "safety")],
    ),
    kernels(
        "kernels/oracle",
        "the exact reference by stage",
        &[ExperimentStep::Bench("oracle.md", "oracle")],
    ),
    Experiment {
        name: "instructions",
        about: "instructions of a frame's culling, by callgrind",
        steps: &[ExperimentStep::Script("instructions.csv", &[".ci/instructions"])],
        deterministic: &[],
        scenes: &[
            "data/scenes/paper-500.toml",
            "data/scenes/crowded-500.toml",
            "data/scenes/uniform-10k.toml",
            "data/scenes/uniform-100k.toml",
        ],
    },
    Experiment {
        name: "ranks",
        about: "one world on many ranks of this machine, and what a model makes of clusters",
        steps: &[ExperimentStep::Script("ranks.json", &[".ci/many_ranks"])],
        deterministic: &[],
        scenes: &[],
    },
    Experiment {
        name: "bounds",
        about: "the long search for the worst rounding error of every bound",
        steps: &[ExperimentStep::Bench("bounds.md", "worst_case")],
        deterministic: &[],
        scenes: &[],
    },
    Experiment {
        name: "borders",
        about: "the long search for a pair lost on a border between a finder's cells",
        steps: &[ExperimentStep::Bench("borders.md", "finder_borders")],
        deterministic: &[],
        scenes: &[],
    },
    Experiment {
        name: "memory",
        about: "the address sanitizer in our crates in every tier, memcheck where it knows the tier",
        steps: &[ExperimentStep::Script("memory.txt", &[".ci/full", "memory"])],
        deterministic: &[],
        scenes: &[],
    },
    Experiment {
        name: "mutants",
        about: "planted mutants: which the tests catch by room, and why others survive",
        steps: &[
            ExperimentStep::Script("mutants.csv", &[".ci/mutants/run"]),
            ExperimentStep::Script("survivors.csv", &[".ci/mutants/run", "--print", "reasons"]),
        ],
        deterministic: &[],
        scenes: &[],
    },
    Experiment {
        name: "rapier/contacts",
        about: "the filter in a physics engine: contacts with it and without, step by step",
        steps: RAPIER_CONTACTS,
        deterministic: &[],
        scenes: &[],
    },
    Experiment {
        name: "rapier/times",
        about: "the filter in a physics engine: steps timed in turns",
        steps: RAPIER_TIMES,
        deterministic: &[],
        scenes: &[],
    },
    Experiment {
        name: "bullet",
        about: "the filter in Bullet: every verdict judged by its contacts, steps timed in turns",
        steps: BULLET,
        deterministic: &[],
        scenes: &[],
    },
    Experiment {
        name: "python",
        about: "calls from Python beyond Rust; pairs of boxes and balls by Python's libraries",
        steps: &[ExperimentStep::Script("python.json", &["python/bench/run"])],
        deterministic: &[],
        scenes: &[],
    },
    Experiment {
        name: "adapters/verdicts",
        about: "other libraries judged: which of their claims hold",
        steps: &[
            ExperimentStep::Script("installed.txt", &["benches/adapters/install"]),
            ExperimentStep::Sdop(&["board"]),
        ],
        deterministic: &[],
        scenes: &[],
    },
    Experiment {
        name: "adapters/times",
        about: "other libraries timed by their own clocks, and ours, on the same frames",
        steps: &[
            ExperimentStep::Script("installed.txt", &["benches/adapters/install"]),
            ExperimentStep::Sdop(&["board", "--timed", "data/scenes/crowded-500.toml"]),
        ],
        deterministic: &[],
        scenes: &["data/scenes/crowded-500.toml"],
    },
    Experiment {
        name: "effects",
        about: "what an effect costs that isn't listed",
        steps: &[ExperimentStep::Script(
            "effects.csv",
            &[".ci/effect_price", "data/scenes/paper-500.toml", "41"],
        )],
        deterministic: &[],
        scenes: PAPER_500,
    },
];
