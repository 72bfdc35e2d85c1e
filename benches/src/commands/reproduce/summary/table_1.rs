//! Table 1 under every reading, the paper's numbers beside ours, and which of its rows come out.

use std::fmt::{Result, Write as _};

use sdop::settings::Strategy;
use sdop_bench::reproduce::readings::{Cell, Reading, TABLE_1_STRATEGIES};
use sdop_bench::reproduce::{paper, paper_name};

use super::text::{header, interval};
use crate::commands::reproduce::rows::Tables;

/// A row reproduces when every mean is this near to the paper's number.
const NEAR: f64 = 0.15;
/// It is of the same magnitude when no mean is further off than this factor.
const MAGNITUDE: f64 = 2.0;

/// Ours over the paper's in its columns, under the reading that comes nearest.
pub struct StrategyMatch {
    pub strategy: Strategy,
    pub reading: Reading,
    pub ratios: Vec<Option<f64>>,
}

impl StrategyMatch {
    /// The nearest reading is the one with the least worst ratio.
    fn new(tables: &Tables, strategy: Strategy) -> Self {
        let with = |&reading: &Reading| {
            let ratio = |n: &usize| {
                let of =
                    |c: &&Cell| c.reading == reading && c.strategy == strategy && c.bodies == *n;
                tables.table_1.iter().filter(of).find_map(Cell::ratio)
            };
            let ratios = paper::TABLE_1_BODIES.iter().map(ratio).collect();
            Self {
                strategy,
                reading,
                ratios,
            }
        };
        let worst = |row: &Self| {
            row.ratios
                .iter()
                .flatten()
                .map(|ratio| ratio.ln().abs())
                .fold(0.0, f64::max)
        };
        let rows = Reading::ALL.iter().map(with);
        rows.min_by(|one, other| worst(one).total_cmp(&worst(other)))
            .unwrap_or_else(|| with(&Reading::OwnTests))
    }

    /// Whether no column is off by more than a factor of two.
    pub fn same_magnitude(&self) -> bool {
        let mut ratios = self.ratios.iter().flatten().peekable();
        let near = |ratio: &f64| (1.0 / MAGNITUDE..=MAGNITUDE).contains(ratio);
        ratios.peek().is_some() && ratios.all(near)
    }

    /// In words: near in every column, of the same magnitude, or neither.
    pub fn verdict(&self) -> &'static str {
        match (self.reproduces(), self.same_magnitude()) {
            (true, _) => "reproduces",
            (false, true) => "same magnitude, trend not reproduced",
            (false, false) => "neither trend nor magnitude",
        }
    }

    /// Whether all columns are near the paper's.
    pub fn reproduces(&self) -> bool {
        let mut ratios = self.ratios.iter().flatten().peekable();
        ratios.peek().is_some() && ratios.all(|ratio| (ratio - 1.0).abs() <= NEAR)
    }
}

/// The rows of the paper's table.
pub fn rows(tables: &Tables) -> impl Iterator<Item = StrategyMatch> + '_ {
    TABLE_1_STRATEGIES
        .into_iter()
        .map(|strategy| StrategyMatch::new(tables, strategy))
}

pub fn section(out: &mut String, tables: &Tables) -> Result {
    writeln!(
        out,
        "## Table 1 and Fig. 14: collisions detected in percent of tests\n"
    )?;
    writeln!(out, "![percentages](figures/useful_tests.svg)\n")?;
    writeln!(
        out,
        "In brackets the paper's numbers; it says 350 objects in the text and 300 in the table. \
         Each strategy under the reading that its figures have; every other reading stands in the appendix.\n"
    )?;
    cells(out, tables, |cell| {
        cell.reading == Reading::shown(cell.strategy)
    })?;
    writeln!(
        out,
        "\nOurs over the paper's under the reading that comes nearest. The criterion, stated first: a row reproduces when all columns are \
         within {:.0} %, and is of the same magnitude when none is off by more than a factor of {MAGNITUDE}:\n",
        100.0 * NEAR
    )?;
    let columns = paper::TABLE_1_BODIES.map(|n| format!("N = {n}"));
    header(
        out,
        &[
            &["strategy", "reading"],
            &columns.each_ref().map(String::as_str)[..],
            &["verdict"],
        ]
        .concat(),
    )?;
    for row in rows(tables) {
        let cell =
            |ratio: &Option<f64>| ratio.map_or("–".to_owned(), |ratio| format!("{ratio:.2}"));
        let cells: Vec<String> = row.ratios.iter().map(cell).collect();
        let verdict = row.verdict();
        writeln!(
            out,
            "| {} | {} | {} | {verdict} |",
            paper_name(row.strategy),
            row.reading,
            cells.join(" | ")
        )?;
    }
    writeln!(out, "\n![sphere percentage](figures/sphere.svg)\n")
}

/// Table 1 under every reading.
pub fn appendix(out: &mut String, tables: &Tables) -> Result {
    writeln!(
        out,
        "## Appendix: Table 1 under every reading of \"tests\"\n"
    )?;
    cells(out, tables, |_| true)?;
    writeln!(out)
}

fn cells(out: &mut String, tables: &Tables, wanted: impl Fn(&Cell) -> bool) -> Result {
    let scenes: Vec<&str> = tables.boxes.iter().map(|row| row.scene.as_str()).collect();
    header(out, &[&["reading", "strategy"], &scenes[..]].concat())?;
    for &reading in Reading::ALL {
        for strategy in TABLE_1_STRATEGIES {
            let of = |c: &&Cell| c.reading == reading && c.strategy == strategy && wanted(c);
            let mut row = tables.table_1.iter().filter(of).peekable();
            if row.peek().is_none() {
                continue;
            }
            write!(out, "| {reading} | {} |", paper_name(strategy))?;
            for cell in row {
                let paper = cell
                    .paper
                    .map_or(String::new(), |paper| format!(" ({paper:.2})"));
                write!(out, " {}{paper} |", interval(&cell.measured))?;
            }
            writeln!(out)?;
        }
    }
    Ok(())
}
