//! What was judged: the number of lists in each cell, and what lists had wrong.

use std::collections::BTreeMap;
use std::fmt;

use super::world_kind::{ChangeKind, WorldKind, every_world, strategy_name};
use super::{Mode, Rotation, variants, ways};
use sdop::settings::{CullSettings, Finder, Overlap, Strategy, Updates};
use sdop::volume::{Axes, DirectionSet};

/// What reported a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Judged {
    /// A culler of meshes: a strategy with its overlap test, if it has one, a finder and an or-DOP.
    Meshes(Strategy, Option<Overlap>, Finder, DirectionSet, Axes),
    /// A culler of given boxes.
    Boxes(Finder),
    /// A long-lived world, after a change.
    World(WorldKind, ChangeKind),
}

/// One cell: a list, and how it was computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Cell {
    /// What reported it.
    pub judged: Judged,
    /// The update mode; given boxes and worlds share a cell for all of them.
    pub updates: Updates,
    /// The tier's name.
    pub tier: &'static str,
    /// The number of threads.
    pub threads: usize,
}

impl Cell {
    /// The cell of a list that is reported in a mode.
    #[must_use]
    pub fn of(judged: Judged, mode: Mode) -> Self {
        let updates = match judged {
            Judged::Meshes(..) => mode.updates,
            Judged::Boxes(_) | Judged::World(..) => Updates::Eager,
        };
        Self { judged, updates, tier: mode.tier.name(), threads: mode.threads }
    }

    /// The cell of a way to cull meshes.
    #[must_use]
    pub fn of_meshes(way: &CullSettings, mode: Mode) -> Self {
        let overlap = way.strategy.scheme().has_overlap_test().then_some(way.overlap);
        Self::of(Judged::Meshes(way.strategy, overlap, way.pairs, way.k, way.axes), mode)
    }

    /// Every cell of cullers of meshes that can be filled with these modes.
    pub fn of_all_meshes(rotation: &Rotation) -> impl Iterator<Item = Self> {
        let ways = variants().flat_map(|(k, axes)| ways(k, axes));
        ways.flat_map(|way| {
            let modes = rotation.modes().iter();
            modes.map(move |&mode| Self::of_meshes(&way, mode))
        })
    }

    /// Every cell that can be filled with these modes.
    #[must_use]
    pub fn all(rotation: &Rotation) -> Vec<Self> {
        let modes = || rotation.modes().iter().filter(|mode| mode.updates == Updates::Eager);
        let finders = Finder::ALL.iter().map(|&finder| Judged::Boxes(finder));
        let worlds = every_world().into_iter().flat_map(|world| {
            let changes = ChangeKind::ALL.iter().filter(move |change| world.has(**change));
            changes.map(move |&change| Judged::World(world, change))
        });
        let others = finders.chain(worlds);
        let others = others.flat_map(|judged| modes().map(move |&mode| Self::of(judged, mode)));
        Self::of_all_meshes(rotation).chain(others).collect()
    }

    /// The update mode, the tier and the threads, as tables call them.
    #[must_use]
    pub fn mode(&self) -> String {
        let threads = match self.threads {
            1 => "1 thread".to_owned(),
            threads => format!("{threads} threads"),
        };
        match self.judged {
            Judged::Meshes(..) => format!("{} {} {threads}", self.tier, self.updates),
            Judged::Boxes(_) | Judged::World(..) => format!("{} {threads}", self.tier),
        }
    }
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.judged {
            Judged::Meshes(strategy, overlap, finder, k, axes) => {
                let strategy = strategy_name(strategy, overlap);
                write!(f, "{strategy}, {finder}, k = {k} {axes}, {}", self.mode())
            }
            Judged::Boxes(finder) => write!(f, "given boxes, {finder}, {}", self.mode()),
            Judged::World(world, change) => {
                write!(f, "a world of {}, {}, {}", world.name(), change.name(), self.mode())
            }
        }
    }
}

/// How many lists were judged in each cell.
#[derive(Clone, Debug, Default)]
pub struct Coverage(BTreeMap<Cell, u64>);

impl Coverage {
    /// Counts judged lists.
    pub fn count(&mut self, cell: Cell, lists: u64) {
        *self.0.entry(cell).or_default() += lists;
    }

    /// The cells in which lists were judged, and how many.
    pub fn filled(&self) -> impl Iterator<Item = (&Cell, u64)> {
        self.0.iter().map(|(cell, &lists)| (cell, lists))
    }

    /// Adds another one.
    pub fn add(&mut self, other: &Self) {
        for (&cell, lists) in &other.0 {
            self.count(cell, *lists);
        }
    }

    /// Those of some cells in which no list was judged.
    #[must_use]
    pub fn empty(&self, cells: impl IntoIterator<Item = Cell>) -> Vec<Cell> {
        cells.into_iter().filter(|cell| !self.0.contains_key(cell)).collect()
    }

    /// The cells that fall together under a name: how many, how many of them are filled, and the
    /// fewest lists in one, in the order of the cells.
    #[must_use]
    pub fn fold<K: PartialEq>(
        &self,
        cells: &[Cell],
        name: impl Fn(&Cell) -> Option<K>,
    ) -> Vec<(K, CoveragePart)> {
        let mut folded: Vec<(K, CoveragePart)> = Vec::new();
        for (name, cell) in cells.iter().filter_map(|cell| Some((name(cell)?, cell))) {
            let lists = self.0.get(cell).copied().unwrap_or(0);
            let known = folded.iter_mut().find(|(known, _)| *known == name);
            if let Some((_, filled)) = known {
                filled.cells += 1;
                filled.filled += u64::from(lists > 0);
                filled.fewest = filled.fewest.min(lists);
            } else {
                let filled = CoveragePart { cells: 1, filled: u64::from(lists > 0), fewest: lists };
                folded.push((name, filled));
            }
        }
        folded
    }
}

/// A part of all cells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct CoveragePart {
    /// Cells that can be filled.
    pub cells: u64,
    /// Cells that are.
    pub filled: u64,
    /// The fewest lists judged in one of them.
    pub fewest: u64,
}

/// Lists that were held against what they must be: sums over frames.
#[derive(Clone, Debug, Default)]
pub struct ListLedger {
    /// Lists by cell. A list after two kinds of changes is in two cells.
    pub coverage: Coverage,
    /// Lists, each counted once.
    pub lists: u64,
    /// Pairs that had to be reported.
    pub required: u64,
    /// Those that weren't.
    pub missed: u64,
    /// Pairs and events that are not what they must be.
    pub differ: u64,
    /// The first wrong pair, with all that is needed to see it again.
    pub failure: Option<String>,
}

impl ListLedger {
    /// Adds another one.
    pub fn add(&mut self, other: Self) {
        self.coverage.add(&other.coverage);
        self.lists += other.lists;
        self.required += other.required;
        self.missed += other.missed;
        self.differ += other.differ;
        self.failure = self.failure.take().or(other.failure);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sdop::simd::Tier;

    #[test]
    fn an_empty_cell_is_named() {
        let rotation = Rotation::new(&[Tier::SCALAR]);
        let (mut coverage, cells) = (Coverage::default(), Cell::all(&rotation));
        let left_out = cells.iter().position(|cell| {
            matches!(cell.judged, Judged::Meshes(Strategy::Obb, _, Finder::Sweep, ..))
        });
        for (n, cell) in cells.iter().enumerate() {
            if Some(n) != left_out {
                coverage.count(*cell, 1);
            }
        }
        let empty = coverage.empty(cells.iter().copied());
        assert_eq!(empty, left_out.map(|n| cells[n]).into_iter().collect::<Vec<_>>());
        let finder = |cell: &Cell| match cell.judged {
            Judged::Meshes(_, _, finder, ..) => Some(finder),
            _ => None,
        };
        let by_finder = coverage.fold(&cells, finder);
        let finders: Vec<Finder> = by_finder.iter().map(|row| row.0).collect();
        assert_eq!(finders, Finder::ALL);
        for (finder, filled) in by_finder {
            let lacks = u64::from(finder == Finder::Sweep);
            assert_eq!(filled.filled, filled.cells - lacks);
            assert_eq!(filled.fewest, 1 - lacks);
        }
    }
}
