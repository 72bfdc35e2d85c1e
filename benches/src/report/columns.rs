//! The kinds of columns in a recorded table: row names, counts, measurements.

use serde_json::Value;

use super::table::Table;

/// Whole numbers that name a row instead of being counted in it.
const NAMING_NUMBERS: [&str; 17] = [
    "bodies",
    "movers",
    "statics",
    "threads",
    "seed",
    "seeds",
    "frames",
    "k",
    "warm_up",
    "timed",
    "turn",
    "checked",
    "elements",
    "samples",
    "frame",
    "rounds",
    "elsewhere",
];

/// What differs between machines, versions and numbers of seeds without naming another row.
const IGNORED_TEXT: [&str; 5] = ["version", "rustc", "cpu", "os", "n"];

/// Columns that follow from others, or are better when larger; they are not compared as times.
const DERIVED: [&str; 9] = [
    "fps",
    "to_control",
    "share",
    "ratio",
    "speed_up",
    "share_of_arithmetic",
    "share_of_memory",
    "predicted",
    "residual",
];

/// Text that is found, not given.
const DERIVED_TEXT: [&str; 4] = ["verdict", "claim_verdict", "standing", "fails"];

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ColumnKind {
    /// Part of the row's name.
    Name,
    /// A whole number that every machine must find.
    Count,
    /// A measured number.
    Measured,
    /// A word that follows from measured numbers.
    Found,
    /// An end or a width of a measured number's interval.
    Interval,
    /// Neither: left out of comparisons.
    Passing,
}

/// The kinds of some columns of two tables.
pub(super) fn kinds(columns: &[String], a: &Table, b: &Table) -> Vec<ColumnKind> {
    let kind = |name: &String| {
        let cells = || a.rows.iter().chain(&b.rows).filter_map(|row| row.get(name));
        let last = name.rsplit('.').next().unwrap_or(name);
        let listed = || cells().any(|cell| cell.as_str().is_some_and(|text| text.starts_with('[')));
        if last.ends_with("sha256") {
            ColumnKind::Count
        } else if IGNORED_TEXT.contains(&last)
            || name.ends_with(".seeds")
            || name.split('.').any(|part| DERIVED.contains(&part))
            || listed()
        {
            ColumnKind::Passing
        } else if DERIVED_TEXT.contains(&last) {
            ColumnKind::Found
        } else if NAMING_NUMBERS.contains(&last) || cells().any(Value::is_string) {
            ColumnKind::Name
        } else if last.ends_with("_low")
            || last.ends_with("_high")
            || last == "half_width"
            || name.split('.').any(|part| part == "widths")
        {
            ColumnKind::Interval
        } else if cells().any(Value::is_f64) {
            ColumnKind::Measured
        } else {
            ColumnKind::Count
        }
    };
    columns.iter().map(kind).collect()
}

/// The interval of a measured cell, where its table has one: `x_low` and `x_high` next to `x`, or
/// `x.half_width` next to `x.mean`, or `half_width` next to `value`.
pub(super) fn interval(row: &serde_json::Map<String, Value>, column: &str) -> Option<[f64; 2]> {
    let number = |name: String| row.get(&name)?.as_f64();
    if let (Some(low), Some(high)) =
        (number(format!("{column}_low")), number(format!("{column}_high")))
    {
        return Some([low, high]);
    }
    // Tidy tables have a number per line: `value` with `half_width`.
    let half = match column.strip_suffix(".mean") {
        Some(stem) => format!("{stem}.half_width"),
        None if column == "value" => "half_width".to_owned(),
        None => return None,
    };
    let (mean, half) = (number(column.to_owned())?, number(half)?);
    Some([mean - half, mean + half])
}
