//! The matrix of what was judged, in two projections: thousands of cells are too many to read, and
//! a tier, a mode or a finder that was left out shows in one of them.

use sdop::settings::Strategy;
use sdop_judge::ours::boxes::{BoxCell, BoxLedger};
use sdop_judge::ours::configurations::Rotation;
use sdop_judge::ours::histories::{ChangeKind, HistoryCell, HistoryLedger, WorldKind};
use sdop_judge::ours::matrix::{Cell, Matrix, MatrixPart};
use serde::Serialize;

use crate::commands::output::{Listing, table};

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
    filled: MatrixPart,
}

impl Coverage {
    pub fn of(
        matrix: &Matrix,
        (boxes, histories): (&BoxLedger, &HistoryLedger),
        rotation: &Rotation,
    ) -> Self {
        let all = matrix.fold(rotation, |_| ());
        let all = all.first().map_or_else(MatrixPart::default, |(_, all)| *all);
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
            by_strategy: rows(
                matrix.fold(rotation, |cell| (strategy(cell), cell.finder.to_string())),
            ),
            by_mode: rows(matrix.fold(rotation, |cell| (mode(cell), variant(cell)))),
            box_pairs: boxes.required,
            box_wrong: boxes.wrong(),
            boxes: rows(BoxCell::all(rotation).map(|(cell, _)| box_part(&cell, boxes))),
            history_lists: histories.lists,
            history_pairs: histories.required,
            history_missed: histories.missed,
            history_differ: histories.differ,
            histories: rows(history_parts(histories, rotation)),
            empty: {
                let unjudged = BoxCell::all(rotation).map(|(cell, _)| cell);
                let unjudged = unjudged.filter(|cell| boxes.lists(cell) == 0);
                let unlived = HistoryCell::all(rotation).into_iter();
                let unlived = unlived.filter(|cell| histories.lists_in(cell) == 0);
                let names = matrix.empty(rotation).iter().map(name).collect::<Vec<_>>();
                names
                    .into_iter()
                    .chain(unjudged.map(|cell| box_name(&cell)))
                    .chain(unlived.map(|cell| history_name(&cell)))
                    .collect()
            },
        }
    }

    pub fn is_full(&self) -> bool {
        self.empty.is_empty()
    }

    /// Both projections, and the empty cells.
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

/// One table: filled cells of all, and the fewest lists in one.
fn projection(rows: &[CoverageLine]) -> Listing {
    let columns = rows.iter().take(1).flat_map(|row| &row.parts);
    let columns = columns.map(|part| part.name.as_str());
    let header: Vec<&str> = ["cells with lists"].into_iter().chain(columns).collect();
    let mut printed = table(&header);
    for row in rows {
        let parts = row.parts.iter().map(|Part { filled, .. }| {
            format!("{}/{} ≥{}", filled.filled, filled.cells, filled.fewest)
        });
        printed.add_row([row.name.clone()].into_iter().chain(parts));
    }
    printed
}

/// Rows and their parts in the order of their first cells.
fn rows(folded: impl IntoIterator<Item = ((String, String), MatrixPart)>) -> Vec<CoverageLine> {
    let mut rows: Vec<CoverageLine> = Vec::new();
    for ((name, part), filled) in folded {
        let part = Part { name: part, filled };
        match rows.iter_mut().find(|row| row.name == name) {
            Some(row) => row.parts.push(part),
            None => rows.push(CoverageLine { name, parts: vec![part] }),
        }
    }
    rows
}

fn strategy(cell: &Cell) -> String {
    let overlap = cell.overlap.map(|overlap| format!(" {overlap}"));
    format!("{}{}", cell.strategy, overlap.unwrap_or_default())
}

fn variant(cell: &Cell) -> String {
    format!("{} {}", cell.k, cell.axes)
}

fn mode(cell: &Cell) -> String {
    format!("{} {} {}", cell.tier, cell.updates, threads(cell.threads))
}

fn threads(number: usize) -> String {
    let plural = if number == 1 { "" } else { "s" };
    format!("{number} thread{plural}")
}

/// The line and column of a cell of given boxes, and what it holds.
fn box_part(cell: &BoxCell, boxes: &BoxLedger) -> ((String, String), MatrixPart) {
    let line = format!("{} {}", cell.tier, threads(cell.threads));
    let lists = boxes.lists(cell);
    let filled = MatrixPart { cells: 1, filled: u64::from(lists > 0), fewest: lists };
    ((line, cell.finder.to_string()), filled)
}

/// The cells of long-lived worlds, by world and kind of change. Given boxes lack some kinds, for
/// which they have no cells.
fn history_parts(
    histories: &HistoryLedger,
    rotation: &Rotation,
) -> Vec<((String, String), MatrixPart)> {
    let mut parts = Vec::new();
    let all = HistoryCell::all(rotation);
    let mut worlds: Vec<WorldKind> = all.iter().map(|cell| cell.world).collect();
    worlds.dedup();
    for world in worlds {
        for &change in ChangeKind::ALL {
            let of = |cell: &&HistoryCell| (cell.world, cell.change) == (world, change);
            let lists = all.iter().filter(of).map(|cell| histories.lists_in(cell));
            let lists: Vec<u64> = lists.collect();
            let part = MatrixPart {
                cells: lists.len() as u64,
                filled: lists.iter().filter(|lists| **lists > 0).count() as u64,
                fewest: lists.iter().copied().min().unwrap_or(0),
            };
            parts.push(((world.name(), change.name().to_owned()), part));
        }
    }
    parts
}

fn history_name(cell: &HistoryCell) -> String {
    let (world, change) = (cell.world.name(), cell.change.name());
    let threads = threads(cell.threads);
    format!("a world of {world}, {change}, {} {threads}", cell.tier)
}

fn box_name(cell: &BoxCell) -> String {
    let threads = threads(cell.threads);
    format!("given boxes, {}, {} {threads}", cell.finder, cell.tier)
}

fn name(cell: &Cell) -> String {
    let (strategy, finder) = (strategy(cell), cell.finder);
    format!("{strategy}, {finder}, k = {}, {}", variant(cell), mode(cell))
}
