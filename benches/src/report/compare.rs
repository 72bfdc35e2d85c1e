//! Comparing two records: counts must be equal, times are ratios with intervals.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;
use serde_json::{Map, Value};

use super::columns::{ColumnKind, interval, kinds};
use super::manifest::{Manifest, ManifestError};
use super::table::{Table, TableError};
use crate::measure::conditions::Conditions;
use crate::measure::estimate::Estimate;
use sdop::settings::Strategy;

/// A count, or a whole file, that two records don't share.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CountDifference {
    /// The table.
    pub file: String,
    /// What names the row.
    pub row: String,
    /// The column; absent where one record lacks the file.
    pub column: Option<String>,
    /// What the first record has.
    pub first: String,
    /// What the second record has.
    pub second: String,
}

/// How a measured number changed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MeasuredChange {
    /// The table.
    pub file: String,
    /// What names the row.
    pub row: String,
    /// The column.
    pub column: String,
    /// The value in the first record.
    pub first: f64,
    /// The value in the second record.
    pub second: f64,
    /// Second over first.
    pub ratio: f64,
    /// The interval of the ratio, where both records have intervals.
    pub interval: Option<[f64; 2]>,
    /// Whether the interval contains 1; absent without an interval.
    pub same: Option<bool>,
}

/// Two records compared.
#[derive(Clone, Debug, Serialize)]
pub struct RecordComparison {
    /// Identifiers of both.
    pub ids: [String; 2],
    /// Files that are equal to the bit.
    pub equal: Vec<String>,
    /// What must be equal and isn't.
    pub differences: Vec<CountDifference>,
    /// Measured numbers, the largest change first.
    pub changes: Vec<MeasuredChange>,
    /// What only one of the records has or says, without being a count that differs.
    pub notes: Vec<String>,
    /// Which of the records should not be quoted for their times, and why.
    pub warnings: Vec<String>,
}

/// Records that can't be compared.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum CompareError {
    /// One of them is no record.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Manifest(#[from] ManifestError),
    /// One of their tables can't be read.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Table(#[from] TableError),
    /// They are of two experiments.
    #[error("{first} and {second} are different experiments")]
    #[diagnostic(help("compare two records of one experiment"))]
    Experiments {
        /// The first record's.
        first: String,
        /// The second record's.
        second: String,
    },
}

/// Compares the records in two directories.
///
/// # Errors
/// A directory without a whole record; two experiments.
pub fn compare(first: &Path, second: &Path) -> Result<RecordComparison, CompareError> {
    let manifests = [Manifest::read(first)?, Manifest::read(second)?];
    let [a, b] = &manifests;
    if a.experiment != b.experiment {
        return Err(CompareError::Experiments {
            first: a.experiment.clone(),
            second: b.experiment.clone(),
        });
    }
    let mut comparison = RecordComparison {
        ids: [a.id().to_owned(), b.id().to_owned()],
        equal: Vec::new(),
        differences: Vec::new(),
        changes: Vec::new(),
        notes: Vec::new(),
        warnings: manifests.iter().filter_map(disturbed).collect(),
    };
    for (name, digest) in &a.files {
        match b.files.get(name) {
            Some(other) if other == digest => comparison.equal.push(name.clone()),
            Some(_) if name.ends_with(".csv") => {
                let tables = [first, second].map(|place| Table::read(&place.join(name)));
                let [ours, theirs] = tables;
                let strict = a.deterministic.contains(name);
                comparison.tables(name, &ours?, &theirs?, strict);
            }
            Some(_) if a.deterministic.contains(name) => {
                comparison.differ(name, "", None, digest, &b.files[name]);
            }
            Some(_) => {}
            None => comparison.missing(name, [a, b], ["the file", "no such file"]),
        }
    }
    for name in b.files.keys().filter(|name| !a.files.contains_key(*name)) {
        comparison.missing(name, [b, a], ["no such file", "the file"]);
    }
    comparison.rank();
    Ok(comparison)
}

/// The warning about a record whose machine had other load.
fn disturbed(manifest: &Manifest) -> Option<String> {
    let [before, after] = manifest.load?;
    let conditions = Conditions {
        // Our own single thread has been running all the time.
        others: [before.one_minute, (after.one_minute - 1.0).max(0.0)].map(Some),
        ..Conditions::default()
    };
    Some(format!("{}: {}", manifest.id(), conditions.warning()?))
}

impl RecordComparison {
    /// Sorts rows whose interval excludes 1 first, then those whose interval contains 1, then those
    /// without one, and last the control, which culls nothing: its nanoseconds change the most and
    /// mean the least. In each part the largest comes first.
    fn rank(&mut self) {
        let control = Strategy::None.name();
        let class = |change: &MeasuredChange| match change.same {
            _ if change.row.split(", ").any(|part| part == control) => 3,
            Some(false) => 0,
            Some(true) => 1,
            None => 2,
        };
        let size = |change: &MeasuredChange| change.ratio.ln().abs();
        self.changes.sort_by(|a, b| {
            let by_size = || size(b).total_cmp(&size(a));
            class(a).cmp(&class(b)).then_with(by_size)
        });
    }

    /// The largest growth of a measured number that its interval confirms: 0.1 is ten percent.
    #[must_use]
    pub fn slowest(&self) -> f64 {
        let confirmed = self
            .changes
            .iter()
            .filter(|change| change.same == Some(false));
        confirmed
            .map(|change| change.ratio - 1.0)
            .fold(0.0, f64::max)
    }

    fn differ(&mut self, file: &str, row: &str, column: Option<&str>, first: &str, second: &str) {
        self.differences.push(CountDifference {
            file: file.to_owned(),
            row: row.to_owned(),
            column: column.map(str::to_owned),
            first: first.to_owned(),
            second: second.to_owned(),
        });
    }

    /// A file that one record has and the other lacks. Earlier versions wrote records without any
    /// file of counts; those don't lack one.
    fn missing(&mut self, file: &str, [has, lacks]: [&Manifest; 2], [first, second]: [&str; 2]) {
        let is_counted = has.deterministic.iter().any(|name| name == file);
        if is_counted && !lacks.deterministic.is_empty() {
            self.differ(file, "", None, first, second);
        } else {
            self.notes.push(format!("{file}: {first}, {second}"));
        }
    }

    /// Compares the columns that both tables have; of a strict table, all must be equal.
    fn tables(&mut self, file: &str, a: &Table, b: &Table, strict: bool) {
        let columns: Vec<String> = a
            .columns
            .iter()
            .filter(|column| b.columns.contains(column))
            .cloned()
            .collect();
        if columns != a.columns || columns != b.columns {
            if strict {
                let (a, b) = (a.columns.join(","), b.columns.join(","));
                return self.differ(file, "header", None, &a, &b);
            }
            self.notes
                .push(format!("{file}: only the columns of both are compared"));
        }
        let kinds = kinds(&columns, a, b);
        let (Some(ours), Some(mut others)) =
            (by_name(a, &columns, &kinds), by_name(b, &columns, &kinds))
        else {
            return self.notes.push(format!(
                "{file}: not compared, its rows can't be told apart by the columns of both"
            ));
        };
        let before = self.changes.len();
        let mut lacking = 0;
        for (name, row) in &ours {
            let Some(other) = others.remove(name) else {
                lacking += 1;
                continue;
            };
            for (column, kind) in columns.iter().zip(&kinds) {
                self.cells(file, name, (column, *kind, strict), [row, other]);
            }
        }
        let raw = self.changes.split_off(before);
        self.changes.extend(over_seeds(raw));
        let (common, extra) = (ours.len() - lacking, others.len());
        if strict && common == 0 && lacking + extra > 0 {
            let rows = |count: usize| format!("{count} rows");
            self.differ(
                file,
                "no row is in both",
                None,
                &rows(lacking),
                &rows(extra),
            );
        } else if lacking + extra > 0 {
            self.notes.push(format!(
                "{file}: {common} rows compared; {lacking} rows only in the first, {extra} only in the second"
            ));
        }
    }

    fn cells(
        &mut self,
        file: &str,
        row: &str,
        (column, kind, strict): (&String, ColumnKind, bool),
        cells: [&Map<String, Value>; 2],
    ) {
        let [a, b] = cells.map(|cells| &cells[column]);
        let measured = matches!(
            kind,
            ColumnKind::Measured | ColumnKind::Interval | ColumnKind::Found
        );
        if kind == ColumnKind::Count || (strict && measured) {
            if a != b {
                self.differ(file, row, Some(column), &a.to_string(), &b.to_string());
            }
        } else if kind == ColumnKind::Measured {
            self.changes.extend(change(file, row, column, cells));
        } else if kind == ColumnKind::Found && a != b {
            self.notes
                .push(format!("{file}: {row}: {column} {a} and {b}"));
        }
    }
}

/// Combines raw samples, one row per seed, into one change: the geometric mean of their ratios.
/// Other changes stay.
fn over_seeds(changes: Vec<MeasuredChange>) -> Vec<MeasuredChange> {
    let mut groups: BTreeMap<(String, String), Vec<MeasuredChange>> = BTreeMap::new();
    let mut rest = Vec::new();
    for change in changes {
        let parts = change.row.split(", ");
        let others: Vec<&str> = parts.filter(|part| !part.starts_with("seed ")).collect();
        let row = others.join(", ");
        if row == change.row || change.interval.is_some() {
            rest.push(change);
        } else {
            let key = (row, change.column.clone());
            groups.entry(key).or_default().push(change);
        }
    }
    rest.extend(groups.into_iter().map(|((row, column), of)| {
        let logarithms: Vec<f64> = of.iter().map(|change| change.ratio.ln()).collect();
        let Estimate {
            mean, half_width, ..
        } = Estimate::of(&logarithms);
        let ends = [(mean - half_width).exp(), (mean + half_width).exp()];
        let interval = half_width.is_finite().then_some(ends);
        let average = |of_one: fn(&MeasuredChange) -> f64| {
            of.iter().map(of_one).sum::<f64>() / of.len() as f64
        };
        MeasuredChange {
            file: of[0].file.clone(),
            row: format!("{row}, {} seeds", of.len()),
            column,
            first: average(|change| change.first),
            second: average(|change| change.second),
            ratio: mean.exp(),
            interval,
            same: interval.map(|[low, high]| low <= 1.0 && high >= 1.0),
        }
    }));
    rest
}

/// The change of one measured cell, if both rows have it above zero.
fn change(
    file: &str,
    row: &str,
    column: &str,
    cells: [&Map<String, Value>; 2],
) -> Option<MeasuredChange> {
    let [first, second] = cells.map(|cells| cells[column].as_f64().filter(|x| *x > 0.0));
    let (first, second) = (first?, second?);
    let [before, after] = cells.map(|cells| interval(cells, column));
    let interval = before.zip(after).filter(|([low, _], _)| *low > 0.0);
    let interval = interval.map(|(before, after)| [after[0] / before[1], after[1] / before[0]]);
    Some(MeasuredChange {
        file: file.to_owned(),
        row: row.to_owned(),
        column: column.to_owned(),
        first,
        second,
        ratio: second / first,
        interval,
        same: interval.map(|[low, high]| low <= 1.0 && high >= 1.0),
    })
}

/// Rows by their names; none if two have the same.
fn by_name<'a>(
    table: &'a Table,
    columns: &[String],
    kinds: &[ColumnKind],
) -> Option<BTreeMap<String, &'a Map<String, Value>>> {
    let named = |row| (row_name(row, columns, kinds), row);
    let rows: BTreeMap<_, _> = table.rows.iter().map(named).collect();
    (rows.len() == table.rows.len()).then_some(rows)
}

/// What names a row: its naming cells, joined.
fn row_name(row: &Map<String, Value>, columns: &[String], kinds: &[ColumnKind]) -> String {
    let naming = columns
        .iter()
        .zip(kinds)
        .filter(|(_, kind)| **kind == ColumnKind::Name);
    let cells = naming.filter_map(|(column, _)| match &row[column] {
        Value::Null => None,
        Value::String(text) => Some(text.clone()),
        number => Some(format!("{column} {number}")),
    });
    cells.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::super::{FILE, Load};
    use super::*;

    fn record(counts: &str, times: &str) -> tempfile::TempDir {
        let directory = tempfile::tempdir().unwrap();
        std::fs::write(directory.path().join("counts.csv"), counts).unwrap();
        std::fs::write(directory.path().join("times.csv"), times).unwrap();
        let manifest = Manifest::describe(directory.path(), "test", String::new(), &["counts.csv"]);
        std::fs::write(directory.path().join(FILE), manifest.unwrap().text()).unwrap();
        directory
    }

    const COUNTS: &str = "scene,hits\na,10\nb,20\n";
    const TIMES: &str =
        "scene,bodies,pairs,ms,ms_low,ms_high\na,500,7,1.0,0.9,1.1\nb,500,9,2.5,2.4,2.6\n";

    #[test]
    fn a_record_equals_itself() {
        let record = record(COUNTS, TIMES);
        let comparison = compare(record.path(), record.path()).unwrap();
        assert_eq!(comparison.equal, ["counts.csv", "times.csv"]);
        assert!(comparison.differences.is_empty() && comparison.changes.is_empty());
    }

    #[test]
    fn a_count_that_differs_is_named() {
        let (a, b) = (
            record(COUNTS, TIMES),
            record(&COUNTS.replace("20", "21"), TIMES),
        );
        let differences = compare(a.path(), b.path()).unwrap().differences;
        assert_eq!(differences.len(), 1);
        let CountDifference {
            row,
            column,
            second,
            ..
        } = &differences[0];
        assert_eq!(
            (row.as_str(), column.as_deref(), second.as_str()),
            ("b", Some("hits"), "21")
        );
        let c = record(COUNTS, &TIMES.replace(",9,", ",8,"));
        let differences = compare(a.path(), c.path()).unwrap().differences;
        assert_eq!(differences[0].column.as_deref(), Some("pairs"));
    }

    #[test]
    fn raw_samples_compare_over_their_seeds() {
        let times = |factor: f64| {
            let row = |seed| format!("a,{seed},{}\n", factor * (1.0 + 0.01 * f64::from(seed)));
            format!("scene,seed,ms\n{}", (1..=5).map(row).collect::<String>())
        };
        let (a, b) = (record(COUNTS, &times(1.0)), record(COUNTS, &times(2.0)));
        let changes = compare(a.path(), b.path()).unwrap().changes;
        assert_eq!(changes.len(), 1);
        assert_eq!(changes[0].row, "a, 5 seeds");
        assert!((changes[0].ratio - 2.0).abs() < 1e-12 && changes[0].same == Some(false));
    }

    /// Another set of columns or rows is noted where nothing is promised.
    #[test]
    fn other_columns_or_rows_are_noted() {
        let other = TIMES
            .replace("ms_high", "ms_high,cold")
            .replace("1.1\n", "1.1,3\n")
            .replace("2.6\n", "2.6,4\n");
        let (a, b) = (record(COUNTS, TIMES), record(COUNTS, &other));
        let comparison = compare(a.path(), b.path()).unwrap();
        assert!(comparison.differences.is_empty() && !comparison.changes.is_empty());
        assert_eq!(comparison.notes.len(), 1);
        let fewer = TIMES.lines().take(2).collect::<Vec<_>>().join("\n");
        let c = record(COUNTS, &fewer);
        let comparison = compare(a.path(), c.path()).unwrap();
        assert!(comparison.differences.is_empty());
        assert!(
            comparison.notes[0].contains("1 rows compared; 1 rows only in the first"),
            "{:?}",
            comparison.notes
        );
    }

    /// A quick run has fewer rows: those that both have are compared, all others are one line.
    #[test]
    fn missing_rows_are_one_line() {
        let rows = |from: u32, to: u32| -> String {
            let row = |n: u32| format!("scene-{n},{n}\n");
            format!("scene,hits\n{}", (from..to).map(row).collect::<String>())
        };
        let (a, b) = (record(&rows(0, 3000), TIMES), record(&rows(0, 30), TIMES));
        let comparison = compare(a.path(), b.path()).unwrap();
        assert!(
            comparison.differences.is_empty(),
            "{:?}",
            comparison.differences
        );
        assert_eq!(
            comparison.notes,
            ["counts.csv: 30 rows compared; 2970 rows only in the first, 0 only in the second"]
        );
        let wrong = rows(0, 30).replace("scene-7,7", "scene-7,8");
        let comparison = compare(a.path(), record(&wrong, TIMES).path()).unwrap();
        assert_eq!(comparison.differences.len(), 1);
        // Nothing compared is nothing shown.
        let others = record(&rows(4000, 4003), TIMES);
        assert_eq!(
            compare(a.path(), others.path()).unwrap().differences.len(),
            1
        );
    }

    #[test]
    fn older_records_lack_no_counts() {
        let older = record(COUNTS, TIMES);
        std::fs::remove_file(older.path().join("counts.csv")).unwrap();
        let write = |deterministic: &[&str]| {
            let manifest = Manifest::describe(older.path(), "test", String::new(), deterministic);
            std::fs::write(older.path().join(FILE), manifest.unwrap().text()).unwrap();
        };
        let newer = record(COUNTS, TIMES);
        write(&[]);
        let comparison = compare(older.path(), newer.path()).unwrap();
        assert!(comparison.differences.is_empty());
        assert_eq!(comparison.notes, ["counts.csv: no such file, the file"]);
        // One that counts other things does lack it.
        write(&["times.csv"]);
        for [a, b] in [[&older, &newer], [&newer, &older]] {
            let comparison = compare(a.path(), b.path()).unwrap();
            assert_eq!(comparison.differences[0].file, "counts.csv");
        }
    }

    #[test]
    fn the_control_is_ranked_last() {
        let times = |control: f64, s_dop: f64| {
            format!("strategy,ms\nnone,{control}\ns-dop-batch,{s_dop}\n")
        };
        let a = record(COUNTS, &times(0.001, 1.0));
        let b = record(COUNTS, &times(0.009, 1.5));
        let comparison = compare(a.path(), b.path()).unwrap();
        let rows: Vec<&str> = comparison.changes.iter().map(|c| c.row.as_str()).collect();
        assert_eq!(rows, ["s-dop-batch", "none"]);
    }

    #[test]
    fn a_loaded_machine_is_warned_of() {
        let load = |one_minute: f64| Load {
            one_minute,
            five_minutes: 0.0,
        };
        let directory = record(COUNTS, TIMES);
        let mut manifest =
            Manifest::describe(directory.path(), "test", String::new(), &[]).unwrap();
        manifest.load = Some([load(0.1), load(1.2)]);
        assert_eq!(disturbed(&manifest), None);
        manifest.load = Some([load(0.1), load(3.5)]);
        let warning = disturbed(&manifest).unwrap();
        assert!(warning.contains("2.5 after"), "{warning}");
    }

    /// Times are ratios and same only where intervals meet.
    #[test]
    fn times_compare_by_intervals() {
        let slower = TIMES
            .replace("1.0,0.9,1.1", "1.1,1.0,1.2")
            .replace("2.5,2.4,2.6", "5.0,4.8,5.2");
        let comparison =
            compare(record(COUNTS, TIMES).path(), record(COUNTS, &slower).path()).unwrap();
        let [b, a] = &comparison.changes[..] else {
            panic!("two changes")
        };
        assert_eq!((b.ratio, b.same), (2.0, Some(false)));
        assert_eq!(a.same, Some(true));
        assert_eq!(comparison.slowest(), 1.0);
        assert!(comparison.differences.is_empty());
    }
}
