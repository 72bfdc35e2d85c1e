//! Writing results, the size limit of input files, and the command that repeats a run.

use std::path::{Path, PathBuf};

use miette::{IntoDiagnostic as _, WrapErr as _};
use serde::Serialize;

/// The size limit of files.
#[derive(clap::Args)]
pub struct ReadArgs {
    /// Largest allowed scene, mesh or line of a record, in MiB
    #[arg(long, value_name = "MIB", default_value_t = sdop::files::MAX_BYTES >> 20)]
    max_file_size: u64,
}

impl ReadArgs {
    /// The limit in bytes.
    pub fn max_bytes(&self) -> u64 {
        self.max_file_size.saturating_mul(1 << 20)
    }
}

/// Writes a file whole, and creates its directory if needed.
///
/// # Errors
/// The system's error.
pub fn write(path: &Path, bytes: impl AsRef<[u8]>) -> miette::Result<()> {
    let write = || {
        if let Some(directory) = path.parent() {
            std::fs::create_dir_all(directory)?;
        }
        sdop::files::write(path, &bytes)
    };
    write().into_diagnostic().wrap_err_with(|| format!("cannot write {}", path.display()))
}

/// Writes a value as JSON for people to read, too.
///
/// # Errors
/// As [`write`].
pub fn write_json(path: &Path, value: &impl Serialize) -> miette::Result<()> {
    write(path, serde_json::to_string_pretty(value).into_diagnostic()? + "\n")
}

/// Reads a text file within the usual size limit.
///
/// # Errors
/// The system refuses; a file that is too large.
pub fn read(path: &Path) -> miette::Result<String> {
    sdop::files::read_text(path, sdop::files::MAX_BYTES)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot read {}", path.display()))
}

/// The path of a figure, which is SVG.
///
/// # Errors
/// Another kind of picture.
pub fn svg(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension().is_some_and(|ending| ending == "svg") {
        true => Ok(path),
        false => Err(format!("figures are SVG: name it {}", path.with_extension("svg").display())),
    }
}

/// The environment variable by which `sdop record` passes its own command line to the programs that
/// it runs.
pub const COMMAND: &str = "SDOP_COMMAND";

/// Flags that only share out work: those of [`SweepArgs`](super::sweep::SweepArgs).
pub const SHARING: [&str; 2] = ["--shard", "--share-cores"];

/// The command that repeats these results: `sdop record`'s, or this one. Absolute paths are
/// replaced by `DIR`, and flags that only share out work are dropped.
pub fn command() -> String {
    if let Ok(command) = std::env::var(COMMAND) {
        return command;
    }
    let mut command = "cargo run --release --".to_owned();
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        if argument == "--shard" {
            arguments.next();
        }
        if SHARING.iter().any(|flag| argument.starts_with(flag)) {
            continue;
        }
        let absolute = Path::new(&argument).is_absolute();
        command.push(' ');
        command.push_str(if absolute { "DIR" } else { &argument });
    }
    command
}
