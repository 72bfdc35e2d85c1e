//! Merging shards' files: all shards of one work, each once.

use std::collections::BTreeMap;
use std::path::PathBuf;

use miette::Diagnostic;

use super::{Header, Shard, Units};

/// All units of a work.
#[derive(Clone, Debug)]
pub struct MergedUnits {
    /// The work to which the units belong.
    pub header: Header,
    /// Results by unit.
    pub done: BTreeMap<usize, String>,
    /// Seconds of all shards together.
    pub seconds: f64,
}

/// Files that don't make a whole.
#[derive(Debug, thiserror::Error, Diagnostic)]
pub enum MergeError {
    /// No file.
    #[error("there is no shard to merge")]
    None,
    /// A file that was cut off.
    #[error("{} is not a finished shard", path.display())]
    #[diagnostic(help("run this shard again"))]
    Unfinished {
        /// The file.
        path: PathBuf,
    },
    /// Shards belong to different works.
    #[error("{} and {} are shards of different runs: {difference}", first.display(), other.display())]
    #[diagnostic(help(
        "`here` is the first file; run one of them again with the other's code, settings and scenes"
    ))]
    Different {
        /// The file that others are compared with.
        first: PathBuf,
        /// Another.
        other: PathBuf,
        /// How they differ.
        difference: String,
    },
    /// One part twice.
    #[error("{} and {} are both shard {shard}", first.display(), other.display())]
    #[diagnostic(help("name one of them"))]
    Twice {
        /// A file.
        first: PathBuf,
        /// Another.
        other: PathBuf,
        /// The part.
        shard: Shard,
    },
    /// Parts that aren't there.
    #[error("{} of {of} shards are missing: {}", missing.len(), names(missing))]
    #[diagnostic(help("run them: the same command with --shard"))]
    Missing {
        /// Their numbers.
        missing: Vec<usize>,
        /// How many there are.
        of: usize,
    },
    /// A part that lacks units, or has those of others.
    #[error("{} does not hold the units of shard {shard}: unit {unit} is the first that differs", path.display())]
    #[diagnostic(help("the file was not written by this program: run this shard again"))]
    Units {
        /// The file.
        path: PathBuf,
        /// The part.
        shard: Shard,
        /// A unit that is missing or another shard's.
        unit: usize,
    },
}

fn names(missing: &[usize]) -> String {
    let names: Vec<String> = missing.iter().take(20).map(usize::to_string).collect();
    let more = if missing.len() > 20 { ", …" } else { "" };
    names.join(", ") + more
}

/// Puts shards together.
///
/// # Errors
/// Files that are unfinished, of different works, there twice or missing.
pub fn merge(files: Vec<(PathBuf, Units)>) -> Result<MergedUnits, MergeError> {
    let (first, header) = match files.first() {
        Some((path, units)) => (path.clone(), units.header.clone()),
        None => return Err(MergeError::None),
    };
    let mut parts: BTreeMap<Shard, PathBuf> = BTreeMap::new();
    let (mut done, mut seconds) = (BTreeMap::new(), 0.0);
    for (path, units) in files {
        let (Some(shard), Some(took)) = (units.header.shard, units.seconds) else {
            return Err(MergeError::Unfinished { path });
        };
        let number = |header: &Header| header.shard.map_or(0, |shard| shard.of);
        let difference = header.difference(&units.header).or_else(|| {
            let (here, there) = (number(&header), number(&units.header));
            (here != there).then(|| format!("there are {here} shards here and {there} there"))
        });
        if let Some(difference) = difference {
            let other = path;
            return Err(MergeError::Different { first, other, difference });
        }
        let own = shard.units(header.units);
        let wrong = own.iter().find(|unit| !units.done.contains_key(unit));
        let wrong =
            wrong.or_else(|| units.done.keys().find(|unit| own.binary_search(unit).is_err()));
        if let Some(&unit) = wrong {
            return Err(MergeError::Units { path, shard, unit });
        }
        if let Some(first) = parts.insert(shard, path.clone()) {
            let other = path;
            return Err(MergeError::Twice { first, other, shard });
        }
        done.extend(units.done);
        seconds += took;
    }
    let of = header.shard.map_or(0, |shard| shard.of);
    let present = |&index: &usize| parts.contains_key(&Shard { index, of });
    let missing: Vec<usize> = (1..=of).filter(|index| !present(index)).collect();
    if !missing.is_empty() {
        return Err(MergeError::Missing { missing, of });
    }
    Ok(MergedUnits { header, done, seconds })
}
