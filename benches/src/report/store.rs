//! All records of the repository, each read and checked once.
//!
//! A path is `machine/experiment/file` or `experiment/file`. The latter means the machine that
//! `quoted.toml` names, so that every page quotes the same record of an experiment.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use miette::miette;
use serde::Deserialize;
use serde_json::Value;

use super::manifest::{FILE, Manifest};
use super::table::Table;

/// The file that says which machine's record a page quotes.
const QUOTED: &str = "quoted.toml";

/// Whose record of an experiment is quoted.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct QuotedMachines {
    /// The default machine.
    machine: String,
    /// Another machine, by experiment.
    #[serde(default)]
    experiments: BTreeMap<String, String>,
}

/// Records below one directory.
#[derive(Debug)]
pub struct Store {
    root: PathBuf,
    quoted: Option<QuotedMachines>,
    manifests: Mutex<BTreeMap<String, Manifest>>,
}

impl Store {
    /// The records below `root`, by tradition `data/record`.
    ///
    /// # Errors
    /// `quoted.toml` is there and can't be read.
    pub fn new(root: impl Into<PathBuf>) -> miette::Result<Self> {
        let root = root.into();
        let path = root.join(QUOTED);
        let quoted = if path.is_file() {
            let text = std::fs::read_to_string(&path).map_err(|error| at(&path, error))?;
            Some(toml::from_str(&text).map_err(|error| at(&path, error))?)
        } else {
            None
        };
        Ok(Self { root, quoted, manifests: Mutex::default() })
    }

    /// The full path of a record or of its file: with the machine that is quoted, where `path`
    /// names none.
    #[must_use]
    pub fn place(&self, path: &str) -> String {
        let first = path.split('/').next().unwrap_or(path);
        let Some(quoted) = self.quoted.as_ref().filter(|_| !self.root.join(first).is_dir()) else {
            return path.to_owned();
        };
        let belongs = |name: &String| {
            path.strip_prefix(name.as_str())
                .is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
        };
        let named = quoted.experiments.iter().rfind(|(name, _)| belongs(name));
        let machine = named.map_or(&quoted.machine, |(_, machine)| machine);
        format!("{machine}/{path}")
    }

    /// Every record's name, as in `machine/experiment`, sorted.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        let mut names = Vec::new();
        collect(&self.root, "", &mut names);
        names.sort();
        names
    }

    /// A record's manifest, its digests checked.
    ///
    /// # Errors
    /// As [`Manifest::read`].
    pub fn manifest(&self, record: &str) -> miette::Result<Manifest> {
        let mut known = self.manifests.lock().unwrap_or_else(PoisonError::into_inner);
        let record = self.place(record);
        if let Some(manifest) = known.get(&record) {
            return Ok(manifest.clone());
        }
        let manifest = Manifest::read(&self.root.join(&record))?;
        known.insert(record, manifest.clone());
        Ok(manifest)
    }

    /// The manifests that were used so far.
    #[must_use]
    pub fn used(&self) -> BTreeMap<String, Manifest> {
        let known = self.manifests.lock().unwrap_or_else(PoisonError::into_inner);
        known.clone()
    }

    /// A table, by `machine/experiment/file.csv`.
    ///
    /// # Errors
    /// The record or the table can't be read.
    pub fn table(&self, path: &str) -> miette::Result<Table> {
        Table::read(&self.checked(path)?)
    }

    /// A JSON file, by `machine/experiment/file.json`.
    ///
    /// # Errors
    /// The record or the file can't be read.
    pub fn json(&self, path: &str) -> miette::Result<Value> {
        let text = self.text(path)?;
        serde_json::from_str(&text).map_err(|error| at(&self.root.join(self.place(path)), error))
    }

    /// A text file, by `machine/experiment/file`.
    ///
    /// # Errors
    /// The record or the file can't be read.
    pub fn text(&self, path: &str) -> miette::Result<String> {
        let path = self.checked(path)?;
        std::fs::read_to_string(&path).map_err(|error| at(&path, error))
    }

    /// The path of a record's file, once the record is known to be whole.
    fn checked(&self, path: &str) -> miette::Result<PathBuf> {
        let path = self.place(path);
        // A record may have subdirectories.
        let mut record = path.as_str();
        while let Some((above, _)) = record.rsplit_once('/') {
            record = above;
            if self.root.join(record).join(FILE).is_file() {
                break;
            }
        }
        let manifest = self.manifest(record)?;
        let path = self.root.join(&path);
        if path.is_file() {
            return Ok(path);
        }
        miette::bail!(
            "{}: not in this tree; `sdop record {}` finds the record",
            path.display(),
            manifest.id()
        )
    }
}

/// What is wrong with a file.
fn at(path: &Path, problem: impl Display) -> miette::Report {
    miette!("{}: {problem}", path.display())
}

fn collect(directory: &Path, name: &str, names: &mut Vec<String>) {
    if directory.join(FILE).is_file() {
        names.push(name.to_owned());
    }
    let Ok(entries) = std::fs::read_dir(directory) else {
        return;
    };
    for entry in entries.flatten() {
        let path = entry.path();
        if path.is_dir() {
            let own = entry.file_name().to_string_lossy().into_owned();
            let below = if name.is_empty() { own } else { format!("{name}/{own}") };
            collect(&path, &below, names);
        }
    }
}
