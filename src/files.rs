//! Reading files within a size limit, and writing files whole.
//!
//! A file is written under a temporary name and renamed when it is complete. A crash, a full disk
//! or a kill leaves the former file or none, and at worst a `.part` file next to it, which the next
//! writer of that name removes. A `.part` file is locked while it is being written.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, BufRead, BufWriter, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

/// The default limit, in bytes: 1 GiB, several times the largest scanned meshes. It also ends the
/// reading of an endless device.
pub const MAX_BYTES: u64 = 1 << 30;

/// Reads a file of at most `most` bytes.
///
/// # Errors
/// What the system says, and [`ErrorKind::FileTooLarge`] for a file with more bytes.
pub fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    read_all(File::open(path)?, most)
}

/// Reads at most `most` bytes, up to the end of the source.
///
/// # Errors
/// As [`read`].
pub fn read_all(source: impl Read, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    source.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        let text = format!("the file is larger than {most} bytes");
        return Err(io::Error::new(ErrorKind::FileTooLarge, text));
    }
    Ok(bytes)
}

/// Reads a UTF-8 file of at most `most` bytes.
///
/// # Errors
/// As [`read`], and [`ErrorKind::InvalidData`] if the bytes are not UTF-8.
pub fn read_text(path: &Path, most: u64) -> io::Result<String> {
    let text = String::from_utf8(read(path, most)?);
    text.map_err(|_| io::Error::new(ErrorKind::InvalidData, "the file is not UTF-8 text"))
}

/// Reads a line of at most `most` bytes with its line end into `line`, whose former content is
/// dropped. Returns the number of bytes, 0 at the end of the source.
///
/// # Errors
/// What the system says, and [`ErrorKind::FileTooLarge`] for a longer line.
pub fn read_line(source: &mut impl BufRead, most: u64, line: &mut Vec<u8>) -> io::Result<usize> {
    line.clear();
    let mut source = source.take(most.saturating_add(1));
    let read = source.read_until(b'\n', line)?;
    if read as u64 > most && !line.ends_with(b"\n") {
        let text = format!("the line is longer than {most} bytes");
        return Err(io::Error::new(ErrorKind::FileTooLarge, text));
    }
    Ok(read)
}

/// Writes a file whole.
///
/// # Errors
/// The system's error; the former file, if any, stays as it was.
pub fn write(path: &Path, bytes: impl AsRef<[u8]>) -> io::Result<()> {
    let mut file = WholeFile::create(path)?;
    file.write_all(bytes.as_ref())?;
    file.finish()
}

/// A file that is being written. It gets its name when it is finished; if it is dropped before,
/// nothing is left of it.
#[derive(Debug)]
pub struct WholeFile {
    file: BufWriter<File>,
    /// The temporary and the final path; `None` for devices and pipes, which can't be replaced.
    part: Option<[PathBuf; 2]>,
}

impl WholeFile {
    /// Starts a file. Symbolic links are followed: the file that they point to is replaced, not the
    /// link.
    ///
    /// # Errors
    /// What the system says.
    pub fn create(path: &Path) -> io::Result<Self> {
        let target = match fs::canonicalize(path) {
            Ok(target) => target,
            Err(error) if error.kind() == ErrorKind::NotFound => path.to_owned(),
            Err(error) => return Err(error),
        };
        let former = fs::metadata(&target).ok();
        if former.as_ref().is_some_and(|former| !former.is_file()) {
            let file = BufWriter::new(File::create(&target)?);
            return Ok(Self { file, part: None });
        }
        let name = target.file_name().ok_or(ErrorKind::InvalidInput)?;
        remove_abandoned(&target, name);
        let mut part = name.to_owned();
        part.push(format!(".{}.part", std::process::id()));
        let part = target.with_file_name(part);
        let file = BufWriter::new(create_locked(&part)?);
        let whole = Self { file, part: Some([part, target]) };
        if let Some(former) = former {
            whole.file.get_ref().set_permissions(former.permissions())?;
        }
        Ok(whole)
    }

    /// Gives the file its name.
    ///
    /// # Errors
    /// The system's error; the former file stays as it was.
    pub fn finish(mut self) -> io::Result<()> {
        self.file.flush()?;
        if let Some([part, target]) = &self.part {
            // A full disk is reported here at the latest.
            self.file.get_ref().sync_all()?;
            fs::rename(part, target)?;
            self.part = None;
        }
        Ok(())
    }
}

/// Creates a file that is locked until it is closed, where the file system has locks.
fn create_locked(part: &Path) -> io::Result<File> {
    loop {
        let file = File::create(part)?;
        let is_locked = file.lock().is_ok();
        // Between creating and locking, another writer may have removed it as abandoned.
        if !is_locked || part.exists() {
            return Ok(file);
        }
    }
}

/// Removes the `.part` files of a name that nobody holds a lock on, because their writers have
/// ended. Files that can't be read or removed stay.
fn remove_abandoned(target: &Path, name: &OsStr) {
    let directory = target.parent().filter(|path| !path.as_os_str().is_empty());
    let Ok(entries) = fs::read_dir(directory.unwrap_or(Path::new("."))) else {
        return;
    };
    let own = std::process::id().to_string();
    let writer = |entry: &fs::DirEntry| {
        let (entry, name) = (entry.file_name(), name.to_str()?);
        let number = entry.to_str()?.strip_prefix(name)?.strip_prefix('.')?;
        let number = number.strip_suffix(".part")?;
        let is_number = !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit());
        is_number.then(|| number.to_owned())
    };
    for entry in entries.flatten() {
        let is_others = writer(&entry).is_some_and(|number| number != own);
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        if !is_others || !is_file {
            continue;
        }
        if let Ok(file) = File::options().write(true).open(entry.path())
            && file.try_lock().is_ok()
        {
            let _ = fs::remove_file(entry.path());
        }
    }
}

impl Write for WholeFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Drop for WholeFile {
    fn drop(&mut self) {
        if let Some([part, _]) = &self.part {
            // The failure was already reported.
            let _ = fs::remove_file(part);
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;

    fn names(directory: &Path) -> Vec<String> {
        let entries = fs::read_dir(directory).unwrap();
        let mut names: Vec<String> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// A file has its name only when it is finished.
    #[test]
    fn file_appears_when_finished() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("a.txt");
        let mut file = WholeFile::create(&path).unwrap();
        file.write_all(b"half").unwrap();
        file.flush().unwrap();
        assert!(!path.exists());
        drop(file);
        assert_eq!(names(directory.path()), Vec::<String>::new());

        write(&path, "first").unwrap();
        let mut file = WholeFile::create(&path).unwrap();
        file.write_all(b"half of the second").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "first");
        drop(file);
        write(&path, "second").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "second");
        assert_eq!(names(directory.path()), ["a.txt"]);
    }

    #[test]
    fn parts_of_killed_writers_are_removed() {
        let directory = tempfile::tempdir().unwrap();
        let at = |name: &str| directory.path().join(name);
        let others = ["a.txt.part", "a.txt.x1.part", "b.txt.4000000001.part"];
        for name in others {
            fs::write(at(name), "not of a writer of a.txt").unwrap();
        }
        fs::write(at("a.txt.4000000001.part"), "half").unwrap();
        let living = File::create(at("a.txt.4000000002.part")).unwrap();
        living.lock().unwrap();
        write(&at("a.txt"), "whole").unwrap();
        let mut wanted = vec!["a.txt", "a.txt.4000000002.part"];
        wanted.extend(others);
        wanted.sort_unstable();
        assert_eq!(names(directory.path()), wanted);
        drop(living);
        write(&at("a.txt"), "again").unwrap();
        assert!(!at("a.txt.4000000002.part").exists());
    }

    /// Devices are written to and never replaced and a full one says so.
    #[cfg(target_os = "linux")]
    #[test]
    fn devices_are_never_replaced() {
        write(Path::new("/dev/null"), "anything").unwrap();
        let full = write(Path::new("/dev/full"), "anything");
        assert_eq!(full.unwrap_err().kind(), ErrorKind::StorageFull);
        let kind = fs::metadata("/dev/full").unwrap().file_type();
        assert!(!kind.is_file());
    }

    /// A link stays a link and permissions stay.
    #[cfg(unix)]
    #[test]
    fn links_and_permissions_stay() {
        use std::os::unix::fs::PermissionsExt as _;
        let directory = tempfile::tempdir().unwrap();
        let [file, link] = ["file", "link"].map(|name| directory.path().join(name));
        write(&file, "former").unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        write(&link, "new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&file).unwrap(), "new");
        let mode = fs::metadata(&file).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o640);
    }

    #[test]
    fn a_line_ends_at_the_limit() {
        let (mut endless, mut line) = (io::BufReader::new(io::repeat(0)), Vec::new());
        let error = read_line(&mut endless, 100, &mut line).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::FileTooLarge);
        assert!(error.to_string().contains("100 bytes"), "{error}");
        assert_eq!(line.len(), 101);
        let mut text = &b"12345\n\nend"[..];
        let mut lines = Vec::new();
        while read_line(&mut text, 5, &mut line).unwrap() > 0 {
            lines.push(String::from_utf8(line.clone()).unwrap());
        }
        assert_eq!(lines, ["12345\n", "\n", "end"]);
    }

    #[test]
    fn reading_ends_at_the_limit() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("five");
        write(&path, "12345").unwrap();
        assert_eq!(read(&path, 5).unwrap(), b"12345");
        let error = read(&path, 4).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::FileTooLarge);
        assert_eq!(read_text(&path, u64::MAX).unwrap(), "12345");
        #[cfg(target_os = "linux")]
        assert!(read(Path::new("/dev/zero"), 1 << 16).is_err());
    }
}
