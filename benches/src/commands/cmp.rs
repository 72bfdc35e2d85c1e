//! `sdop cmp`: compares two records.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use miette::{IntoDiagnostic as _, WrapErr as _};
use sdop_bench::report::{CodeVersion, MeasuredChange, RecordComparison, compare};
use tempfile::TempDir;

use super::Outcome;
use super::output::{csv_text, json_with_reason, print, rows};

/// Compare two records: counts must be equal, times are ratios with intervals
///
/// Compares the rows that both records have; one line counts the rows that only one of them has.
/// Counts that differ are listed. Times are shown as second / first, the largest change first and
/// the control last: "same" if the intervals overlap, "?" if a record has no intervals.
#[derive(clap::Args)]
#[command(
    after_help = "Examples: sdop cmp data/record/epyc-2core-avx512/reproduce data/record/xeon-2core-avx512/reproduce\n         \
                  sdop cmp HEAD~9:data/record/here/tradeoff data/record/here/tradeoff\n\
                  Exit codes: 0 counts are equal, 1 counts differ or a time grew by more than --fail-slower, 2 bad input."
)]
pub struct Args {
    /// The first record: a directory, or COMMIT:DIRECTORY for a state in this repository's history
    first: String,
    /// The second record
    second: String,
    /// Exit with 1 if a time has grown by more than this many percent, confirmed by its interval
    #[arg(long, value_name = "PERCENT", value_parser = percent)]
    fail_slower: Option<f64>,
    /// How many rows of times to list
    #[arg(long, value_name = "N", default_value_t = 15)]
    most: usize,
    /// Output format
    #[arg(long, value_enum, default_value_t)]
    format: ComparisonFormat,
}

/// How a comparison is printed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum ComparisonFormat {
    /// For people.
    #[default]
    Table,
    /// One JSON value.
    Json,
    /// A line per time.
    Csv,
    /// A table for a page.
    Markdown,
}

/// Runs the command.
///
/// # Errors
/// A directory without a complete record; records of different experiments.
pub fn run(args: &Args) -> miette::Result<Outcome> {
    let [(first, _copy), (second, _other)] = [place(&args.first)?, place(&args.second)?];
    let comparison = compare(&first, &second)?;
    let why = why(&comparison, args.fail_slower);
    let text = match args.format {
        ComparisonFormat::Table => table(&comparison, args.most),
        ComparisonFormat::Markdown => markdown(&comparison, args.most),
        ComparisonFormat::Json => json_with_reason(&comparison, why.as_deref())?,
        ComparisonFormat::Csv => {
            csv_text(serde_json::to_value(&comparison.changes).into_diagnostic()?)?
        }
    };
    print(text.trim_end())?;
    Ok(why.map_or(Outcome::Passed, Outcome::Failed))
}

/// What differs that should not.
fn why(comparison: &RecordComparison, fail_slower: Option<f64>) -> Option<String> {
    let (differences, slowest) = (comparison.differences.len(), 100.0 * comparison.slowest());
    if differences > 0 {
        return Some(format!("{differences} results differ that should be equal"));
    }
    let limit = fail_slower.filter(|percent| slowest > *percent)?;
    Some(format!("a time is slower by {slowest:.1} %, more than {limit} %"))
}

/// A directory, or a copy of what a commit had there, which lives as long as its second half.
fn place(named: &str) -> miette::Result<(PathBuf, Option<TempDir>)> {
    let directory = PathBuf::from(named);
    match named.split_once(':') {
        Some((commit, path)) if !directory.exists() => {
            let copy = tempfile::tempdir().into_diagnostic()?;
            CodeVersion::extract(Path::new("."), commit, path, copy.path())
                .into_diagnostic()
                .wrap_err_with(|| format!("cannot read {path} of commit {commit}"))?;
            Ok((copy.path().to_owned(), Some(copy)))
        }
        _ => Ok((directory, None)),
    }
}

fn percent(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(percent) if percent >= 0.0 => Ok(percent),
        _ => Err("a number of percent, 0 or more".to_owned()),
    }
}

fn verdict(change: &MeasuredChange) -> &'static str {
    match change.same {
        Some(true) => "same",
        Some(false) if change.ratio > 1.0 => "slower",
        Some(false) => "faster",
        None => "?",
    }
}

fn cells(change: &MeasuredChange) -> Vec<String> {
    let interval =
        change.interval.map_or_else(String::new, |[low, high]| format!("{low:.2} to {high:.2}"));
    vec![
        format!("{}: {}", change.file, change.row),
        change.column.clone(),
        format!("{:.3}", change.ratio),
        interval,
        verdict(change).to_owned(),
    ]
}

fn head(comparison: &RecordComparison) -> String {
    let [a, b] = &comparison.ids;
    let mut out = format!(
        "{a} and {b}: {} files equal to the bit{}",
        comparison.equal.len(),
        if comparison.equal.is_empty() { "" } else { ": " }
    );
    out.push_str(&comparison.equal.join(", "));
    out.push('\n');
    for warning in &comparison.warnings {
        // Writing to a String cannot fail.
        let _ = writeln!(out, "WARNING {warning}");
    }
    for difference in &comparison.differences {
        let column = difference.column.as_deref().unwrap_or("row");
        let _ = writeln!(
            out,
            "DIFFERS {}: {}, {column}: {} and {}",
            difference.file, difference.row, difference.first, difference.second
        );
    }
    for note in comparison.notes.iter().take(MOST_NOTES) {
        let _ = writeln!(out, "note: {note}");
    }
    if comparison.notes.len() > MOST_NOTES {
        let _ = writeln!(out, "and {} notes more", comparison.notes.len() - MOST_NOTES);
    }
    out
}

/// Notes that are shown.
const MOST_NOTES: usize = 10;

/// How many times are listed of how many.
fn tail(comparison: &RecordComparison, most: usize) -> String {
    let same = comparison.changes.iter().filter(|change| change.same == Some(true));
    let (all, same) = (comparison.changes.len(), same.count());
    let listed = most.min(all);
    format!("{all} times compared, {same} the same within their intervals, {listed} listed")
}

const HEADER: [&str; 5] = ["measurement", "column", "second / first", "interval", "verdict"];

fn table(comparison: &RecordComparison, most: usize) -> String {
    let listed = &comparison.changes[..most.min(comparison.changes.len())];
    let mut out = head(comparison);
    if !listed.is_empty() {
        out.push_str(&rows(&HEADER, listed, cells).to_string());
        out.push('\n');
    }
    out + &tail(comparison, most)
}

fn markdown(comparison: &RecordComparison, most: usize) -> String {
    let mut out = head(comparison) + "\n| " + &HEADER.join(" | ") + " |\n|---|---|--:|---|---|\n";
    for change in comparison.changes.iter().take(most) {
        out.push_str("| ");
        out.push_str(&cells(change).join(" | "));
        out.push_str(" |\n");
    }
    out + "\n" + &tail(comparison, most)
}
