//! The steps of an experiment. Each step runs a program.

/// One program that runs for an experiment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExperimentStep {
    /// This program, which writes its files to the directory of `--out`.
    Sdop(&'static [&'static str]),
    /// This program, whose output becomes a file.
    SdopPrints(&'static str, &'static [&'static str]),
    /// The peers' program, with `--out DIR` at the end; its arguments in a line, where a flag's
    /// value goes up to the next flag.
    Peers(&'static str),
    /// The program of the filter in rapier, whose result becomes a file; its arguments in a line.
    /// Margins that are left out must be seen.
    Rapier(&'static str, &'static str),
    /// The same in Bullet.
    Bullet(&'static str, &'static str),
    /// A bench that prints its own table, which becomes a file.
    Bench(&'static str, &'static str),
    /// Criterion's estimates of some benches, as one table.
    Estimates(&'static str, &'static [&'static str]),
    /// A program of the repository, whose output becomes a file.
    Script(&'static str, &'static [&'static str]),
}

/// An experiment.
#[derive(Clone, Copy, Debug)]
pub struct Experiment {
    /// Its name, which is its directory below the machine's.
    pub name: &'static str,
    /// What it measures, in a line.
    pub about: &'static str,
    /// What runs, in order.
    pub steps: &'static [ExperimentStep],
    /// Files that every machine must find alike.
    pub deterministic: &'static [&'static str],
    /// Scenes that it reads, in the repository.
    pub scenes: &'static [&'static str],
}

impl Experiment {
    /// An experiment without files that every machine must find alike.
    pub(super) const fn new(
        name: &'static str,
        about: &'static str,
        steps: &'static [ExperimentStep],
        scenes: &'static [&'static str],
    ) -> Self {
        Self { name, about, steps, deterministic: &[], scenes }
    }
}

/// The paper's scene of 500 objects.
pub(super) const PAPER_500: &[&str] = &["data/scenes/paper-500.toml"];
