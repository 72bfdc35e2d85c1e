//! A shard's file: finished units as lines of text.
//!
//! ```text
//! {"form":"sdop units 1","command":"verify",…}      the header
//! done 4 {…}                                        a unit's result
//! end 12.5 5f70bf18…                                seconds, and SHA-256 of all before
//! ```
//!
//! The file appears when it is complete. A file without its last line was damaged, and
//! [`merge`](super::merge()) rejects it.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufReader, Write as _};
use std::path::Path;

use miette::{IntoDiagnostic as _, WrapErr as _, miette};
use sha2::{Digest as _, Sha256};

use super::Header;
use crate::hash::hex;
use sdop::files::{self, MAX_BYTES, WholeFile};

/// Finished units, as a file has them.
#[derive(Clone, Debug)]
pub struct Units {
    /// The work to which the file belongs.
    pub header: Header,
    /// Results by unit.
    pub done: BTreeMap<usize, String>,
    /// Seconds that they took, in a file that is whole.
    pub seconds: Option<f64>,
}

impl Units {
    /// Reads a file of units.
    ///
    /// # Errors
    /// A file that can't be read, has other lines or a wrong digest.
    pub fn read(path: &Path) -> miette::Result<Self> {
        let name = path.display();
        let unreadable = || format!("cannot read or write {name}");
        let file = File::open(path).into_diagnostic().wrap_err_with(unreadable)?;
        let mut lines = BufReader::new(file);
        let (mut line, mut hash) = (Vec::new(), Sha256::new());
        let mut units: Option<Self> = None;
        let mut number = 0;
        loop {
            number += 1;
            let wrong = || {
                miette!(
                    help = "the file was written by something else, or has been damaged",
                    "{name}:{number}: not a line of a shard"
                )
            };
            let read = files::read_line(&mut lines, MAX_BYTES, &mut line);
            read.into_diagnostic().wrap_err_with(unreadable)?;
            // A line that was cut off is none.
            if !line.ends_with(b"\n") {
                return units.ok_or_else(wrong);
            }
            let text = std::str::from_utf8(&line).map_err(|_| wrong())?;
            match &mut units {
                None => units = Some(Self::headed(text).ok_or_else(wrong)?),
                Some(units) => match units.add(text.trim_end()).ok_or_else(wrong)? {
                    Some(digest) if digest != hex(&hash.clone().finalize()) => miette::bail!(
                        help = "the file has been damaged: run this shard again",
                        "{name}: the digest at its end does not match its lines"
                    ),
                    _ => {}
                },
            }
            hash.update(&line);
        }
    }

    fn headed(line: &str) -> Option<Self> {
        Some(Self {
            header: serde_json::from_str(line).ok()?,
            done: BTreeMap::new(),
            seconds: None,
        })
    }

    /// Takes a line, and returns the digest if it has one; `None` for other lines.
    fn add<'a>(&mut self, line: &'a str) -> Option<Option<&'a str>> {
        if self.seconds.is_some() {
            return None; // Nothing may follow the end.
        }
        let (kind, rest) = line.split_once(' ')?;
        let (first, second) = rest.split_once(' ')?;
        match kind {
            "done" => {
                let unit = first.parse().ok();
                let unit = unit.filter(|&unit| unit < self.header.units)?;
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
    let (mut file, mut hash) = (WholeFile::create(path)?, Sha256::new());
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

    fn header() -> Header {
        let settings = BTreeMap::from([("seeds", 2)]);
        Header::new("verify", &settings, BTreeMap::new(), 9).unwrap()
    }

    #[test]
    fn any_changed_byte_is_seen() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("1-of-1.units");
        let results = BTreeMap::from([(0, "[1]".to_owned()), (8, "[22]".to_owned())]);
        write_shard(&path, &header(), &results, 0.1).unwrap();
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
