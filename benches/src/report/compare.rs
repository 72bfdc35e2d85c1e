//! Comparing two records: counts must be equal, times are ratios with intervals.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;
use serde_json::{Map, Value};

use super::columns::{ColumnKind, interval, kinds};
use super::manifest::{Manifest, sha256};
use super::provenance::CodeVersion;
use super::table::Table;
use crate::measure::conditions::Conditions;
use crate::measure::estimate::Estimate;
use crate::measure::machine::Machine;
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
    /// Settings, machines and code in which they differ. Where settings do, only rows with equal
    /// names have equal counts, and means are compared by their intervals.
    pub settings: Vec<String>,
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

/// Compares the records in two directories.
///
/// # Errors
/// A directory without a whole record; two experiments.
pub fn compare(first: &Path, second: &Path) -> miette::Result<RecordComparison> {
    let manifests = [Manifest::read(first)?, Manifest::read(second)?];
    let [a, b] = &manifests;
    miette::ensure!(
        a.experiment == b.experiment,
        help = "compare two records of one experiment",
        "{} and {} are different experiments",
        a.experiment,
        b.experiment
    );
    let mut comparison = RecordComparison {
        ids: [a.id().to_owned(), b.id().to_owned()],
        settings: settings(a, b),
        equal: Vec::new(),
        differences: Vec::new(),
        changes: Vec::new(),
        notes: Vec::new(),
        warnings: manifests.iter().filter_map(disturbed).collect(),
    };
    for (name, digest) in &a.files {
        let paths = [first, second].map(|place| place.join(name));
        match b.files.get(name) {
            Some(other) if other == digest => comparison.equal.push(name.clone()),
            Some(_) if name.ends_with(".csv") && paths.iter().all(|path| path.is_file()) => {
                let [ours, theirs] = paths.map(|path| Table::read(&path));
                let strict = a.deterministic.contains(name) && flags(a) == flags(b);
                comparison.tables(name, &ours?, &theirs?, strict);
            }
            Some(_) if a.deterministic.contains(name) && flags(a) == flags(b) => {
                comparison.differ(name, "", None, digest, &b.files[name]);
            }
            Some(_) if name.ends_with(".csv") => {
                comparison.notes.push(format!("{name}: not compared, only the git history has it"));
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

/// The flags that decide what was measured: those of a record's command but where it wrote to.
fn flags(manifest: &Manifest) -> Vec<&str> {
    const OUTPUT: [&str; 3] = ["--out", "--paper", "--name"];
    let given = manifest.command.rsplit_once(" -- ").map_or("", |(_, given)| given);
    let mut words = given.split(' ').skip_while(|word| !word.starts_with("--"));
    let mut flags = Vec::new();
    while let Some(word) = words.next() {
        if OUTPUT.contains(&word) {
            words.next();
        } else {
            flags.push(word);
        }
    }
    flags
}

/// In what two records differ apart from their numbers.
fn settings(a: &Manifest, b: &Manifest) -> Vec<String> {
    let or_none = |text: String| if text.is_empty() { "none".to_owned() } else { text };
    let machine = |manifest: &Manifest| {
        let name = |m: &Machine| format!("{}, {}", m.cpu, m.simd);
        manifest.machine.as_ref().map(name).unwrap_or_default()
    };
    let code = |manifest: &Manifest| {
        let commit = |code: &CodeVersion| code.commit.get(..7).unwrap_or_default().to_owned();
        manifest.code.as_ref().map(commit).unwrap_or_default()
    };
    let inputs = |manifest: &Manifest| {
        let text = serde_json::to_string(&manifest.inputs).unwrap_or_default();
        if manifest.inputs.is_empty() {
            String::new()
        } else {
            sha256(text.as_bytes())[..12].into()
        }
    };
    let kinds: [(&str, [String; 2]); 4] = [
        ("flags", [a, b].map(|manifest| flags(manifest).join(" "))),
        ("machine", [a, b].map(machine)),
        ("code", [a, b].map(code)),
        ("scenes and meshes", [a, b].map(inputs)),
    ];
    let differing = kinds.into_iter().filter(|(_, [a, b])| a != b);
    let line =
        |(what, [a, b]): (&str, [String; 2])| format!("{what}: {} and {}", or_none(a), or_none(b));
    differing.map(line).collect()
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
        let confirmed = self.changes.iter().filter(|change| change.same == Some(false));
        confirmed.map(|change| change.ratio - 1.0).fold(0.0, f64::max)
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
        let columns: Vec<String> =
            a.columns.iter().filter(|column| b.columns.contains(column)).cloned().collect();
        if columns != a.columns || columns != b.columns {
            if strict {
                let (a, b) = (a.columns.join(","), b.columns.join(","));
                return self.differ(file, "header", None, &a, &b);
            }
            self.notes.push(format!("{file}: only the columns of both are compared"));
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
            self.differ(file, "no row is in both", None, &rows(lacking), &rows(extra));
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
        let measured =
            matches!(kind, ColumnKind::Measured | ColumnKind::Interval | ColumnKind::Found);
        if kind == ColumnKind::Count || (strict && measured) {
            if a != b {
                self.differ(file, row, Some(column), &a.to_string(), &b.to_string());
            }
        } else if kind == ColumnKind::Measured {
            self.changes.extend(change(file, row, column, cells));
        } else if kind == ColumnKind::Found && a != b {
            self.notes.push(format!("{file}: {row}: {column} {a} and {b}"));
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
        let Estimate { mean, half_width, .. } = Estimate::of(&logarithms);
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
    // What follows from other rows says nothing of its own: a claim's number, a residual.
    let metric = cells[0].get("metric").and_then(Value::as_str).unwrap_or_default();
    let is_derived = metric.contains("residual") || metric.contains("predicted");
    if is_derived || cells[0].contains_key("claim") {
        return None;
    }
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
    let naming = columns.iter().zip(kinds).filter(|(_, kind)| **kind == ColumnKind::Name);
    let cells = naming.filter_map(|(column, _)| match &row[column] {
        Value::Null => None,
        Value::String(text) => Some(text.clone()),
        number => Some(format!("{column} {number}")),
    });
    cells.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests;
