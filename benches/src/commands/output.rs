//! Printing results to standard output: as a table for people, or as JSON or CSV for programs.

mod listing;

use std::io::{ErrorKind, Write as _};

use clap::ValueEnum;
use indicatif::{ProgressBar, ProgressStyle};
use miette::{IntoDiagnostic as _, WrapErr as _};
use serde::Serialize;
use serde_json::Value;

pub use listing::{Column, Listing, paragraphs, pivot, rows, table};

/// How a result is printed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// For people.
    #[default]
    Table,
    /// One JSON value.
    Json,
    /// A header, then one line per record.
    Csv,
}

/// Keys that are not flattened in CSV, because their form differs from run to run and the header
/// must not.
const UNFLATTENED_KEYS: [&str; 2] = ["interest", "budget"];

/// Prints `value` in `format`. In CSV, a list has one line per element, any other value a single
/// line.
///
/// # Errors
/// Standard output can't be written. A reader that ends early is not an error.
pub fn emit<T: Serialize>(
    format: Format,
    value: &T,
    table: impl FnOnce(&T) -> String,
) -> miette::Result<()> {
    let text = match format {
        Format::Table => table(value),
        Format::Json => serde_json::to_string_pretty(value).into_diagnostic()?,
        Format::Csv => csv_text(serde_json::to_value(value).into_diagnostic()?)?,
    };
    print(text.trim_end())
}

/// A result with the reason why the command did not succeed.
#[derive(Serialize)]
struct WithReason<'a, T> {
    #[serde(flatten)]
    value: &'a T,
    #[serde(skip_serializing_if = "Option::is_none")]
    why: Option<&'a str>,
}

/// As [`emit`], for a value with named fields: in JSON, the field `why` says why the exit code is
/// not 0.
///
/// # Errors
/// As [`emit`].
pub fn emit_with_reason<T: Serialize>(
    format: Format,
    value: &T,
    why: Option<&str>,
    table: impl FnOnce(&T) -> String,
) -> miette::Result<()> {
    match format {
        Format::Json => print(&json_with_reason(value, why)?),
        Format::Table | Format::Csv => emit(format, value, table),
    }
}

/// The JSON that [`emit_with_reason`] prints.
///
/// # Errors
/// A value that JSON can't represent.
pub fn json_with_reason<T: Serialize>(value: &T, why: Option<&str>) -> miette::Result<String> {
    serde_json::to_string_pretty(&WithReason { value, why }).into_diagnostic()
}

/// Prints lines.
///
/// # Errors
/// As [`emit`].
pub fn print(text: &str) -> miette::Result<()> {
    let mut out = std::io::stdout().lock();
    match writeln!(out, "{text}").and_then(|()| out.flush()) {
        // `sdop … | head` has read enough.
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result.into_diagnostic().wrap_err("cannot write to standard output"),
    }
}

/// A number with its noun.
pub fn counted(number: usize, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
}

/// A number for people: six significant digits, plain unless it is tiny or huge, never minus zero.
pub fn decimal(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    let exponent = x.abs().log10().floor();
    if !(-5.0..9.0).contains(&exponent) {
        return format!("{x:.5e}");
    }
    let digits = (5.0 - exponent).max(0.0) as usize;
    let text = format!("{x:.digits$}");
    if digits == 0 {
        return text;
    }
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// A progress bar on standard error; it shows on a terminal only.
pub fn progress(steps: u64, what: &str) -> ProgressBar {
    let bar = ProgressBar::new(steps);
    let template = "{msg} {wide_bar} {pos}/{len}, {eta} left";
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar.with_message(what.to_owned())
}

/// CSV of a list of records, or of one.
///
/// Objects are flattened with dots, lists of named objects by their names; the header is the union
/// over all records.
pub fn csv_text(value: Value) -> miette::Result<String> {
    let records = match value {
        Value::Array(records) => records,
        single => vec![single],
    };
    let rows: Vec<Vec<(String, String)>> = records
        .into_iter()
        .map(|record| {
            let mut row = Vec::new();
            flatten("", record, &mut row);
            row
        })
        .collect();
    let mut header: Vec<&str> = Vec::new();
    for (key, _) in rows.iter().flatten() {
        if !header.contains(&key.as_str()) {
            header.push(key);
        }
    }
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(&header).into_diagnostic()?;
    for row in &rows {
        let cell = |name: &&str| {
            let found = row.iter().find(|(key, _)| key == name);
            found.map_or("", |(_, value)| value.as_str())
        };
        writer.write_record(header.iter().map(cell)).into_diagnostic()?;
    }
    let bytes = writer.into_inner().into_diagnostic()?;
    String::from_utf8(bytes).into_diagnostic()
}

fn flatten(key: &str, value: Value, row: &mut Vec<(String, String)>) {
    let inner = |name: &str| match key {
        "" => name.to_owned(),
        _ => format!("{key}.{name}"),
    };
    match value {
        Value::Null => row.push((key.to_owned(), String::new())),
        Value::String(text) => row.push((key.to_owned(), text)),
        Value::Object(fields) if !UNFLATTENED_KEYS.contains(&key) => {
            for (name, field) in fields {
                flatten(&inner(&name), field, row);
            }
        }
        Value::Array(items) if named(&items) => {
            for item in items {
                let Value::Object(mut fields) = item else {
                    continue;
                };
                if let Some(Value::String(name)) = fields.shift_remove("name") {
                    flatten(&inner(&name), Value::Object(fields), row);
                }
            }
        }
        other => row.push((key.to_owned(), other.to_string())),
    }
}

/// Whether every item is an object with a string `name`.
fn named(items: &[Value]) -> bool {
    !items.is_empty() && items.iter().all(|item| item["name"].is_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// Csv flattens objects and named lists and keeps settings whole.
    #[test]
    fn csv_flattens_all_but_settings() {
        let value = json!({
            "scene": "a,b", "budget": {"tests": 5}, "interest": null,
            "counters": {"tests": 1, "hits": 2},
            "effects": [{"name": "motion", "steps": 3}, {"name": "spin", "steps": 0}],
            "list": [1, 2],
        });
        let text = csv_text(value).unwrap_or_default();
        let expected = "scene,budget,interest,counters.tests,counters.hits,effects.motion.steps,effects.spin.steps,list\n\
                        \"a,b\",\"{\"\"tests\"\":5}\",,1,2,3,0,\"[1,2]\"\n";
        assert_eq!(text, expected);
    }

    /// Numbers for people have six digits and no exponent where they need none.
    #[test]
    fn printed_numbers_have_six_digits() {
        for (x, text) in [
            (32.536_16, "32.5362"),
            (-0.0, "0"),
            (3.25, "3.25"),
            (0.000_123_456_7, "0.000123457"),
            (123_456_789.0, "123456789"),
            (1.0e12, "1.00000e12"),
            (-1.665_334_5e-16, "-1.66533e-16"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(decimal(x), text);
        }
    }

    /// Csv of records has the union of their columns.
    #[test]
    fn csv_header_unites_all_columns() {
        let text = csv_text(json!([{"a": 1}, {"b": 2, "a": 3}])).unwrap_or_default();
        assert_eq!(text, "a,b\n1,\n3,2\n");
    }
}
