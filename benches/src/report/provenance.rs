//! The provenance of a measurement: the code, the caches and other load on the machine.

use std::path::Path;
use std::process::Command;

use serde::{Deserialize, Serialize};

/// What is measured: changes of anything else leave a record as young as it was.
const MEASURED: [&str; 5] =
    ["src", "reference/src", "reference/judge/src", "benches", "Cargo.lock"];

/// The code that was measured, as its repository names it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CodeVersion {
    /// The commit.
    pub commit: String,
    /// Whether files of the code differed from the commit's.
    pub dirty: bool,
    /// Names of the trees that were measured, `src` first: equal names are equal code.
    pub trees: Vec<String>,
}

impl CodeVersion {
    /// The code in the work tree around `place`; `None` without a repository or without git.
    #[must_use]
    pub fn here(place: &Path) -> Option<Self> {
        let status = git(place, &[&["status", "--porcelain", "--"], &MEASURED[..]].concat())?;
        let mut code = Self::at(place, "HEAD")?;
        code.dirty = !status.is_empty();
        Some(code)
    }

    /// The code of a commit.
    #[must_use]
    pub fn at(place: &Path, revision: &str) -> Option<Self> {
        let trees = MEASURED.iter().map(|path| {
            git(place, &["rev-parse", &format!("{revision}:{path}")]).unwrap_or_default()
        });
        Some(Self {
            commit: git(place, &["rev-parse", revision])?,
            dirty: false,
            trees: trees.collect(),
        })
    }

    /// Copies a directory as a commit has it.
    ///
    /// # Errors
    /// No repository at `place`, no such commit or directory, or files that can't be written.
    pub fn extract(place: &Path, commit: &str, directory: &str, to: &Path) -> std::io::Result<()> {
        let tree = format!("{commit}:{}", directory.trim_end_matches('/'));
        let names = git(place, &["ls-tree", "-r", "--name-only", &tree])
            .filter(|names| !names.is_empty())
            .ok_or_else(|| refused(&tree))?;
        for name in names.lines() {
            let file = format!("{tree}/{name}");
            let output = Command::new("git").current_dir(place).args(["show", &file]).output()?;
            if !output.status.success() {
                return Err(refused(&file));
            }
            let target = to.join(name);
            if let Some(above) = target.parent() {
                std::fs::create_dir_all(above)?;
            }
            sdop::files::write(&target, output.stdout)?;
        }
        Ok(())
    }

    /// The commit that last touched a path, and its day.
    #[must_use]
    pub fn last_touching(place: &Path, path: &Path) -> Option<(String, String)> {
        let path = path.to_str()?;
        let line = git(place, &["log", "-1", "--format=%H %cs", "--", path])?;
        let (commit, day) = line.split_once(' ')?;
        Some((commit.to_owned(), day.to_owned()))
    }
}

/// Text that git doesn't give.
fn refused(what: &str) -> std::io::Error {
    std::io::Error::new(std::io::ErrorKind::NotFound, format!("git has no {what}"))
}

/// The output of a git command that succeeds.
fn git(place: &Path, arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").current_dir(place).args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}
