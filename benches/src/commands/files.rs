//! Results as files, how large a file may be, and the command that makes results again.

use std::path::Path;

use miette::{IntoDiagnostic as _, WrapErr as _};

use super::sweep;

/// How much is read of a file.
#[derive(clap::Args)]
pub struct ReadArgs {
    /// Refuse scenes and meshes, and lines of records, of more MiB than this
    #[arg(long, value_name = "MIB", default_value_t = sdop::files::MAX_BYTES >> 20)]
    max_file_size: u64,
}

impl ReadArgs {
    /// The limit in bytes.
    pub fn max_bytes(&self) -> u64 {
        self.max_file_size.saturating_mul(1 << 20)
    }
}

/// Writes a file whole, and its directory when there is none.
///
/// # Errors
/// The system refuses.
pub fn write(path: &Path, bytes: impl AsRef<[u8]>) -> miette::Result<()> {
    let write = || {
        if let Some(directory) = path.parent() {
            std::fs::create_dir_all(directory)?;
        }
        sdop::files::write(path, &bytes)
    };
    write()
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot write {}", path.display()))
}

/// Reads a text file of no more bytes than is usual.
///
/// # Errors
/// The system refuses; a file that is too large.
pub fn read(path: &Path) -> miette::Result<String> {
    sdop::files::read_text(path, sdop::files::MAX_BYTES)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot read {}", path.display()))
}

/// The variable in which `sdop record` names itself to what it runs.
pub const COMMAND: &str = "SDOP_COMMAND";

/// The command that makes these results again: `sdop record`'s, or this one's. Absolute paths are
/// this machine's own business, and who shared the work changes no result.
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
        if sweep::SHARING.iter().any(|flag| argument.starts_with(flag)) {
            continue;
        }
        let absolute = Path::new(&argument).is_absolute();
        command.push(' ');
        command.push_str(if absolute { "DIR" } else { &argument });
    }
    command
}
