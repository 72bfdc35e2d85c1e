//! Files that appear under their name only when whole.

use std::path::Path;

use miette::{Context, IntoDiagnostic, Result};

/// Writes under a temporary name, then renames.
///
/// # Errors
/// A file that can't be written.
pub fn write(path: &Path, text: &str) -> Result<()> {
    let beside = path.with_extension("part");
    let written = std::fs::write(&beside, text).and_then(|()| std::fs::rename(&beside, path));
    written.into_diagnostic().wrap_err_with(|| format!("can't write {}", path.display()))
}
