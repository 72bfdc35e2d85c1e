//! The table of times: rows as CSV and JSON, and a page, with the command to repeat it, the
//! machine, and its other load.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use miette::{IntoDiagnostic as _, WrapErr as _};
use sdop::Tier;
use sdop_bench::measure::machine::Machine;
use serde::{Serialize, Serializer};

use crate::case::Case;

/// What one engine did in a case.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The case.
    #[serde(flatten)]
    pub case: Case,
    /// The engine.
    pub engine: &'static str,
    /// Its version.
    pub version: &'static str,
    /// What it finds.
    pub work: &'static str,
    /// The length by which it grows each box.
    pub margin: f64,
    /// Pairs after the last frame, or answers.
    pub pairs: usize,
    /// Those that it need not report.
    pub extra: usize,
    /// Answers to questions that are missing.
    pub missed: usize,
    /// Microseconds per frame or question, the mean of a turn: over turns the lower quartile, the
    /// median and the upper quartile. Then those of single frames: the median, the 99th percentile
    /// and the most.
    pub us: [f64; 6],
    /// Median over turns of its time over ours.
    pub ratio: f64,
    /// Bytes per body that it holds after the checked frames.
    pub bytes_a_body: f64,
    /// The most bytes per body that it had at once; of C++ what it holds.
    pub peak_bytes_a_body: f64,
}

/// The columns of the table.
const HEADER: &str = "workload spread order bodies threads movers motion of question questions \
    warm_up timed engine version work margin pairs extra missed us_low us us_high us_p50 us_p99 \
    us_most ms ratio bytes_a_body peak_bytes_a_body boxes";

/// An engine that took too long in a case.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct LeftOut {
    /// The case.
    #[serde(flatten)]
    pub case: Case,
    /// The engine.
    pub engine: &'static str,
    /// Milliseconds that it took for the frame that gave the reason.
    pub ms: f64,
    /// Milliseconds that it had.
    pub limit_ms: f64,
}

/// A measurement.
#[derive(Serialize)]
pub struct Table {
    command: String,
    machine: Machine,
    /// CPU features for which engines in Rust were compiled; ours detects them at run time.
    compiled_for: &'static str,
    /// What else ran, in the measurer's words.
    note: String,
    /// Processes waiting for a CPU, one minute's mean, at the beginning and by now.
    load: [String; 2],
    #[serde(serialize_with = "named")]
    rows: Vec<Row>,
    left_out: Vec<LeftOut>,
}

/// Rows by the names of their columns.
fn named<S: Serializer>(rows: &[Row], serializer: S) -> Result<S::Ok, S::Error> {
    let row = |row: &Row| {
        let cells = serde_json::to_value(row.cells()).unwrap_or_default();
        let cells = cells.as_array().cloned().unwrap_or_default();
        HEADER.split_whitespace().map(str::to_owned).zip(cells).collect::<serde_json::Map<_, _>>()
    };
    serializer.collect_seq(rows.iter().map(row))
}

impl Row {
    fn cells(&self) -> impl Serialize {
        let Case { workload, spread, order, bodies, threads, movers, .. } = self.case;
        let Case { motion, meshes, question, questions, warm_up, timed, .. } = self.case;
        let of = if meshes { "meshes" } else { "boxes" };
        serde_json::json!([
            workload,
            spread,
            order,
            bodies,
            threads,
            movers,
            motion,
            of,
            question,
            questions,
            warm_up,
            timed,
            self.engine,
            self.version,
            self.work,
            self.margin,
            self.pairs,
            self.extra,
            self.missed,
            self.us[0],
            self.us[1],
            self.us[2],
            self.us[3],
            self.us[4],
            self.us[5],
            self.us[1] / 1e3,
            self.ratio,
            self.bytes_a_body,
            self.peak_bytes_a_body,
            bodies,
        ])
    }
}

impl Table {
    /// An empty table of this machine.
    pub fn new(note: &str) -> Self {
        Self {
            command: command(),
            machine: Machine::here(Tier::detect()),
            compiled_for: match (cfg!(target_feature = "avx512f"), cfg!(target_feature = "avx2")) {
                (true, _) => "AVX-512",
                (_, true) => "AVX2",
                _ => "the architecture's baseline",
            },
            note: note.to_owned(),
            load: [load(), load()],
            rows: Vec::new(),
            left_out: Vec::new(),
        }
    }

    /// Adds a case.
    pub fn add(&mut self, (rows, left_out): (Vec<Row>, Vec<LeftOut>)) {
        self.load[1] = load();
        self.rows.extend(rows);
        self.left_out.extend(left_out);
    }

    /// Writes a CSV, a JSON and a page of a name.
    ///
    /// # Errors
    /// A file that can't be written.
    pub fn write(&self, directory: &Path, name: &str) -> miette::Result<()> {
        let json = serde_json::to_string_pretty(self).into_diagnostic()? + "\n";
        let blame = || format!("writing to {}", directory.display());
        fs::create_dir_all(directory).into_diagnostic().wrap_err_with(blame)?;
        for (ending, text) in [("csv", self.csv()?), ("json", json), ("md", self.page())] {
            sdop::files::write(&directory.join(name).with_extension(ending), text)
                .into_diagnostic()
                .wrap_err_with(blame)?;
        }
        Ok(())
    }

    fn csv(&self) -> miette::Result<String> {
        let mut out = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
        out.write_record(HEADER.split_whitespace()).into_diagnostic()?;
        for row in &self.rows {
            out.serialize(row.cells()).into_diagnostic()?;
        }
        String::from_utf8(out.into_inner().into_diagnostic()?).into_diagnostic()
    }

    /// A table per case, with what must be known to read it.
    pub fn page(&self) -> String {
        let [before, now] = &self.load;
        let mut out = format!(
            "# Times\n\n- `{}`\n- {}\n- engines in Rust are compiled for {}\n\
             - load {before} at the beginning, {now} at the end; {}\n\
             - microseconds per frame or question, the mean of a turn, median over turns; times ours; single \
             frames; bytes per body that are held\n\
             - what favours or harms whom: `benches/field/BIAS.md`\n",
            self.command, self.machine, self.compiled_for, self.note
        );
        let mut cases: Vec<Case> = self.rows.iter().map(|row| row.case).collect();
        cases.dedup();
        for case in cases {
            self.table(&mut out, case);
        }
        out
    }

    fn table(&self, out: &mut String, case: Case) {
        // Writing to a String cannot fail.
        let _ = write!(
            out,
            "\n## {case}\n\n| engine | finds | margin | pairs | extra | missed | µs | × ours | p50 \
             | p99 | most | B |\n|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n"
        );
        for row in self.rows.iter().filter(|row| row.case == case) {
            let Row { engine, version, work, margin, pairs, extra, missed, ratio, .. } = row;
            let [_, us, _, p50, p99, most] = row.us.map(digits);
            let _ = writeln!(
                out,
                "| {engine} {version} | {work} | {margin} | {pairs} | {extra} | {missed} | {us} | \
                 {ratio:.2} | {p50} | {p99} | {most} | {:.0} |",
                row.bytes_a_body
            );
        }
        for left in self.left_out.iter().filter(|left| left.case == case) {
            let LeftOut { engine, ms, limit_ms, .. } = left;
            let _ = write!(
                out,
                "\nLeft out: {engine}, {ms:.0} ms in one of its first frames, limit {limit_ms:.0}.\n"
            );
        }
    }
}

/// `sdop record`'s command where it runs this, or this one's.
fn command() -> String {
    std::env::var("SDOP_COMMAND").unwrap_or_else(|_| {
        let arguments: Vec<_> = std::env::args().skip(1).map(quoted).collect();
        let compiled = [
            (cfg!(feature = "physx"), "physx"),
            (cfg!(feature = "debian"), "debian"),
            (cfg!(feature = "box3d"), "box3d"),
        ];
        let features: Vec<_> = compiled.iter().filter(|it| it.0).map(|it| it.1).collect();
        let features = match features.as_slice() {
            [] => String::new(),
            some => format!(" --features {}", some.join(",")),
        };
        format!("cargo run --profile optimised -p sdop-field{features} -- {}", arguments.join(" "))
    })
}

/// An argument as a shell takes it.
fn quoted(argument: String) -> String {
    if argument.contains(|c: char| c.is_whitespace() || "'\"$&|;<>()*?`\\".contains(c)) {
        format!("'{}'", argument.replace('\'', "'\\''"))
    } else {
        argument
    }
}

/// The first number of the system's load average, where a file has it.
fn load() -> String {
    let text = fs::read_to_string("/proc/loadavg").unwrap_or_default();
    text.split(' ').next().unwrap_or("unknown").to_owned()
}

/// Three digits that count.
fn digits(us: f64) -> String {
    let decimals = (2 - us.log10().floor() as i32).clamp(0, 6) as usize;
    format!("{us:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::quoted;

    /// A command can be given to a shell.
    #[test]
    fn command_survives_a_shell() {
        assert_eq!(quoted("--out".to_owned()), "--out");
        assert_eq!(quoted("PhysX ABP".to_owned()), "'PhysX ABP'");
        assert_eq!(quoted("it's".to_owned()), r"'it'\''s'");
    }
}
