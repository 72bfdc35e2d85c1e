//! All records of the repository, read and checked once each.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use serde_json::Value;

use super::manifest::{FILE, Manifest, ManifestError};
use super::table::{Table, TableError};

/// Records below one directory.
#[derive(Debug)]
pub struct Store {
    root: PathBuf,
    manifests: Mutex<BTreeMap<String, Manifest>>,
}

/// A value that can't be had.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum StoreError {
    /// The record is none, or was changed.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Manifest(#[from] ManifestError),
    /// One of its tables can't be read.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Table(#[from] TableError),
    /// One of its JSON files can't be read.
    #[error("{}: {problem}", path.display())]
    Json {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: String,
    },
}

impl Store {
    /// The records below `root`, by tradition `data/record`.
    #[must_use]
    pub fn new(root: impl Into<PathBuf>) -> Self {
        Self {
            root: root.into(),
            manifests: Mutex::default(),
        }
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
    /// See [`Manifest::read`].
    pub fn manifest(&self, record: &str) -> Result<Manifest, ManifestError> {
        let mut known = self
            .manifests
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        if let Some(manifest) = known.get(record) {
            return Ok(manifest.clone());
        }
        let manifest = Manifest::read(&self.root.join(record))?;
        known.insert(record.to_owned(), manifest.clone());
        Ok(manifest)
    }

    /// The manifests that were used so far.
    #[must_use]
    pub fn used(&self) -> BTreeMap<String, Manifest> {
        let known = self
            .manifests
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        known.clone()
    }

    /// A table, by `machine/experiment/file.csv`.
    ///
    /// # Errors
    /// The record or the table can't be read.
    pub fn table(&self, path: &str) -> Result<Table, StoreError> {
        Ok(Table::read(&self.checked(path)?)?)
    }

    /// A JSON file, by `machine/experiment/file.json`.
    ///
    /// # Errors
    /// The record or the file can't be read.
    pub fn json(&self, path: &str) -> Result<Value, StoreError> {
        let path = self.checked(path)?;
        let failed = |problem: String| StoreError::Json {
            path: path.clone(),
            problem,
        };
        let text = std::fs::read_to_string(&path).map_err(|error| failed(error.to_string()))?;
        serde_json::from_str(&text).map_err(|error| failed(error.to_string()))
    }

    /// The path of a record's file, once the record is known to be whole.
    fn checked(&self, path: &str) -> Result<PathBuf, StoreError> {
        let (record, _) = path.rsplit_once('/').unwrap_or(("", path));
        self.manifest(record)?;
        Ok(self.root.join(path))
    }
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
            let below = if name.is_empty() {
                own
            } else {
                format!("{name}/{own}")
            };
            collect(&path, &below, names);
        }
    }
}
