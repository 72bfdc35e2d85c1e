//! Finished units in a file: the journal of a run that goes on, and a shard's whole result. Both are lines of text.
//!
//! ```text
//! {"form":"sdop units 1","command":"verify",…}      the header
//! start 4 2                                         rank 2 began unit 4 (journals alone)
//! done 4 {…}                                        its result
//! end 12.5 5f70bf18…                                seconds, and SHA-256 of all before (shards alone)
//! ```
//!
//! A journal is appended to line by line: a process that is killed leaves whole lines and at most one torn one, which is
//! dropped. A shard's file appears when it is whole.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, BufReader, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

use miette::Diagnostic;
use sha2::{Digest as _, Sha256};

use super::{Event, Header};
use crate::hash::hex;
use sdop::files::{self, MAX_BYTES, Whole};

/// Finished units, as a file has them.
#[derive(Clone, Debug)]
pub struct Units {
    /// Of which work.
    pub header: Header,
    /// Results by unit.
    pub done: BTreeMap<usize, String>,
    /// Units that a rank began and nobody finished, with the rank.
    pub begun: BTreeMap<usize, usize>,
    /// Seconds that they took, in a file that is whole.
    pub seconds: Option<f64>,
    /// Bytes of a torn last line, which was dropped.
    pub torn: u64,
    /// Bytes of whole lines.
    whole: u64,
}

/// A file of units that can't be used.
#[derive(Debug, thiserror::Error, Diagnostic)]
pub enum UnitsError {
    /// The system.
    #[error("cannot read or write {}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What it says.
        source: io::Error,
    },
    /// A line that is none of a file of units.
    #[error("{}:{line}: this is no line of a journal or shard", path.display())]
    #[diagnostic(help("the file was written by something else, or has been damaged"))]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
    },
    /// Bytes that have changed.
    #[error("{}: the digest at its end is not that of its lines", path.display())]
    #[diagnostic(help("the file has been damaged: run this shard again"))]
    Digest {
        /// The file.
        path: PathBuf,
    },
    /// A journal is there, and nobody said that it should be gone on from.
    #[error("{} is the journal of a run that was interrupted", path.display())]
    #[diagnostic(help("go on from it with --resume, or remove it"))]
    Interrupted {
        /// The journal.
        path: PathBuf,
    },
    /// A journal of other work.
    #[error("{} is the journal of other work: {difference}", path.display())]
    #[diagnostic(help("run it with the same code and arguments, or remove it"))]
    Other {
        /// The journal.
        path: PathBuf,
        /// How it differs; `here` is this run.
        difference: String,
    },
    /// Another process writes it.
    #[error("{} is being written by another process", path.display())]
    #[diagnostic(help(
        "the same work runs already; wait for it, or give it another directory by --out"
    ))]
    InUse {
        /// The journal.
        path: PathBuf,
    },
}

impl Units {
    /// Reads a file of units, torn at its end or not.
    ///
    /// # Errors
    /// A file that can't be read, has other lines or a wrong digest.
    pub fn read(path: &Path) -> Result<Self, UnitsError> {
        let io = |source| UnitsError::Io {
            path: path.to_owned(),
            source,
        };
        let file = File::open(path).map_err(io)?;
        let mut lines = BufReader::new(file);
        let (mut line, mut hash) = (Vec::new(), Sha256::new());
        let mut units: Option<Self> = None;
        let (mut number, mut whole) = (0, 0);
        loop {
            let read = files::read_line(&mut lines, MAX_BYTES, &mut line).map_err(io)? as u64;
            let torn = read > 0 && !line.ends_with(b"\n");
            if let (true, Some(units)) = (read == 0 || torn, &mut units) {
                (units.torn, units.whole) = (read, whole);
                break;
            }
            number += 1;
            let wrong = || UnitsError::Line {
                path: path.to_owned(),
                line: number,
            };
            let text = std::str::from_utf8(&line).map_err(|_| wrong())?;
            match &mut units {
                None => units = Some(Self::headed(text).ok_or_else(wrong)?),
                Some(units) => match units.add(text.trim_end()).ok_or_else(wrong)? {
                    Some(digest) if digest != hex(&hash.clone().finalize()) => {
                        let path = path.to_owned();
                        return Err(UnitsError::Digest { path });
                    }
                    _ => {}
                },
            }
            hash.update(&line);
            whole += read;
        }
        units.ok_or_else(|| UnitsError::Line {
            path: path.to_owned(),
            line: 1,
        })
    }

    fn headed(line: &str) -> Option<Self> {
        Some(Self {
            header: serde_json::from_str(line).ok()?,
            done: BTreeMap::new(),
            begun: BTreeMap::new(),
            seconds: None,
            torn: 0,
            whole: 0,
        })
    }

    /// Takes a line up, and hands back the digest if it has one; `None` for other lines.
    fn add<'a>(&mut self, line: &'a str) -> Option<Option<&'a str>> {
        let (kind, rest) = line.split_once(' ')?;
        let (first, second) = rest.split_once(' ')?;
        let unit = || first.parse().ok().filter(|&unit| unit < self.header.units);
        if self.seconds.is_some() {
            return None; // Nothing stands behind the end.
        }
        match kind {
            "start" => {
                let (unit, rank) = (unit()?, second.parse().ok()?);
                self.begun.insert(unit, rank);
                Some(None)
            }
            "done" => {
                let unit = unit()?;
                self.begun.remove(&unit);
                self.done.insert(unit, second.to_owned());
                Some(None)
            }
            "end" => {
                self.seconds = Some(first.parse().ok()?);
                Some(Some(second))
            }
            _ => None,
        }
    }
}

/// What is done of a run that goes on.
#[derive(Debug)]
pub struct Journal {
    file: File,
    path: PathBuf,
}

impl Journal {
    /// Starts a journal, or with `resume` goes on with the one that is there. Hands back what that has.
    ///
    /// # Errors
    /// A journal of other work, one that is there although `resume` is not said, one that another process writes.
    pub fn open(
        path: &Path,
        header: &Header,
        resume: bool,
    ) -> Result<(Self, Option<Units>), UnitsError> {
        let io = |source| UnitsError::Io {
            path: path.to_owned(),
            source,
        };
        if let Some(directory) = path.parent() {
            std::fs::create_dir_all(directory).map_err(io)?;
        }
        let mut options = OpenOptions::new();
        let options = options.read(true).write(true).create(true).truncate(false);
        let file = options.open(path).map_err(io)?;
        // A file system without locks has none to offer; the others keep two runs apart.
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            let path = path.to_owned();
            return Err(UnitsError::InUse { path });
        }
        let path = path.to_owned();
        let mut journal = Self { file, path };
        let written = journal.file.metadata().map_err(io)?.len();
        let headed = written > 0 && journal.is_headed().map_err(io)?;
        if !headed {
            journal.file.set_len(0).map_err(io)?;
            let header = serde_json::to_string(header).map_err(|error| io(error.into()))?;
            journal.line(&header)?;
            return Ok((journal, None));
        }
        if !resume {
            return Err(UnitsError::Interrupted { path: journal.path });
        }
        let units = Units::read(&journal.path)?;
        let own = (header.difference(&units.header)).or_else(|| {
            let shard = |header: &Header| header.shard.map_or("all".to_owned(), |s| s.to_string());
            let (here, there) = (shard(header), shard(&units.header));
            (here != there).then(|| format!("the shard is {here} here and {there} there"))
        });
        if let Some(difference) = own {
            let path = journal.path;
            return Err(UnitsError::Other { path, difference });
        }
        let file = &mut journal.file;
        file.set_len(units.whole).map_err(io)?;
        file.seek(SeekFrom::End(0)).map_err(io)?;
        Ok((journal, Some(units)))
    }

    /// Whether the first line is whole: a run that was killed before has nothing to go on from.
    fn is_headed(&mut self) -> io::Result<bool> {
        let mut line = Vec::new();
        files::read_line(&mut BufReader::new(&self.file), MAX_BYTES, &mut line)?;
        self.file.rewind()?;
        Ok(line.ends_with(b"\n"))
    }

    /// Keeps what has happened. It survives this process, and a machine that stops without warning may lose the last units.
    ///
    /// # Errors
    /// The system refuses.
    pub fn keep(&mut self, event: &Event) -> Result<(), UnitsError> {
        match event {
            Event::Started { unit, rank } => self.line(&format!("start {unit} {rank}")),
            Event::Done { unit, result } => self.line(&format!("done {unit} {result}")),
            Event::Left { .. } => Ok(()),
        }
    }

    fn line(&mut self, text: &str) -> Result<(), UnitsError> {
        let written = self.file.write_all(format!("{text}\n").as_bytes());
        written.map_err(|source| UnitsError::Io {
            path: self.path.clone(),
            source,
        })
    }

    /// Removes the journal: all that it has stands in a result.
    ///
    /// # Errors
    /// The system refuses.
    pub fn remove(self) -> Result<(), UnitsError> {
        std::fs::remove_file(&self.path).map_err(|source| UnitsError::Io {
            path: self.path,
            source,
        })
    }
}

/// Writes a shard's file, whole, with the results in the order of their units.
///
/// # Errors
/// The system refuses.
pub fn write_shard(
    path: &Path,
    header: &Header,
    done: &BTreeMap<usize, String>,
    seconds: f64,
) -> io::Result<()> {
    let (mut file, mut hash) = (Whole::create(path)?, Sha256::new());
    let mut line = |text: String| {
        hash.update(&text);
        file.write_all(text.as_bytes())
    };
    line(serde_json::to_string(header)? + "\n")?;
    for (unit, result) in done {
        line(format!("done {unit} {result}\n"))?;
    }
    let digest = hex(&hash.finalize());
    file.write_all(format!("end {seconds} {digest}\n").as_bytes())?;
    file.finish()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;

    fn header(seeds: u64) -> Header {
        let settings = BTreeMap::from([("seeds", seeds)]);
        Header::new("verify", &settings, BTreeMap::new(), 9).unwrap()
    }

    fn done(unit: usize) -> Event {
        let result = format!("{{\"squares\": [{}]}}", unit * unit);
        Event::Done { unit, result }
    }

    #[test]
    fn a_journal_is_gone_on_from_without_its_torn_line() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("new/verify.journal");
        let (mut journal, before) = Journal::open(&path, &header(2), false).unwrap();
        assert!(before.is_none());
        let again = Journal::open(&path, &header(2), true).unwrap_err();
        assert!(matches!(again, UnitsError::InUse { .. }), "{again}");
        for unit in [4, 1] {
            journal.keep(&Event::Started { unit, rank: 2 }).unwrap();
        }
        journal.keep(&done(4)).unwrap();
        drop(journal);
        let whole = std::fs::read(&path).unwrap();
        std::fs::write(&path, [&whole[..], b"done 1 {\"squ"].concat()).unwrap();

        let unasked = Journal::open(&path, &header(2), false).unwrap_err();
        assert!(matches!(unasked, UnitsError::Interrupted { .. }));
        let other = Journal::open(&path, &header(3), true).unwrap_err();
        assert!(other.to_string().contains("`seeds` is 3 here and 2 there"));
        let part = Header {
            shard: "1/2".parse().ok(),
            ..header(2)
        };
        let other = Journal::open(&path, &part, true).unwrap_err();
        assert!(other.to_string().contains("shard is 1/2 here and all"));

        let (mut journal, before) = Journal::open(&path, &header(2), true).unwrap();
        let before = before.unwrap();
        assert_eq!(before.torn, 12);
        assert_eq!(before.done.keys().collect::<Vec<_>>(), [&4]);
        assert_eq!(before.begun, BTreeMap::from([(1, 2)]));
        journal.keep(&done(1)).unwrap();
        let units = Units::read(&path).unwrap();
        assert_eq!((units.torn, units.done.len()), (0, 2));
        assert_eq!(units.done[&1], "{\"squares\": [1]}");
        journal.remove().unwrap();
        assert!(!path.exists());
    }

    #[test]
    fn a_header_that_was_not_finished_is_no_journal_yet() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("verify.journal");
        std::fs::write(&path, "{\"form\":").unwrap();
        let (_, before) = Journal::open(&path, &header(2), false).unwrap();
        assert!(before.is_none());
        assert_eq!(Units::read(&path).unwrap().header, header(2));
    }

    #[test]
    fn any_changed_byte_of_a_shard_is_seen() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("1-of-1.units");
        let results = BTreeMap::from([(0, "[1]".to_owned()), (8, "[22]".to_owned())]);
        write_shard(&path, &header(2), &results, 0.1).unwrap();
        let units = Units::read(&path).unwrap();
        assert_eq!((units.done, units.seconds), (results, Some(0.1)));
        let whole = std::fs::read(&path).unwrap();
        let end = whole.windows(4).position(|bytes| bytes == b"end ").unwrap();
        for at in 0..end {
            let mut bytes = whole.clone();
            bytes[at] ^= 1;
            std::fs::write(&path, bytes).unwrap();
            // Without the line break before it, the end is none, and the file no shard's.
            let seen = Units::read(&path).map_or(true, |units| units.seconds.is_none());
            assert!(seen, "byte {at}");
        }
        std::fs::write(&path, &whole[..end]).unwrap();
        assert_eq!(Units::read(&path).unwrap().seconds, None);
    }
}
