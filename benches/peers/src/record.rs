//! What is written: rows as CSV and JSON, and a page with a table a case, each with the machine and the command.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use miette::{IntoDiagnostic as _, WrapErr as _};
use sdop::cost::machine::Machine;
use sdop::simd::Level;
use serde::Serialize;

use crate::compare::{Case, Row};
use crate::scenes::{Order, Spread};

/// The flag that compiles the same engines in.
const FEATURES: &str = match (cfg!(feature = "physx"), cfg!(feature = "debian")) {
    (true, true) => " --features physx,debian",
    (true, false) => " --features physx",
    (false, true) => " --features debian",
    (false, false) => "",
};

/// A measurement.
#[derive(Serialize)]
pub struct Record {
    command: String,
    machine: Machine,
    /// Features of the CPU that engines in Rust were compiled for; ours asks at run time.
    compiled_for: &'static str,
    /// What else ran, in the measurer's words.
    note: String,
    /// Processes waiting for a CPU, one minute's mean, at the beginning and by now.
    load: [String; 2],
    rows: Vec<Row>,
}

impl Record {
    /// An empty record of this machine.
    pub fn new(note: String) -> Self {
        let arguments = std::env::args().skip(1).collect::<Vec<_>>().join(" ");
        Self {
            command: format!("cargo run --release -p sdop-peers{FEATURES} -- {arguments}"),
            machine: Machine::here(Level::detect()),
            compiled_for: match (
                cfg!(target_feature = "avx512f"),
                cfg!(target_feature = "avx2"),
            ) {
                (true, _) => "AVX-512",
                (_, true) => "AVX2",
                _ => "the architecture's baseline",
            },
            note,
            load: [load(), load()],
            rows: Vec::new(),
        }
    }

    /// Adds a case's rows.
    pub fn add(&mut self, rows: Vec<Row>) {
        self.load[1] = load();
        self.rows.extend(rows);
    }

    /// Writes `peers.csv`, `peers.json` and `peers.md`.
    pub fn write(&self, directory: &Path) -> miette::Result<()> {
        let json = serde_json::to_string_pretty(self).into_diagnostic()?;
        let files = [
            ("peers.csv", self.csv()?),
            ("peers.json", json + "\n"),
            ("peers.md", self.page()),
        ];
        let blame = || format!("writing to {}", directory.display());
        fs::create_dir_all(directory)
            .into_diagnostic()
            .wrap_err_with(blame)?;
        for (name, text) in files {
            fs::write(directory.join(name), text)
                .into_diagnostic()
                .wrap_err_with(blame)?;
        }
        Ok(())
    }

    fn csv(&self) -> miette::Result<String> {
        let mut out = csv::WriterBuilder::new()
            .has_headers(false)
            .from_writer(Vec::new());
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
            "ns_a_body",
            "ratio",
            "bytes_a_body",
            "peak_bytes_a_body",
        ])
        .into_diagnostic()?;
        for row in &self.rows {
            let Case {
                spread,
                order,
                bodies,
                threads,
                schedule,
            } = row.case;
            out.serialize((
                (
                    spread,
                    order,
                    bodies,
                    threads,
                    schedule.warm_up,
                    schedule.timed,
                ),
                (row.engine, row.version, row.work, row.pairs),
                (row.ms_low, row.ms, row.ms_high, row.ns_a_body, row.ratio),
                (row.bytes_a_body, row.peak_bytes_a_body),
            ))
            .into_diagnostic()?;
        }
        let bytes = out.into_inner().into_diagnostic()?;
        String::from_utf8(bytes).into_diagnostic()
    }

    /// The tables with what must be known to read them.
    pub fn page(&self) -> String {
        let mut out = String::from("# Side by side\n\n");
        let facts = [
            format!("`{}`", self.command),
            self.machine.to_string(),
            format!("engines in Rust are compiled for {}", self.compiled_for),
            format!("load {} at the beginning, {} at the end; {}", self.load[0], self.load[1], self.note),
            "milliseconds a frame, median (times ours for the same boxes); bytes a body that are held".to_owned(),
            "what favours or harms whom: `benches/peers/BIAS.md`".to_owned(),
        ];
        for fact in facts {
            // Writing to a String cannot fail.
            let _ = writeln!(out, "- {fact}");
        }
        let mut tables: Vec<(Spread, Order, usize)> = Vec::new();
        for row in &self.rows {
            let table = (row.case.spread, row.case.order, row.case.threads);
            if !tables.contains(&table) {
                tables.push(table);
            }
        }
        for table in tables {
            self.table(&mut out, table);
        }
        out
    }

    fn table(&self, out: &mut String, (spread, order, threads): (Spread, Order, usize)) {
        let rows: Vec<&Row> = self
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
                let cell = rows
                    .iter()
                    .find(|row| row.engine == engine && row.case.bodies == size);
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
}

/// Three digits that count.
fn digits(ms: f64) -> String {
    let decimals = (2 - ms.log10().floor() as i32).clamp(0, 6) as usize;
    format!("{ms:.decimals$}")
}

/// The first number of the system's load average, where a file tells it.
fn load() -> String {
    let text = fs::read_to_string("/proc/loadavg").unwrap_or_default();
    text.split(' ').next().unwrap_or("unknown").to_owned()
}
