//! What was judged: the matrix strategy × overlap test × finder × k × axes × updates × tier ×
//! threads, with the number of lists in each cell.

use std::collections::BTreeMap;

use super::configurations::{Mode, Rotation, variants, ways};
use sdop::settings::{CullSettings, Finder, Overlap, Strategy, Updates};
use sdop::volume::{Axes, DirectionSet};

/// One cell. A strategy without an overlap test has one cell instead of one per test, because the
/// others can't exist.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Cell {
    /// The strategy.
    pub strategy: Strategy,
    /// Its overlap test.
    pub overlap: Option<Overlap>,
    /// The finder.
    pub finder: Finder,
    /// The or-DOP's slabs.
    pub k: DirectionSet,
    /// The or-DOP's axes.
    pub axes: Axes,
    /// The update mode.
    pub updates: Updates,
    /// The tier's name.
    pub tier: &'static str,
    /// The number of threads.
    pub threads: usize,
}

impl Cell {
    /// The cell of a way to cull in a mode.
    #[must_use]
    pub fn of(way: &CullSettings, mode: Mode) -> Self {
        Self {
            strategy: way.strategy,
            overlap: way.strategy.scheme().has_overlap_test().then_some(way.overlap),
            finder: way.pairs,
            k: way.k,
            axes: way.axes,
            updates: mode.updates,
            tier: mode.tier.name(),
            threads: mode.threads,
        }
    }

    /// Every cell that can be filled with these modes.
    pub fn all(rotation: &Rotation) -> impl Iterator<Item = Self> {
        let ways = variants().flat_map(|(k, axes)| ways(k, axes));
        ways.flat_map(|way| {
            let modes = rotation.modes().iter();
            modes.map(move |&mode| Self::of(&way, mode))
        })
    }
}

/// How many lists were judged in each cell.
#[derive(Clone, Debug, Default)]
pub struct Matrix(BTreeMap<Cell, u64>);

impl Matrix {
    /// Counts judged lists of a way in a mode.
    pub fn count(&mut self, way: &CullSettings, mode: Mode, lists: u64) {
        *self.0.entry(Cell::of(way, mode)).or_default() += lists;
    }

    /// Sets how many lists were judged in a cell.
    pub fn fill(&mut self, cell: Cell, lists: u64) {
        self.0.insert(cell, lists);
    }

    /// The cells in which lists were judged, and how many.
    pub fn filled(&self) -> impl Iterator<Item = (&Cell, u64)> {
        self.0.iter().map(|(cell, &lists)| (cell, lists))
    }

    /// Adds another matrix.
    pub fn add(&mut self, other: &Self) {
        for (&cell, lists) in &other.0 {
            *self.0.entry(cell).or_default() += lists;
        }
    }

    /// Lists judged in a cell.
    #[must_use]
    pub fn lists(&self, cell: &Cell) -> u64 {
        self.0.get(cell).copied().unwrap_or(0)
    }

    /// The cells in which no list was judged.
    #[must_use]
    pub fn empty(&self, rotation: &Rotation) -> Vec<Cell> {
        let is_empty = |cell: &Cell| self.lists(cell) == 0;
        Cell::all(rotation).filter(is_empty).collect()
    }

    /// The cells that fall together under a name: how many, how many of them are filled, and the
    /// fewest lists in one. In the order of [`Cell::all`].
    #[must_use]
    pub fn fold<K: PartialEq>(
        &self,
        rotation: &Rotation,
        name: impl Fn(&Cell) -> K,
    ) -> Vec<(K, MatrixPart)> {
        let mut folded: Vec<(K, MatrixPart)> = Vec::new();
        for cell in Cell::all(rotation) {
            let (name, lists) = (name(&cell), self.lists(&cell));
            let known = folded.iter_mut().find(|(known, _)| *known == name);
            if let Some((_, filled)) = known {
                filled.cells += 1;
                filled.filled += u64::from(lists > 0);
                filled.fewest = filled.fewest.min(lists);
            } else {
                let filled = MatrixPart { cells: 1, filled: u64::from(lists > 0), fewest: lists };
                folded.push((name, filled));
            }
        }
        folded
    }
}

/// A part of the matrix.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct MatrixPart {
    /// Cells that can be filled.
    pub cells: u64,
    /// Cells that are.
    pub filled: u64,
    /// The fewest lists judged in one of them.
    pub fewest: u64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use sdop::simd::Tier;

    #[test]
    fn an_empty_cell_is_named() {
        let rotation = Rotation::new(&[Tier::SCALAR]);
        let (mut matrix, missing) = (Matrix::default(), rotation.modes()[1]);
        let left_out = |way: &CullSettings, mode| {
            (way.strategy, way.pairs, way.k) == (Strategy::Obb, Finder::Sweep, DirectionSet::K14)
                && (way.axes, mode) == (Axes::Model, missing)
        };
        for way in variants().flat_map(|(k, axes)| ways(k, axes)) {
            for &mode in rotation.modes() {
                let lists = u64::from(!left_out(&way, mode));
                matrix.count(&way, mode, lists);
            }
        }
        let empty = matrix.empty(&rotation);
        assert_eq!(empty.len(), 1);
        let cell = empty[0];
        assert_eq!((cell.strategy, cell.finder), (Strategy::Obb, Finder::Sweep));
        let by_finder = matrix.fold(&rotation, |cell| cell.finder);
        let finders: Vec<Finder> = by_finder.iter().map(|row| row.0).collect();
        assert_eq!(finders, Finder::ALL);
        for (finder, filled) in by_finder {
            let lacks = u64::from(finder == Finder::Sweep);
            assert_eq!(filled.filled, filled.cells - lacks);
            assert_eq!(filled.fewest, 1 - lacks);
        }
    }
}
