//! A file that has its name only when it is whole: written beside, then renamed.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// A file being written. Dropped unfinished, it leaves nothing behind.
#[derive(Debug)]
pub struct Unfinished {
    path: PathBuf,
    /// What is renamed to `path` at the end; none where `path` is no regular file, such as a pipe.
    beside: Option<PathBuf>,
    file: BufWriter<File>,
}

impl Unfinished {
    /// Creates the file, and its directory when there is none.
    ///
    /// # Errors
    /// The system refuses.
    pub fn create(path: &Path) -> io::Result<Self> {
        if let Some(directory) = path.parent() {
            fs::create_dir_all(directory)?;
        }
        let special = fs::metadata(path).is_ok_and(|found| !found.is_file());
        let beside = (!special).then(|| beside(path));
        let file = File::create(beside.as_deref().unwrap_or(path))?;
        Ok(Self {
            path: path.to_owned(),
            beside,
            file: BufWriter::new(file),
        })
    }

    /// Gives the file its name.
    ///
    /// # Errors
    /// The system refuses, or what is still in memory can't be written.
    pub fn finish(mut self) -> io::Result<()> {
        self.file.flush()?;
        if let Some(beside) = &self.beside {
            fs::rename(beside, &self.path)?;
        }
        self.beside = None;
        Ok(())
    }
}

impl Write for Unfinished {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        if let Some(beside) = &self.beside {
            // There is nobody to tell.
            let _ = fs::remove_file(beside);
        }
    }
}

/// A name in the same directory, so that renaming doesn't copy.
fn beside(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.part", std::process::id()));
    path.with_file_name(name)
}
