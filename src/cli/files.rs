//! Results as files, and the command that makes them again.

use std::path::Path;

use miette::{IntoDiagnostic as _, WrapErr as _};

/// Writes a file, and its directory when there is none.
///
/// # Errors
/// The system refuses.
pub fn write(path: &Path, bytes: impl AsRef<[u8]>) -> miette::Result<()> {
    let write = || {
        if let Some(directory) = path.parent() {
            std::fs::create_dir_all(directory)?;
        }
        std::fs::write(path, &bytes)
    };
    write()
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot write {}", path.display()))
}

/// The command that makes these results again. Absolute paths are this machine's own business.
pub fn command() -> String {
    let mut command = "cargo run --release --".to_owned();
    for argument in std::env::args().skip(1) {
        let absolute = Path::new(&argument).is_absolute();
        command.push(' ');
        command.push_str(if absolute { "DIR" } else { &argument });
    }
    command
}
