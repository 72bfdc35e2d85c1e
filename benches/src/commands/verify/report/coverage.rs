//! The map of what was judged, in projections: thousands of cells are too many to read, and a tier,
//! a mode or a finder that was left out shows in one of them.

use sdop::settings::Strategy;
use sdop_judge::configuration::Rotation;
use sdop_judge::configuration::coverage::{Cell, Coverage, CoveragePart, Judged, ListLedger};
use sdop_judge::configuration::world_kind::strategy_name;
use serde::Serialize;

use crate::commands::output::{Listing, table};

/// How full the map is.
#[derive(Default, Serialize)]
pub struct CoverageReport {
    /// Cells of cullers of meshes that can be filled.
    cells: u64,
    /// Cells that are.
    filled: u64,
    /// The fewest lists judged in a cell.
    fewest: u64,
    /// What can't exist, and so has no cell.
    impossible: String,
    /// Lists by strategy and overlap test, and by finder: the sums over k, axes, updates, tiers and
    /// threads.
    by_strategy: Vec<CoverageLine>,
    /// Lists by tier, updates and threads, and by k and axes: the sums over strategies, overlap
    /// tests and finders.
    by_mode: Vec<CoverageLine>,
    /// Pairs of given boxes that meet, summed over frames.
    box_pairs: u64,
    /// Pairs of given boxes that a list had wrongly, or lacked.
    box_wrong: u64,
    /// Lists of given boxes: by tier and threads against finder.
    boxes: Vec<CoverageLine>,
    /// Of long-lived worlds: lists, pairs that had to be reported, those that weren't, and pairs on
    /// which a world and a newly built one differ.
    history_lists: u64,
    history_pairs: u64,
    history_missed: u64,
    history_differ: u64,
    /// Lists of long-lived worlds: by subject against kind of change, over tiers and threads.
    histories: Vec<CoverageLine>,
    /// The cells without a list, by name.
    empty: Vec<String>,
}

/// One line of a projection.
#[derive(Serialize)]
struct CoverageLine {
    name: String,
    parts: Vec<Part>,
}

#[derive(Serialize)]
struct Part {
    name: String,
    #[serde(flatten)]
    filled: CoveragePart,
}

impl CoverageReport {
    pub fn of(
        coverage: &Coverage,
        (boxes, histories): (&ListLedger, &ListLedger),
        rotation: &Rotation,
    ) -> Self {
        let cells = Cell::all(rotation);
        let lines = |name: fn(&Cell) -> Option<[String; 2]>| rows(coverage.fold(&cells, name));
        let of_meshes = |cell: &Cell| matches!(cell.judged, Judged::Meshes(..)).then_some(());
        let (_, all) = coverage.fold(&cells, of_meshes).pop().unwrap_or_default();
        let unrefined =
            Strategy::ALL.iter().filter(|strategy| !strategy.scheme().has_overlap_test());
        let unrefined: Vec<&str> = unrefined.map(|strategy| strategy.name()).collect();
        Self {
            cells: all.cells,
            filled: all.filled,
            fewest: all.fewest,
            impossible: format!(
                "{} have no overlap test: one row instead of three",
                unrefined.join(", ")
            ),
            by_strategy: lines(|cell| match cell.judged {
                Judged::Meshes(strategy, overlap, finder, ..) => {
                    Some([strategy_name(strategy, overlap), finder.to_string()])
                }
                _ => None,
            }),
            by_mode: lines(|cell| match cell.judged {
                Judged::Meshes(_, _, _, k, axes) => Some([cell.mode(), format!("{k} {axes}")]),
                _ => None,
            }),
            box_pairs: boxes.required,
            box_wrong: boxes.differ,
            boxes: lines(|cell| match cell.judged {
                Judged::Boxes(finder) => Some([cell.mode(), finder.to_string()]),
                _ => None,
            }),
            history_lists: histories.lists,
            history_pairs: histories.required,
            history_missed: histories.missed,
            history_differ: histories.differ,
            histories: lines(|cell| match cell.judged {
                Judged::World(world, change) => Some([world.name(), change.name().to_owned()]),
                _ => None,
            }),
            empty: coverage.empty(cells.iter().copied()).iter().map(Cell::to_string).collect(),
        }
    }

    pub fn is_full(&self) -> bool {
        self.empty.is_empty()
    }

    /// The projections, and the empty cells.
    pub fn tables(&self) -> String {
        let [finders, modes] = [&self.by_strategy, &self.by_mode].map(|rows| projection(rows));
        let mut text = format!(
            "What was judged: {} of {} cells, each by {} lists or more ({})\n{finders}\n{modes}",
            self.filled, self.cells, self.fewest, self.impossible
        );
        text += &format!(
            "\nGiven boxes, {} pairs that meet, {} wrong in a list:\n{}",
            self.box_pairs,
            self.box_wrong,
            projection(&self.boxes)
        );
        text += &format!(
            "\nLong-lived worlds after changes, {} lists, {} pairs required, {} missed, {} differ:\n{}",
            self.history_lists,
            self.history_pairs,
            self.history_missed,
            self.history_differ,
            projection(&self.histories)
        );
        for cell in &self.empty {
            text += &format!("\nempty: {cell}");
        }
        text
    }
}

/// One table: filled cells of all, and the fewest lists in one. Some rows lack some columns.
fn projection(rows: &[CoverageLine]) -> Listing {
    let mut columns: Vec<&str> = Vec::new();
    for part in rows.iter().flat_map(|row| &row.parts) {
        if !columns.contains(&&*part.name) {
            columns.push(&part.name);
        }
    }
    let header: Vec<&str> = ["cells with lists"].into_iter().chain(columns.clone()).collect();
    let mut printed = table(&header);
    for row in rows {
        let parts = columns.iter().map(|name| {
            let part = row.parts.iter().find(|part| part.name == *name);
            part.map_or_else(String::new, |Part { filled, .. }| {
                format!("{}/{} ≥{}", filled.filled, filled.cells, filled.fewest)
            })
        });
        printed.add_row([row.name.clone()].into_iter().chain(parts));
    }
    printed
}

/// Rows and their parts in the order of their first cells.
fn rows(folded: Vec<([String; 2], CoveragePart)>) -> Vec<CoverageLine> {
    let mut rows: Vec<CoverageLine> = Vec::new();
    for ([name, part], filled) in folded {
        let part = Part { name: part, filled };
        match rows.iter_mut().find(|row| row.name == name) {
            Some(row) => row.parts.push(part),
            None => rows.push(CoverageLine { name, parts: vec![part] }),
        }
    }
    rows
}
