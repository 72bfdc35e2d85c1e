//! The record of all cases: rows as CSV and JSON, and a page with a table per number of bodies.

use std::fmt::Write as _;
use std::path::Path;

use miette::IntoDiagnostic as _;

use super::measure::MoverTiming;
use super::schedule::MoverCase;
use crate::facts;
use crate::record::digits;

/// A comparison.
pub type Record = facts::Record<MoverTiming, MoverCase>;

impl Record {
    /// Writes `movers.csv`, `movers.json` and `movers.md`.
    pub fn write(&self, directory: &Path) -> miette::Result<()> {
        facts::write(directory, "movers", self.csv()?, self, self.page())
    }

    fn csv(&self) -> miette::Result<String> {
        let mut out = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
        let header = "bodies movers motion of warm_up timed engine version margin events \
            pairs extra us_low us us_high us_p50 us_p99 us_most ratio bytes_a_body";
        out.write_record(header.split(' ').filter(|word| !word.is_empty())).into_diagnostic()?;
        for row in &self.timings.rows {
            let MoverCase { bodies, movers, motion, meshes, warm_up, timed, turn: _ } = row.case;
            let of = if meshes { "meshes" } else { "boxes" };
            out.serialize((
                (bodies, movers, motion, of, warm_up, timed),
                (row.engine, row.version, row.margin, row.events),
                (row.pairs, row.extra),
                (row.us_low, row.us, row.us_high),
                (row.us_p50, row.us_p99, row.us_most),
                (row.ratio, row.bytes_a_body),
            ))
            .into_diagnostic()?;
        }
        let bytes = out.into_inner().into_diagnostic()?;
        String::from_utf8(bytes).into_diagnostic()
    }

    /// The tables with what must be known to read them.
    pub fn page(&self) -> String {
        let mut out = format!("# Few movers\n\n{}", self.facts);
        out.push_str(
            "- microseconds per frame, the mean of a turn, median over turns; times ours; single frames; \
             bytes per body that are held\n\
             - what favours or harms whom: `benches/engines/BIAS.md`\n",
        );
        let mut cases: Vec<MoverCase> = Vec::new();
        for row in &self.timings.rows {
            if !cases.contains(&row.case) {
                cases.push(row.case);
            }
        }
        for case in cases {
            self.table(&mut out, case);
        }
        out
    }

    fn table(&self, out: &mut String, case: MoverCase) {
        // Writing to a String cannot fail.
        let _ = write!(
            out,
            "\n## {case}\n\n\
             | engine | margin | answer | pairs | extra | µs | × ours | p50 | p99 | most | B |\n\
             |---|--:|---|--:|--:|--:|--:|--:|--:|--:|--:|\n"
        );
        for row in self.timings.rows.iter().filter(|row| row.case == case) {
            let [us, p50, p99, most] = [row.us, row.us_p50, row.us_p99, row.us_most].map(digits);
            let answer = if row.events { "events" } else { "pairs" };
            let _ = writeln!(
                out,
                "| {} {} | {} | {answer} | {} | {} | {us} | {:.2} | {p50} | {p99} | {most} | {:.0} |",
                row.engine,
                row.version,
                row.margin,
                row.pairs,
                row.extra,
                row.ratio,
                row.bytes_a_body
            );
        }
        for left in self.timings.left_out.iter().filter(|left| left.case == case) {
            let _ = write!(
                out,
                "\nLeft out: {}, {:.0} ms in one of its first frames, limit {:.0}.\n",
                left.engine, left.ms, left.limit_ms
            );
        }
    }
}
