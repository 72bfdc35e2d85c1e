//! A recorded CSV table as rows of named values.

use std::path::Path;

use miette::miette;
use serde_json::{Map, Value};

/// A table: its columns in order and its rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Names of the columns.
    pub columns: Vec<String>,
    /// One object per row: numbers as numbers, empty cells as null.
    pub rows: Vec<Map<String, Value>>,
}

impl Table {
    /// Reads a table.
    ///
    /// # Errors
    /// The file can't be read, or a row has more or fewer cells than the header.
    pub fn read(path: &Path) -> miette::Result<Self> {
        let failed = |error: csv::Error| {
            miette!(
                help = "records hold comma-separated tables with one header line",
                "{}: {error}",
                path.display()
            )
        };
        let mut reader = csv::Reader::from_path(path).map_err(failed)?;
        let header = reader.headers().map_err(failed)?;
        let columns: Vec<String> = header.iter().map(str::to_owned).collect();
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(failed)?;
            let cells = columns.iter().cloned().zip(record.iter().map(value));
            rows.push(cells.collect());
        }
        Ok(Self { columns, rows }.with_metrics())
    }

    /// A table of numbers by `strategy`, `volume` and `term`, as earlier versions wrote them, with
    /// `variant` and `metric` instead.
    fn with_metrics(mut self) -> Self {
        let has = |name: &str| self.columns.iter().any(|column| column == name);
        if !(has("strategy") && has("volume") && has("term")) {
            return self;
        }
        self.columns.retain(|column| column != "volume");
        for (from, to) in [("strategy", "variant"), ("term", "metric")] {
            self.columns.iter_mut().filter(|column| *column == from).for_each(|c| *c = to.into());
        }
        for row in &mut self.rows {
            let mut take = |name| row.remove(name).unwrap_or_default();
            let [variant, volume, term] = ["strategy", "volume", "term"].map(&mut take);
            let metric = match (term.as_str(), volume.as_str()) {
                (Some(term), Some(volume)) => format!("{term} ({volume})").into(),
                _ => term,
            };
            row.extend([("variant".to_owned(), variant), ("metric".to_owned(), metric)]);
        }
        self
    }
}

/// A cell: null if empty, a number if it reads as a finite one, text otherwise.
fn value(cell: &str) -> Value {
    if cell.is_empty() {
        return Value::Null;
    }
    if let Ok(whole) = cell.parse::<i64>() {
        return whole.into();
    }
    match cell.parse::<f64>() {
        Ok(number) if number.is_finite() => number.into(),
        _ => cell.into(),
    }
}
