//! The experiments that can be recorded: the command of each, and which of its files every machine must find alike.

/// Who runs an experiment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Program {
    /// This program, with `--out DIR` at the end.
    Sdop,
    /// The peers' program, with `--out DIR` at the end.
    Peers,
    /// A bench that prints its own table: the name of the file it becomes.
    Bench {
        /// The file.
        file: &'static str,
    },
}

/// An experiment.
#[derive(Clone, Copy, Debug)]
pub struct Experiment {
    /// Its name, which is its directory below the machine's.
    pub name: &'static str,
    /// What it measures, in a line.
    pub about: &'static str,
    /// Who runs it.
    pub program: Program,
    /// The arguments.
    pub arguments: &'static [&'static str],
    /// Files that every machine must find alike.
    pub deterministic: &'static [&'static str],
    /// Scenes that it reads, in the repository.
    pub scenes: &'static [&'static str],
}

const PAPER: [&str; 7] = [
    "data/scenes/paper-50.toml",
    "data/scenes/paper-150.toml",
    "data/scenes/paper-300.toml",
    "data/scenes/paper-350.toml",
    "data/scenes/paper-500.toml",
    "data/scenes/crowded-500.toml",
    "data/scenes/sparse-500.toml",
];

/// Every experiment.
pub const EXPERIMENTS: &[Experiment] = &[
    Experiment {
        name: "reproduce",
        about: "the paper's experiments",
        program: Program::Sdop,
        arguments: &["reproduce"],
        deterministic: &["counts.csv", "table_1.csv", "survival.csv"],
        scenes: &PAPER,
    },
    Experiment {
        name: "tradeoff",
        about: "precision against time on the paper's 500 bodies",
        program: Program::Sdop,
        arguments: &["tradeoff", "data/scenes/paper-500.toml"],
        deterministic: &[],
        scenes: &["data/scenes/paper-500.toml"],
    },
    Experiment {
        name: "verify",
        about: "the culler judged by the exact reference",
        program: Program::Sdop,
        arguments: &[
            "verify",
            "--seeds",
            "128",
            "--frames",
            "100",
            "data/scenes/paper-500.toml",
        ],
        deterministic: &[],
        scenes: &["data/scenes/paper-500.toml"],
    },
    Experiment {
        name: "peers/uniform",
        about: "engines on the same uniform boxes, to ten thousand",
        program: Program::Peers,
        arguments: &["--sizes", "500,1000,10000", "--scenes", "uniform"],
        deterministic: &[],
        scenes: &[],
    },
    Experiment {
        name: "kernels/safety",
        about: "the same frames with margins and without",
        program: Program::Bench { file: "safety.md" },
        arguments: &["safety"],
        deterministic: &[],
        scenes: &[],
    },
];
