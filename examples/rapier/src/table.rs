//! Records as Markdown.

use std::path::Path;

use miette::{IntoDiagnostic, Result, WrapErr};

use crate::record::Record;

/// The tables of all records in a folder.
///
/// # Errors
/// A record that can't be read.
pub fn of(directory: &Path) -> Result<String> {
    let mut records: Vec<Record> = Vec::new();
    for entry in std::fs::read_dir(directory).into_diagnostic()? {
        let path = entry.into_diagnostic()?.path();
        if path.extension().is_some_and(|extension| extension == "json") {
            let text = std::fs::read_to_string(&path).into_diagnostic()?;
            let record = serde_json::from_str(&text).into_diagnostic();
            records.push(record.wrap_err_with(|| path.display().to_string())?);
        }
    }
    Ok(format!("{}", records.len()))
}
