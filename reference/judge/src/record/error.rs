//! What can be wrong with a record: where, what, and how to mend it.

use std::path::Path;

use miette::Diagnostic;
use thiserror::Error;

use super::VERSION;

/// Why a record could not be written or read.
#[derive(Debug, Error, Diagnostic)]
pub enum RecordError {
    /// The file can't be written.
    #[error("cannot write {file}: {cause}")]
    Unwritable {
        /// The path as given.
        file: String,
        /// What the system said.
        cause: std::io::Error,
    },
    /// The file can't be read.
    #[error("{file}: {cause}")]
    #[diagnostic(help("give the path of a record: `sdop run SCENE --record FILE` writes one"))]
    Unreadable {
        /// The path as given.
        file: String,
        /// What the system said.
        cause: std::io::Error,
    },
    /// Another kind of file.
    #[error("{file}:1: this is no record: {problem}")]
    #[diagnostic(help(
        "a record is lines of JSON, the first {{\"format\":\"sdop-record\",\"version\":1,…}}: `sdop run SCENE --record FILE` writes one"
    ))]
    Stranger {
        /// The path as given.
        file: String,
        /// What the first line is instead.
        problem: String,
    },
    /// A layout that this program doesn't know.
    #[error("{file}:1: the record has version {found}; this program reads version {VERSION}")]
    #[diagnostic(help(
        "read it with the sdop that wrote it, or write it again with `sdop run SCENE --record FILE`"
    ))]
    Version {
        /// The path as given.
        file: String,
        /// The version it has.
        found: u64,
    },
    /// A line that is not what it should be.
    #[error("{file}:{line}: {problem}")]
    Line {
        /// The path as given.
        file: String,
        /// 1-based line.
        line: u64,
        /// What is wrong.
        problem: String,
        /// How to mend it.
        #[help]
        hint: String,
    },
}

impl RecordError {
    pub(super) fn unwritable(path: &Path, cause: std::io::Error) -> Self {
        Self::Unwritable {
            file: path.display().to_string(),
            cause,
        }
    }
}
