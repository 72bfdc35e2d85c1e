//! Printing a verdict: as a table for people, as JSON, CSV, JUnit's XML or a badge for programs.

use clap::ValueEnum;
use sdop_judge::report::junit;
use sdop_judge::verdict::GroupVerdict;
use sdop_judge::{Conclusion, Verdict};
use serde::Serialize;

use crate::commands::output::{self, Format, print, rows};

/// How a verdict is printed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum ReportFormat {
    /// For people.
    #[default]
    Table,
    /// One JSON value.
    Json,
    /// A header, then one line per record.
    Csv,
    /// JUnit's XML.
    Junit,
    /// A badge, as the endpoint of shields.io reads it.
    Badge,
}

impl From<Format> for ReportFormat {
    fn from(format: Format) -> Self {
        match format {
            Format::Table => Self::Table,
            Format::Json => Self::Json,
            Format::Csv => Self::Csv,
        }
    }
}

/// All of a verdict, for programs.
#[derive(Serialize)]
struct WholeVerdict<'a> {
    passed: bool,
    conclusion: Conclusion,
    #[serde(skip_serializing_if = "Option::is_none")]
    why: Option<String>,
    asked: usize,
    judged: usize,
    groups: Vec<GroupVerdict>,
    #[serde(flatten)]
    verdict: &'a Verdict,
    #[serde(skip_serializing_if = "Option::is_none")]
    witness: Option<&'a sdop_judge::witness::Witness>,
}

/// Prints a verdict.
///
/// # Errors
/// Standard output can't be written.
pub fn emit(format: ReportFormat, verdict: &Verdict) -> miette::Result<()> {
    match format {
        ReportFormat::Junit => print(junit(verdict).trim_end()),
        ReportFormat::Csv => output::emit(Format::Csv, &verdict.groups(), |_| String::new()),
        ReportFormat::Json => {
            let witness = verdict.smallest.as_ref().and_then(|smallest| smallest.witness.as_ref());
            let whole = WholeVerdict {
                passed: verdict.passed(),
                conclusion: verdict.conclusion(),
                why: verdict.why(),
                asked: verdict.asked(),
                judged: verdict.judged(),
                groups: verdict.groups(),
                verdict,
                witness,
            };
            output::emit(Format::Json, &whole, |_| String::new())
        }
        ReportFormat::Badge => print(&badge(verdict)),
        ReportFormat::Table => print(&format!("{}{verdict}", table(verdict))),
    }
}

/// The first line of the summary as a badge: its claim is the label.
fn badge(verdict: &Verdict) -> String {
    let color = match verdict.conclusion() {
        Conclusion::Pass => "brightgreen",
        Conclusion::Incomplete => "yellow",
        Conclusion::NotPassed => "red",
    };
    let summary = verdict.to_string();
    let (label, mut message) = summary.split_once(": ").unwrap_or_default();
    message = message.lines().next().unwrap_or_default();
    let known = verdict.cases.iter().filter(|case| case.known).count();
    let known = if known > 0 { format!(", {known} known to fail") } else { String::new() };
    serde_json::json!({ "schemaVersion": 1, "label": format!("sdop, {label}"), "message": format!("{message}{known}"), "color": color })
        .to_string()
}

/// The groups that did not simply pass, failed ones first; one line counts the others.
fn table(verdict: &Verdict) -> String {
    let header =
        ["cases", "passed", "failed", "errors", "skipped", "judged", "required", "missed", "extra"];
    let row = |group: &GroupVerdict| {
        let pairs = &group.pairs;
        let cases = [group.passed, group.failed, group.errors, group.skipped].map(u64::from);
        let pairs = [pairs.judged, pairs.required, pairs.missed, pairs.extra];
        let numbers = cases.into_iter().chain(pairs).map(|n| n.to_string());
        std::iter::once(group.name.clone()).chain(numbers).collect()
    };
    let is_passed = |group: &GroupVerdict| group.failed + group.errors + group.skipped == 0;
    let (passed, mut others): (Vec<_>, Vec<_>) = verdict.groups().into_iter().partition(is_passed);
    others.sort_by_key(|group| std::cmp::Reverse((group.failed, group.errors)));
    let mut text = String::new();
    if !others.is_empty() {
        text = format!("{}\n", rows(&header, &others, row));
    }
    let cases: u32 = passed.iter().map(|group| group.passed).sum();
    let plural = |count: usize| if count == 1 { "" } else { "s" };
    if !passed.is_empty() {
        let (groups, of_groups, of_cases) =
            (passed.len(), plural(passed.len()), plural(cases as usize));
        text += &format!("{groups} group{of_groups} with {cases} case{of_cases} passed\n");
    }
    text
}
