//! The experiments that can be recorded, as `data/experiments.toml` lists them.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use serde::Deserialize;

use super::manifest::inputs;

/// An experiment.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Experiment {
    /// Its name, which is its directory below the machine's.
    pub name: String,
    /// What it measures, in a line.
    pub about: String,
    /// How long it takes where no record says so.
    pub takes: String,
    /// Programs and packages beyond this program.
    #[serde(default)]
    pub needs: String,
    /// What runs, in order.
    pub steps: Vec<ExperimentStep>,
    /// Files that every machine must find alike.
    #[serde(default)]
    pub deterministic: Vec<String>,
    /// Names of the scenes that it reads.
    #[serde(default)]
    pub scenes: Vec<String>,
}

/// One program that runs for an experiment.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(from = "String")]
pub struct ExperimentStep {
    /// The file that its output becomes; `None` if it writes files itself.
    pub file: Option<String>,
    /// The program: `sdop`, `field` (`benches/field`), `bench`, `estimates`, or a file of the
    /// repository.
    pub program: String,
    /// Its arguments.
    pub arguments: Vec<String>,
}

impl From<String> for ExperimentStep {
    /// Reads `FILE = PROGRAM ARGUMENTS`, without `FILE =` if it writes files itself. Quotes join
    /// words.
    fn from(line: String) -> Self {
        let (file, line) = match line.split_once(" = ") {
            Some((file, line)) => (Some(file.to_owned()), line),
            None => (None, &*line),
        };
        let mut words = Vec::new();
        for (at, part) in line.split('\'').enumerate() {
            match at % 2 {
                0 => words.extend(part.split_whitespace().map(str::to_owned)),
                _ => words.push(part.to_owned()),
            }
        }
        let mut words = words.into_iter();
        Self { file, program: words.next().unwrap_or_default(), arguments: words.collect() }
    }
}

impl ExperimentStep {
    /// Whether this program runs.
    #[must_use]
    pub fn is_sdop(&self) -> bool {
        self.program == "sdop"
    }

    /// A file of the repository without which it can't run.
    fn needed(&self) -> Option<&str> {
        match self.program.as_str() {
            "sdop" => None,
            "field" | "bench" | "estimates" => Some("Cargo.toml"),
            file => Some(file),
        }
    }
}

/// Every experiment.
pub fn experiments() -> impl Iterator<Item = &'static Experiment> {
    #[derive(Deserialize)]
    struct Listed {
        experiment: Vec<Experiment>,
    }
    static ALL: LazyLock<Vec<Experiment>> = LazyLock::new(|| {
        let listed = toml::from_str(sdop_data::EXPERIMENTS).map(|all: Listed| all.experiment);
        listed.unwrap_or_default() // a test reads it
    });
    ALL.iter()
}

impl Experiment {
    /// The experiment of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Self> {
        experiments().find(|experiment| experiment.name == name)
    }

    /// The first file of the repository that it reads or runs and that isn't below `root`.
    #[must_use]
    pub fn missing(&self, root: &Path) -> Option<PathBuf> {
        let programs = self.steps.iter().filter_map(ExperimentStep::needed).map(PathBuf::from);
        let mut files = programs.chain(inputs(&self.scenes));
        files.find(|file| !root.join(file).is_file())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;

    /// A checkout has every file that an experiment needs, and an empty directory none.
    #[test]
    fn needs_are_found_in_a_checkout() {
        let checkout = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
        let empty = tempfile::tempdir().unwrap();
        let mut names: Vec<&str> = Vec::new();
        for experiment in experiments() {
            assert_eq!(experiment.missing(checkout), None, "{}", experiment.name);
            assert!(experiment.missing(empty.path()).is_some());
            assert!(!experiment.steps.is_empty() && !experiment.takes.is_empty());
            assert!(!names.contains(&&*experiment.name), "{} twice", experiment.name);
            names.push(&experiment.name);
        }
        assert!(names.len() >= 39);
        let reproduce = Experiment::named("reproduce").unwrap();
        assert_eq!(reproduce.missing(empty.path()), Some("data/scenes/paper-50.toml".into()));
    }

    #[test]
    fn steps_are_read() {
        let step =
            ExperimentStep::from("a.csv = field --engines 'sdop,parry3d refit' --x".to_owned());
        assert_eq!((step.file.as_deref(), &*step.program), (Some("a.csv"), "field"));
        assert_eq!(step.arguments, ["--engines", "sdop,parry3d refit", "--x"]);
        assert!(ExperimentStep::from("sdop board".to_owned()).is_sdop());
    }
}
