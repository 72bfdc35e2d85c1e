//! The errors of records: where the mistake is, what it is, and how to fix it.

use std::path::Path;

use thiserror::Error;

use super::VERSION;

/// The error of a record that could not be written or read.
#[derive(Debug, Error)]
pub enum RecordError {
    /// The file can't be written.
    #[error("cannot write {file}: {cause}")]
    Unwritable {
        /// The path as given.
        file: String,
        /// The system's error.
        cause: std::io::Error,
    },
    /// The file can't be read.
    #[error("{file}: {cause}")]
    Unreadable {
        /// The path as given.
        file: String,
        /// The system's error.
        cause: std::io::Error,
    },
    /// Another kind of file.
    #[error("{file}:1: not a record: {problem}")]
    Stranger {
        /// The path as given.
        file: String,
        /// What the first line is instead.
        problem: String,
    },
    /// A layout that this program doesn't know.
    #[error("{file}:1: the record has version {found}; this program reads version {VERSION}")]
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
        hint: String,
    },
}

impl RecordError {
    /// How to mend it, where that is known.
    #[must_use]
    pub fn help(&self) -> Option<&str> {
        match self {
            Self::Unwritable { .. } => None,
            Self::Unreadable { .. } => {
                Some("give the path of a record: `sdop run SCENE --record FILE` writes one")
            }
            Self::Stranger { .. } => Some(
                "a record is lines of JSON, the first {\"format\":\"sdop-record\",\"version\":1,…}: `sdop run SCENE --record FILE` writes one",
            ),
            Self::Version { .. } => Some(
                "read it with the sdop that wrote it, or write it again with `sdop run SCENE --record FILE`",
            ),
            Self::Line { hint, .. } => Some(hint),
        }
    }

    pub(super) fn unwritable(path: &Path, cause: std::io::Error) -> Self {
        Self::Unwritable { file: path.display().to_string(), cause }
    }
}
