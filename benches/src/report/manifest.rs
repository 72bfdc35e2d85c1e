//! `record.json`: the description of a directory of measurements.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use miette::miette;
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};

use super::provenance::CodeVersion;
use crate::hash::hex;
use crate::measure::conditions::Load;
use crate::measure::machine::{Machine, caches};

/// The manifest's name in every record.
pub const FILE: &str = "record.json";

/// The names of a record's files that only the git history still has, one per line.
const IN_HISTORY: &str = "in-history.txt";

/// The version of the format that this program writes and reads.
const VERSION: u32 = 1;

/// A record's description. Digests are SHA-256 in hexadecimal.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// `sdop-measurement`.
    pub format: String,
    /// 1.
    pub version: u32,
    /// The experiment's name.
    pub experiment: String,
    /// The command that makes these files again.
    pub command: String,
    /// Day of the measurement, `YYYY-MM-DD`, UTC.
    pub date: String,
    /// The code that was measured; absent if there was no repository.
    pub code: Option<CodeVersion>,
    /// The machine; absent in records that were made from files without it.
    pub machine: Option<Machine>,
    /// Data caches of one core, smallest first, as the system names them.
    #[serde(default)]
    pub caches: Vec<String>,
    /// Load averages before and after.
    pub load: Option<[Load; 2]>,
    /// Seconds that the measurement took.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
    /// A note for readers, for example that the files are older than this manifest.
    #[serde(default)]
    pub note: Option<String>,
    /// Digests of the scenes and meshes that were read, by their paths.
    #[serde(default)]
    pub inputs: BTreeMap<String, String>,
    /// Files that must be the same bytes on every machine.
    pub deterministic: Vec<String>,
    /// Digest of every file of the record but this one.
    pub files: BTreeMap<String, String>,
    /// Digest of this manifest without this line: the record's identifier is its first twelve
    /// digits.
    #[serde(default)]
    pub digest: String,
}

/// What is wrong with a file of a record, and what to do.
fn flaw(path: &Path, problem: impl Display, help: &str) -> miette::Report {
    miette!(help = help, "{}: {problem}", path.display())
}

/// A file that can't be read.
fn unreadable(path: &Path, error: &io::Error) -> miette::Report {
    flaw(path, error, "a record is a directory with a record.json, as `sdop record` makes it")
}

/// A file whose digest doesn't fit.
fn changed(path: &Path) -> miette::Report {
    let help = "restore the file, or measure again with the command in record.json";
    flaw(path, "changed since it was recorded", help)
}

impl Manifest {
    /// Describes the files now in `directory`, measured on this machine.
    ///
    /// # Errors
    /// A file that can't be read.
    pub fn describe(
        directory: &Path,
        experiment: &str,
        command: String,
        deterministic: &[String],
    ) -> miette::Result<Self> {
        let files = digests(directory)?;
        let known = |name: &&String| files.contains_key(*name);
        Ok(Self {
            format: "sdop-measurement".to_owned(),
            version: VERSION,
            experiment: experiment.to_owned(),
            command,
            date: today(),
            code: CodeVersion::here(Path::new(".")),
            machine: None,
            caches: caches().iter().map(|(level, size)| format!("L{level} {size}")).collect(),
            load: None,
            seconds: None,
            note: None,
            inputs: BTreeMap::new(),
            deterministic: deterministic.iter().filter(known).cloned().collect(),
            files,
            digest: String::new(),
        })
    }

    /// Adds the digests of the scenes of some names and of the meshes, by paths below `root`.
    ///
    /// # Errors
    /// A file that can't be read.
    pub fn add_inputs(&mut self, root: &Path, scenes: &[String]) -> miette::Result<()> {
        for input in inputs(scenes) {
            let path = root.join(&input);
            let bytes = std::fs::read(&path).map_err(|error| unreadable(&path, &error))?;
            self.inputs.insert(input.display().to_string(), sha256(&bytes));
        }
        Ok(())
    }

    /// The manifest as text, with its digest.
    #[must_use]
    pub fn text(&self) -> String {
        let sealed = Self { digest: self.own_digest(), ..self.clone() };
        // Plain data: no map with keys that aren't text.
        serde_json::to_string_pretty(&sealed).unwrap_or_default() + "\n"
    }

    /// Reads the manifest of `directory` and checks every digest.
    ///
    /// # Errors
    /// What is missing, new or changed.
    pub fn read(directory: &Path) -> miette::Result<Self> {
        let path = directory.join(FILE);
        let text = std::fs::read_to_string(&path).map_err(|error| unreadable(&path, &error))?;
        let manifest: Self = serde_json::from_str(&text).map_err(|error| {
            flaw(&path, error, "record.json is written by `sdop record`; make the record again")
        })?;
        let Self { format, version, .. } = &manifest;
        if format != "sdop-measurement" || *version != VERSION {
            let problem = format!(
                "format {format} version {version}, expected sdop-measurement version {VERSION}"
            );
            return Err(flaw(&path, problem, "make the record again with this version of sdop"));
        }
        if manifest.digest != manifest.own_digest() {
            return Err(changed(&path));
        }
        manifest.check_files(directory)?;
        Ok(manifest)
    }

    /// The first twelve digits of its digest: what a report cites.
    #[must_use]
    pub fn id(&self) -> &str {
        self.digest.get(..12).unwrap_or(&self.digest)
    }

    /// Checks the files that are there. Those that only the git history has may be missing.
    fn check_files(&self, directory: &Path) -> miette::Result<()> {
        let now = digests(directory)?;
        let in_history = std::fs::read_to_string(directory.join(IN_HISTORY)).unwrap_or_default();
        let help = "a record's files are those that record.json lists, without those that in-history.txt lists; make the record again";
        let problem = |name: &str, problem: &str| Err(flaw(&directory.join(name), problem, help));
        for (name, digest) in &self.files {
            match now.get(name) {
                None if in_history.lines().any(|listed| listed == name) => {}
                None => return problem(name, "missing"),
                Some(other) if other != digest => return Err(changed(&directory.join(name))),
                Some(_) => {}
            }
        }
        let mut names = now.keys().map(String::as_str).chain(in_history.lines());
        match names.find(|name| !self.files.contains_key(*name)) {
            Some(name) => problem(name, "not among the record's files"),
            None => Ok(()),
        }
    }

    fn own_digest(&self) -> String {
        let open = Self { digest: String::new(), ..self.clone() };
        sha256(serde_json::to_string(&open).unwrap_or_default().as_bytes())
    }
}

/// Today, `YYYY-MM-DD`, UTC.
fn today() -> String {
    let now = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
    now.split('T').next().unwrap_or_default().to_owned()
}

/// Some scenes and the meshes that they use, by their paths in the repository.
pub(super) fn inputs(scenes: &[String]) -> Vec<PathBuf> {
    let scenes = scenes.iter().map(|scene| format!("data/scenes/{scene}.toml"));
    let meshes = ["spot", "teapot", "bunny-4k", "bunny"];
    let meshes = meshes.iter().map(|mesh| format!("data/meshes/{mesh}.tri"));
    scenes.chain(meshes).map(PathBuf::from).collect()
}

/// SHA-256 in hexadecimal.
pub(super) fn sha256(bytes: &[u8]) -> String {
    hex(&Sha256::digest(bytes))
}

/// The digest of every file in `directory` and in its directories, except the manifest and the list
/// of files in the history. A directory that has a manifest is another record.
fn digests(directory: &Path) -> miette::Result<BTreeMap<String, String>> {
    let mut digests = BTreeMap::new();
    add_digests(directory, "", &mut digests)?;
    Ok(digests)
}

fn add_digests(
    directory: &Path,
    prefix: &str,
    digests: &mut BTreeMap<String, String>,
) -> miette::Result<()> {
    let failed = |error: io::Error| unreadable(directory, &error);
    for entry in std::fs::read_dir(directory).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let own = path.file_name().unwrap_or_default().to_string_lossy();
        let name = format!("{prefix}{own}");
        if path.is_dir() && !path.join(FILE).is_file() {
            add_digests(&path, &format!("{name}/"), digests)?;
        } else if path.is_file() && name != FILE && name != IN_HISTORY {
            let bytes = std::fs::read(&path).map_err(|error| unreadable(&path, &error))?;
            digests.insert(name, sha256(&bytes));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;

    fn record() -> (tempfile::TempDir, Manifest) {
        let directory = tempfile::tempdir().unwrap();
        std::fs::write(directory.path().join("counts.csv"), "a,b\n1,2\n").unwrap();
        let manifest = Manifest::describe(
            directory.path(),
            "test",
            "sdop test".to_owned(),
            &["counts.csv".to_owned()],
        );
        let manifest = manifest.unwrap();
        std::fs::write(directory.path().join(FILE), manifest.text()).unwrap();
        (directory, manifest)
    }

    /// What is wrong with a record, without the file's place.
    fn problem(directory: &tempfile::TempDir) -> String {
        let error = Manifest::read(directory.path()).unwrap_err().to_string();
        error.strip_prefix(&format!("{}/", directory.path().display())).unwrap().to_owned()
    }

    /// A record reads back as it was described.
    #[test]
    fn record_reads_back() {
        let (directory, manifest) = record();
        let read = Manifest::read(directory.path()).unwrap();
        assert_eq!(read.files, manifest.files);
        assert_eq!(read.deterministic, ["counts.csv"]);
        assert_eq!(read.id().len(), 12);
    }

    /// Figures below are part of a record and records below are not.
    #[test]
    fn nested_records_are_separate() {
        let directory = tempfile::tempdir().unwrap();
        let place = directory.path();
        for (name, text) in
            [("figures/a.svg", "1"), ("other/b.csv", "2"), ("other/record.json", "{}")]
        {
            std::fs::create_dir_all(place.join(name).parent().unwrap()).unwrap();
            std::fs::write(place.join(name), text).unwrap();
        }
        let manifest = Manifest::describe(place, "test", "sdop test".to_owned(), &[]).unwrap();
        assert_eq!(manifest.files.keys().collect::<Vec<_>>(), ["figures/a.svg"]);
        std::fs::write(place.join(FILE), manifest.text()).unwrap();
        std::fs::write(place.join("figures/a.svg"), "3").unwrap();
        let error = Manifest::read(place).unwrap_err().to_string();
        assert!(error.contains("changed since"), "{error}");
    }

    /// A file more or less is seen, unless only the history has it.
    #[test]
    fn added_or_missing_file_is_detected() {
        let (directory, _) = record();
        std::fs::write(directory.path().join("extra.csv"), "a\n1\n").unwrap();
        assert_eq!(problem(&directory), "extra.csv: not among the record's files");
        let (directory, _) = record();
        std::fs::remove_file(directory.path().join("counts.csv")).unwrap();
        assert_eq!(problem(&directory), "counts.csv: missing");
        let list = directory.path().join(IN_HISTORY);
        std::fs::write(&list, "counts.csv\n").unwrap();
        assert_eq!(Manifest::read(directory.path()).unwrap().deterministic, ["counts.csv"]);
        std::fs::write(&list, "counts.csv\ntimes.csv\n").unwrap();
        assert_eq!(problem(&directory), "times.csv: not among the record's files");
    }
}
