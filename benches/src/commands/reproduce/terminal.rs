//! The results for the terminal.

use std::fmt::{Result, Write as _};

use sdop_bench::cost::table::Cost;
use sdop_bench::report::digits::{interval, number};
use sdop_bench::reproduce::paper_name;
use sdop_bench::reproduce::readings::{Reading, TABLE_1_STRATEGIES, Table1Cell};

use super::rows::{Tables, distinct};
use crate::commands::output::{paragraphs, table};

/// Table 1, times and verdicts; `place` is where the rest was written.
pub fn brief(tables: &Tables, seconds: f64, place: &str) -> String {
    let mut out = String::new();
    // Writing to a String cannot fail.
    let _ = sections(&mut out, tables);
    let _ = writeln!(out, "\n{seconds:.1} s; written to {place}");
    paragraphs(&out)
}

fn sections(out: &mut String, tables: &Tables) -> Result {
    let scenes: Vec<&str> = tables.drawn.boxes.iter().map(|row| row.scene.as_str()).collect();
    let heads = [&["strategy"], &scenes[..]].concat();
    writeln!(
        out,
        "Collisions in percent of tests, {} seeds of {} frames; in brackets the paper's",
        tables.seeds.len(),
        tables.frames
    )?;
    let mut rows = table(&heads);
    for strategy in TABLE_1_STRATEGIES {
        let reading = Reading::shown(strategy);
        let of = |cell: &&Table1Cell| cell.reading == reading && cell.strategy == strategy;
        let cell = |cell: &Table1Cell| {
            let paper = cell.paper.map_or(String::new(), |paper| format!(" ({paper:.2})"));
            format!("{}{paper}", interval(&cell.measured))
        };
        let cells = tables.drawn.table_1.iter().filter(of).map(cell);
        rows.add_row(std::iter::once(paper_name(strategy).to_owned()).chain(cells));
    }
    writeln!(
        out,
        "{rows}\n\nCulling, µs per warm frame, and how far the formula's prediction is off"
    )?;
    let mut rows = table(&heads);
    for strategy in distinct(tables.drawn.costs.iter().map(|cost| cost.strategy)) {
        let of = |cost: &&Cost| cost.strategy == strategy;
        let cell = |cost: &Cost| {
            format!(
                "{} ({:+.0} %)",
                number(1e6 * cost.frame.measured.mean),
                100.0 * cost.frame.residual.mean
            )
        };
        let cells = tables.drawn.costs.iter().filter(of).map(cell);
        rows.add_row(std::iter::once(paper_name(strategy).to_owned()).chain(cells));
    }
    if let Some(warning) = tables.conditions.warning() {
        writeln!(out, "{rows}\n\n{warning}\n\nThe paper's claims")?;
    } else {
        writeln!(out, "{rows}\n\nThe paper's claims")?;
    }
    for claim in &tables.claims {
        writeln!(out, "{:<12} {}", claim.verdict().name(), claim.claim)?;
    }
    Ok(())
}
