//! `sdop record ID`: a record by its identifier, from the tree or from the git history.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use miette::{IntoDiagnostic as _, miette};
use sdop_bench::report::{CodeVersion, FILE, Manifest, Store};
use serde::Deserialize;

use super::super::files::read;
use super::super::output::print;

/// The list of all records that were ever committed, in the directory of records.
const INDEX: &str = "index.toml";

/// The fewest digits of an identifier. No experiment's name consists of so many.
const FEWEST_DIGITS: usize = 4;

/// Where the git history has a record.
#[derive(Deserialize)]
struct InHistory {
    /// The last commit with this record.
    commit: String,
    /// Its directory there, from the repository's root.
    path: String,
}

/// Whether an argument is the beginning of an identifier instead of an experiment's name.
pub(super) fn is_identifier(argument: &str) -> bool {
    argument.len() >= FEWEST_DIGITS && argument.bytes().all(|digit| digit.is_ascii_hexdigit())
}

/// Prints the manifest of the record whose identifier has these first digits, and says where the
/// record is.
///
/// # Errors
/// No or several such records; a record that was changed, or that git doesn't have here.
pub(super) fn show(records: &Path, digits: &str) -> miette::Result<()> {
    let digits = digits.to_ascii_lowercase();
    let (index, tree) = (records.join(INDEX), in_tree(records)?);
    let mut history: BTreeMap<String, InHistory> = BTreeMap::new();
    if index.is_file() {
        let rows = toml::from_str(&read(&index)?);
        history = rows.map_err(|error| miette!("{}: {error}", index.display()))?;
    }
    let known: BTreeSet<&String> = tree.keys().chain(history.keys()).collect();
    let fits = |id: &&&String| id.starts_with(&digits) || digits.starts_with(id.as_str());
    let fitting: Vec<&str> = known.iter().filter(fits).map(|id| id.as_str()).collect();
    let &[id] = &fitting[..] else {
        miette::ensure!(fitting.is_empty(), "{digits} can be {}", fitting.join(" or "));
        return Err(unknown(&digits, &known, &index));
    };
    let Some(directory) = tree.get(id) else {
        return show_earlier(id, &history[id]);
    };
    eprintln!("{id} is {}", directory.display());
    print(Manifest::read(directory)?.text().trim_end())
}

/// Prints the manifest of a record that only the git history has.
fn show_earlier(id: &str, InHistory { commit, path }: &InHistory) -> miette::Result<()> {
    let copy = tempfile::tempdir().into_diagnostic()?;
    CodeVersion::extract(Path::new("."), commit, path, copy.path()).map_err(|error| {
        miette!(
            help = "look there in a clone with the whole history: git fetch --unshallow",
            "{id} is not in this tree; it is {path} of commit {commit}, but {error}"
        )
    })?;
    eprintln!("{id} is {path} of commit {commit}: git show {commit}:{path}/{FILE}");
    print(Manifest::read(copy.path())?.text().trim_end())
}

/// The directories of records in the tree, by their identifiers.
fn in_tree(records: &Path) -> miette::Result<BTreeMap<String, PathBuf>> {
    let store = Store::new(records)?;
    let found = store.names().into_iter().filter_map(|name| {
        let manifest = store.manifest(&name).ok()?;
        Some((manifest.id().to_owned(), records.join(name)))
    });
    Ok(found.collect())
}

/// No record has these digits: names the one that differs least.
fn unknown(digits: &str, known: &BTreeSet<&String>, index: &Path) -> miette::Report {
    let differing = |id: &&&String| id.bytes().zip(digits.bytes()).filter(|(a, b)| a != b).count();
    let nearest = known.iter().min_by_key(differing);
    let nearest = nearest.map_or(String::new(), |id| format!("the nearest is {id}; "));
    miette!(
        help = format!("{nearest}{} lists all", index.display()),
        "no record has an identifier that begins with {digits}"
    )
}
