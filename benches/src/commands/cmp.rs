//! `sdop cmp`: compares two records.

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use miette::{IntoDiagnostic as _, WrapErr as _};
use sdop_bench::report::{CodeVersion, CountDifference, MeasuredChange, RecordComparison, compare};
use tempfile::TempDir;

use super::Outcome;
use super::output::{csv_text, json_with_reason, paragraphs, print, rows};

/// Compare two records: counts must be equal, times are ratios with intervals
///
/// First prints in which settings, machines and code the records differ. Rows with equal names are
/// compared: counts must be equal, unless flags differ, and means are shown as second / first, the
/// largest change first and the control last: "same" if the intervals overlap, "?" if a record has
/// no intervals.
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
    #[arg(long, value_name = "N", default_value_t = 5)]
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
    let column = match change.column.as_str() {
        "value" => String::new(), // of a row that says what it is
        column => format!(", {column}"),
    };
    vec![
        format!("{}: {}{column}", change.file, change.row),
        format!("{:.3}", change.ratio),
        interval,
        verdict(change).to_owned(),
    ]
}

/// Items that are shown of a longer list.
const MOST_LISTED: usize = 5;

/// The first items as lines, and how many there are beyond them.
fn listed(out: &mut String, all: impl ExactSizeIterator<Item = String>) {
    let beyond = all.len().saturating_sub(MOST_LISTED);
    all.take(MOST_LISTED).for_each(|line| *out += &format!("{line}\n"));
    if beyond > 0 {
        *out += &format!("and {beyond} more\n");
    }
}

/// What differs in settings, what can be compared, and whether it agrees.
fn head(comparison: &RecordComparison) -> String {
    let RecordComparison { ids: [a, b], settings, equal, differences, changes, .. } = comparison;
    let mut out = format!("{a} and {b}\n");
    for setting in settings {
        out += &format!("differ in {setting}\n");
    }
    if !equal.is_empty() {
        out += &format!("{} files equal to the bit: {}\n", equal.len(), equal.join(", "));
    }
    listed(&mut out, comparison.warnings.iter().map(|warning| format!("WARNING {warning}")));
    listed(
        &mut out,
        differences.iter().map(|difference| {
            let column = difference.column.as_deref().unwrap_or("row");
            let CountDifference { file, row, first, second, .. } = difference;
            format!("DIFFERS {file}: {row}, {column}: {first} and {second}")
        }),
    );
    listed(&mut out, comparison.notes.iter().map(|note| format!("note: {note}")));
    let count = |same| changes.iter().filter(|change| change.same == same).count();
    out + &format!(
        "{} means compared: {} agree within their intervals, {} don't, {} have none\n",
        changes.len(),
        count(Some(true)),
        count(Some(false)),
        count(None)
    )
}

const HEADER: [&str; 4] = ["measurement", "second / first", "interval", "verdict"];

fn table(comparison: &RecordComparison, most: usize) -> String {
    let listed = &comparison.changes[..most.min(comparison.changes.len())];
    let mut out = paragraphs(&head(comparison));
    if !listed.is_empty() {
        out += &format!("\n{}", rows(&HEADER, listed, cells));
    }
    out
}

fn markdown(comparison: &RecordComparison, most: usize) -> String {
    let mut out = head(comparison) + "\n| " + &HEADER.join(" | ") + " |\n|---|--:|---|---|\n";
    for change in comparison.changes.iter().take(most) {
        out.push_str("| ");
        out.push_str(&cells(change).join(" | "));
        out.push_str(" |\n");
    }
    out
}
