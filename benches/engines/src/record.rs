//! The record of a comparison: rows as CSV and JSON, and a page with a table per case.

use std::fmt::Write as _;
use std::path::Path;

use miette::IntoDiagnostic as _;

use crate::compare::{Case, EngineTiming};
use crate::facts::{self, LeftOut};
use crate::scenes::{Order, Spread};

/// A comparison.
pub type Record = facts::Record<EngineTiming, Case>;

impl Record {
    /// Writes `peers.csv`, `peers.json` and `peers.md`.
    pub fn write(&self, directory: &Path) -> miette::Result<()> {
        facts::write(directory, "peers", self.csv()?, self, self.page())
    }

    fn csv(&self) -> miette::Result<String> {
        let mut out = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
        out.write_record([
            "spread",
            "order",
            "bodies",
            "threads",
            "warm_up",
            "timed",
            "engine",
            "version",
            "work",
            "pairs",
            "ms_low",
            "ms",
            "ms_high",
            "ms_p50",
            "ms_most",
            "ns_a_body",
            "ratio",
            "bytes_a_body",
            "peak_bytes_a_body",
        ])
        .into_diagnostic()?;
        for row in &self.timings.rows {
            let Case { spread, order, bodies, threads, schedule } = row.case;
            out.serialize((
                (spread, order, bodies, threads, schedule.warm_up, schedule.timed),
                (row.engine, row.version, row.work, row.pairs),
                (row.ms_low, row.ms, row.ms_high, row.ms_p50, row.ms_most),
                (row.ns_a_body, row.ratio),
                (row.bytes_a_body, row.peak_bytes_a_body),
            ))
            .into_diagnostic()?;
        }
        let bytes = out.into_inner().into_diagnostic()?;
        String::from_utf8(bytes).into_diagnostic()
    }

    /// The tables with what must be known to read them.
    pub fn page(&self) -> String {
        let mut out = format!("# Side by side\n\n{}", self.facts);
        out.push_str(
            "- milliseconds a frame, the mean of a turn, median over turns (times ours for the same boxes); bytes a body that are held\n\
             - what favours or harms whom: `benches/engines/BIAS.md`\n",
        );
        let mut tables: Vec<(Spread, Order, usize)> = Vec::new();
        for row in &self.timings.rows {
            let table = (row.case.spread, row.case.order, row.case.threads);
            if !tables.contains(&table) {
                tables.push(table);
            }
        }
        for table in tables {
            self.table(&mut out, table);
            self.list_left_out(&mut out, table);
        }
        out
    }

    fn table(&self, out: &mut String, (spread, order, threads): (Spread, Order, usize)) {
        let rows: Vec<&EngineTiming> = self
            .timings
            .rows
            .iter()
            .filter(|row| {
                (row.case.spread, row.case.order, row.case.threads) == (spread, order, threads)
            })
            .collect();
        let (mut sizes, mut engines) = (Vec::new(), Vec::new());
        for row in &rows {
            if !sizes.contains(&row.case.bodies) {
                sizes.push(row.case.bodies);
            }
            if !engines.contains(&(row.engine, row.version, row.work)) {
                engines.push((row.engine, row.version, row.work));
            }
        }
        let plural = if threads == 1 { "" } else { "s" };
        // Writing to a String cannot fail.
        let _ = write!(
            out,
            "\n## {spread:?}, {order:?} order, {threads} thread{plural}\n\n| engine | finds |"
        );
        for size in &sizes {
            let _ = write!(out, " {size} | B |");
        }
        let _ = write!(out, "\n|---|---|{}\n", "--:|--:|".repeat(sizes.len()));
        for (engine, version, work) in engines {
            let _ = write!(out, "| {engine} {version} | {work} |");
            for &size in &sizes {
                let cell = rows.iter().find(|row| row.engine == engine && row.case.bodies == size);
                let _ = match cell {
                    None => write!(out, " – | – |"),
                    Some(row) => write!(
                        out,
                        " {} ({:.2}) | {:.0} |",
                        digits(row.ms),
                        row.ratio,
                        row.bytes_a_body
                    ),
                };
            }
            out.push('\n');
        }
    }

    fn list_left_out(&self, out: &mut String, (spread, order, threads): (Spread, Order, usize)) {
        let of_table = |left: &&LeftOut<Case>| {
            (left.case.spread, left.case.order, left.case.threads) == (spread, order, threads)
        };
        for left in self.timings.left_out.iter().filter(of_table) {
            let _ = write!(
                out,
                "\nLeft out at {}: {}, {:.0} ms in one of its first frames, limit {:.0}.\n",
                left.case.bodies, left.engine, left.ms, left.limit_ms
            );
        }
    }
}

/// Three digits that count.
pub fn digits(ms: f64) -> String {
    let decimals = (2 - ms.log10().floor() as i32).clamp(0, 6) as usize;
    format!("{ms:.decimals$}")
}
