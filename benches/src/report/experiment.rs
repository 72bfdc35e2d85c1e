//! The experiments that can be recorded: their steps, and which files must be the same on every
//! machine.

use super::costs;
use super::engines::{BULLET, RAPIER_CONTACTS, RAPIER_TIMES};
use super::peers::PEERS;
use super::step::ExperimentStep::{Bench, Estimates, Script, Sdop, SdopPrints};
use super::step::{Experiment, PAPER_500};

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

const CROWDED: &[&str] = &["data/scenes/crowded-500.toml"];

/// The scenes whose instructions are counted.
const COUNTED: &[&str] = &[
    "data/scenes/paper-500.toml",
    "data/scenes/crowded-500.toml",
    "data/scenes/uniform-10k.toml",
    "data/scenes/uniform-100k.toml",
];

const VERIFY: &[&str] =
    &["verify", "--seeds", "128", "--frames", "100", PAPER_500[0], "--format", "json"];

/// Every experiment.
pub fn experiments() -> impl Iterator<Item = &'static Experiment> {
    [OWN_EXPERIMENTS, PEERS].into_iter().flatten()
}

/// A line for an experiment's name and what it measures, and one for its scenes and steps, after
/// the experiments that have files which every machine must find alike.
macro_rules! experiments {
    ({ $($first:expr),+ $(,)? } $($name:literal, $about:literal; $scenes:expr, $steps:expr;)+) => {
        /// Those of the culler and of its filters in physics engines.
        const OWN_EXPERIMENTS: &[Experiment] =
            &[$($first,)+ $(Experiment::new($name, $about, $steps, $scenes)),+];
    };
}

experiments! {
    {
        Experiment {
            name: "reproduce",
            about: "the paper's experiments",
            steps: &[Sdop(&["reproduce"])],
            deterministic: &["counts.csv", "table_1.csv", "survival.csv"],
            scenes: PAPER,
        },
        Experiment {
            name: "tradeoff",
            about: "precision against time on the paper's 500 bodies",
            steps: &[Sdop(&["tradeoff", "data/scenes/paper-500.toml"])],
            deterministic: &["tradeoff-seeds.csv"],
            scenes: PAPER_500,
        },
    }
    "cost/quiet", "the formula predicted against measured, every strategy and scene";
        PAPER, costs::QUIET;
    "cost/loaded", "the same while all processors do other work";
        PAPER, costs::LOADED;
    "cost/bench", "the formula by criterion in one run";
        PAPER_500, &[Bench("total_cost.md", "total_cost")];
    "verify", "the culler judged by the exact reference";
        PAPER_500, &[SdopPrints("verify.json", VERIFY)];
    "kernels/tests", "ns per or-DOP test";
        PAPER_500, &[Estimates("tests.csv", &["ordop"])];
    "kernels/stages", "ns per update and per construction";
        PAPER_500, &[Estimates("stages.csv", &["update", "construct"])];
    "kernels/finders", "ns per body and per first test, by finder";
        PAPER_500, &[Estimates("finders.csv", &["pair_finding"])];
    "kernels/tiers", "full S-DOP on 500 bodies in every tier";
        PAPER_500, &[Estimates("tiers.csv", &["tiers"])];
    "kernels/radii",
    "the cost per reported pair with one size of bodies, with radii 1 : 16 and 1 : 1000";
        PAPER_500, &[Bench("radii.md", "radii")];
    "kernels/motion",
    "the finders that auto chooses between, by motion: p50, p99 and the worst frame";
        PAPER_500, &[Bench("motion.md", "motion")];
    "kernels/far", "pairs and time by distance from the origin: f32, f64 and many places";
        PAPER_500, &[Bench("far.csv", "far")];
    "kernels/roofline", "each kernel compared with the CPU's limits";
        PAPER_500, &[Bench("roofline.md", "roofline")];
    "kernels/safety", "the same frames with margins and without";
        PAPER_500, &[Bench("safety.md", "safety")];
    "kernels/oracle", "the exact reference by stage";
        PAPER_500, &[Bench("oracle.md", "oracle")];
    "instructions", "instructions of a frame's culling, by callgrind";
        COUNTED, &[Script("instructions.csv", &[".ci/instructions"])];
    "ranks", "one world on many ranks of this machine, and what a model makes of clusters";
        &[], &[Script("ranks.json", &[".ci/many_ranks"])];
    "bounds", "the long search for the worst rounding error of every bound";
        &[], &[Bench("bounds.md", "worst_case")];
    "borders", "the long search for a pair lost on a border between a finder's cells";
        &[], &[Bench("borders.md", "finder_borders")];
    "memory", "the address sanitizer in our crates in every tier, memcheck where it knows the tier";
        &[], &[Script("memory.txt", &[".ci/full", "memory"])];
    "mutants", "planted mutants: which the tests catch by room, and why others survive";
        &[], &[
            Script("mutants.csv", &[".ci/mutants/run"]),
            Script("survivors.csv", &[".ci/mutants/run", "--print", "reasons"]),
        ];
    "rapier/contacts",
    "the filter in a physics engine: contacts with it and without, step by step";
        &[], RAPIER_CONTACTS;
    "rapier/times", "the filter in a physics engine: steps timed in turns";
        &[], RAPIER_TIMES;
    "bullet", "the filter in Bullet: every verdict judged by its contacts, steps timed in turns";
        &[], BULLET;
    "python", "calls from Python beyond Rust; pairs of boxes and balls by Python's libraries";
        &[], &[Script("python.json", &["python/bench/run"])];
    "adapters/verdicts", "other libraries judged: which of their claims hold";
        &[], &[Script("installed.txt", &["benches/adapters/install"]), Sdop(&["board"])];
    "adapters/times",
    "other libraries timed by their own clocks, and ours, on the same frames";
        CROWDED, &[
            Script("installed.txt", &["benches/adapters/install"]),
            Sdop(&["board", "--timed", "data/scenes/crowded-500.toml"]),
        ];
    "effects", "what an effect costs that isn't listed";
        PAPER_500, &[
            Script("effects.csv", &[".ci/effect_price", "data/scenes/paper-500.toml", "41"]),
        ];
}
