//! The matrix of what was judged, in two projections: thousands of cells are too many to read, and a tier, a mode or a
//! finder that was left out shows in one of them.

use std::collections::BTreeMap;

use sdop::lab::verify::matrix::{Cell, Filled, Matrix};
use sdop::lab::verify::ways::{Rotation, refines};
use sdop::settings::{Finder, Strategy};
use serde::Serialize;

use crate::cli::output::table;

/// How full the matrix is.
#[derive(Default, Serialize)]
pub struct Coverage {
    /// Cells that can be filled.
    cells: u64,
    /// Cells that are.
    filled: u64,
    /// The fewest lists judged in a cell.
    fewest: u64,
    /// What can't exist, and so has no cell.
    impossible: String,
    /// By strategy and overlap test against finder: over k, axes, updates, tiers and threads.
    by_strategy: BTreeMap<String, BTreeMap<&'static str, Filled>>,
    /// By tier, updates and threads against k and axes: over strategies, overlap tests and finders.
    by_mode: BTreeMap<String, BTreeMap<String, Filled>>,
    /// The cells without a list, by name.
    empty: Vec<String>,
}

impl Coverage {
    pub fn of(matrix: &Matrix, rotation: &Rotation) -> Self {
        let all = matrix
            .fold(rotation, |_| ())
            .remove(&())
            .unwrap_or_default();
        let unrefined = Strategy::ALL.iter().filter(|strategy| !refines(**strategy));
        let unrefined: Vec<&str> = unrefined.map(|strategy| strategy.name()).collect();
        Self {
            cells: all.cells,
            filled: all.filled,
            fewest: all.fewest,
            impossible: format!(
                "{} have no overlap test: one row instead of three",
                unrefined.join(", ")
            ),
            by_strategy: nest(matrix.fold(rotation, |cell| (strategy(cell), cell.finder.name()))),
            by_mode: nest(matrix.fold(rotation, |cell| (mode(cell), variant(cell)))),
            empty: matrix.empty(rotation).iter().map(name).collect(),
        }
    }

    pub fn is_full(&self) -> bool {
        self.empty.is_empty()
    }

    /// Both projections, and the empty cells.
    pub fn tables(&self) -> String {
        let finders = projection("cells with lists", Finder::NAMES, &self.by_strategy);
        let variants = self.by_mode.values().next();
        let variants: Vec<&String> = variants.map_or_else(Vec::new, |row| row.keys().collect());
        let modes = projection("cells with lists", &variants, &self.by_mode);
        let mut text = format!(
            "What was judged: {} of {} cells, each by {} lists or more ({})\n{finders}\n{modes}",
            self.filled, self.cells, self.fewest, self.impossible
        );
        for cell in &self.empty {
            text += &format!("\nempty: {cell}");
        }
        text
    }
}

/// One table: filled cells of all, and the fewest lists in one.
fn projection<K: Ord + std::borrow::Borrow<str>>(
    corner: &str,
    columns: &[impl AsRef<str>],
    rows: &BTreeMap<String, BTreeMap<K, Filled>>,
) -> comfy_table::Table {
    let columns: Vec<&str> = columns.iter().map(AsRef::as_ref).collect();
    let mut printed = table(&[&[corner], &columns[..]].concat());
    for (name, row) in rows {
        let entry = |column: &&str| {
            let filled = row.get(*column).copied().unwrap_or_default();
            format!("{}/{} ≥{}", filled.filled, filled.cells, filled.fewest)
        };
        printed.add_row([name.clone()].into_iter().chain(columns.iter().map(entry)));
    }
    printed
}

fn nest<K: Ord>(folded: BTreeMap<(String, K), Filled>) -> BTreeMap<String, BTreeMap<K, Filled>> {
    let mut nested: BTreeMap<String, BTreeMap<K, Filled>> = BTreeMap::new();
    for ((row, column), filled) in folded {
        nested.entry(row).or_default().insert(column, filled);
    }
    nested
}

fn strategy(cell: &Cell) -> String {
    let overlap = cell.overlap.map(|overlap| format!(" {overlap}"));
    format!("{}{}", cell.strategy, overlap.unwrap_or_default())
}

fn variant(cell: &Cell) -> String {
    format!("{} {}", cell.k, cell.axes)
}

fn mode(cell: &Cell) -> String {
    let plural = if cell.threads == 1 { "" } else { "s" };
    format!(
        "{} {} {} thread{plural}",
        cell.tier, cell.updates, cell.threads
    )
}

fn name(cell: &Cell) -> String {
    let (strategy, finder) = (strategy(cell), cell.finder);
    format!(
        "{strategy}, {finder}, k = {}, {}",
        variant(cell),
        mode(cell)
    )
}
