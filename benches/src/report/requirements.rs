//! What an experiment needs: files of a checkout, and other programs.

use std::path::{Path, PathBuf};

use super::manifest::inputs;
use super::step::{Experiment, ExperimentStep};

impl Experiment {
    /// Programs and packages beyond this program, of all steps, in words.
    #[must_use]
    pub fn needs(&self) -> String {
        let mut needs: Vec<&str> = Vec::new();
        for need in self.steps.iter().flat_map(ExperimentStep::needs) {
            if !needs.contains(need) {
                needs.push(need);
            }
        }
        needs.join(", ")
    }

    /// How long it takes where no record says so.
    #[must_use]
    pub fn roughly(&self) -> &'static str {
        match self.name {
            "reproduce" | "tradeoff" => "some minutes",
            "verify" => "half an hour",
            "mutants" | "bounds" | "borders" => "hours",
            _ => "",
        }
    }

    /// The first file of the repository that it reads or runs and that isn't below `root`.
    #[must_use]
    pub fn missing(&self, root: &Path) -> Option<PathBuf> {
        let programs = self.steps.iter().filter_map(ExperimentStep::file).map(PathBuf::from);
        let mut files = programs.chain(inputs(self.scenes));
        files.find(|file| !root.join(file).is_file())
    }
}

impl ExperimentStep {
    fn needs(&self) -> &'static [&'static str] {
        match self {
            Self::Sdop(_) | Self::SdopPrints(..) => &[],
            Self::Peers(_) => &["cargo", "g++", "libembree-dev", "libbullet-dev"],
            Self::Bullet(..) => &["cargo", "g++", "libbullet-dev"],
            Self::Rapier(..) | Self::Bench(..) | Self::Estimates(..) => &["cargo"],
            Self::Script(_, [".ci/instructions", ..]) => &["cargo", "valgrind"],
            Self::Script(_, [".ci/many_ranks", ..]) => &["cargo", "python3", "mpirun"],
            Self::Script(_, [".ci/full", ..]) => &["nightly Rust", "valgrind"],
            Self::Script(_, [".ci/mutants/run", ..]) => &["cargo-mutants", "python3"],
            Self::Script(..) => &["cargo"],
        }
    }

    /// A file of the repository without which it can't run.
    fn file(&self) -> Option<&'static str> {
        match self {
            Self::Sdop(_) | Self::SdopPrints(..) => None,
            Self::Script(_, arguments) => arguments.first().copied(),
            _ => Some("Cargo.toml"),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::super::experiment::experiments;
    use super::*;

    /// A checkout has every file and an empty directory none.
    #[test]
    fn needs_are_found_in_a_checkout() {
        let checkout = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
        let empty = tempfile::tempdir().unwrap();
        for experiment in experiments() {
            assert_eq!(experiment.missing(checkout), None, "{}", experiment.name);
            assert!(experiment.missing(empty.path()).is_some());
        }
        let reproduce = Experiment::named("reproduce").unwrap();
        assert_eq!(reproduce.missing(empty.path()), Some("data/scenes/paper-50.toml".into()));
    }
}
