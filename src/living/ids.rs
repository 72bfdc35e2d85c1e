//! Stable ids: a slot, and a generation that counts how often it was used.

use std::borrow::Cow;
use std::collections::HashMap;
use std::fmt;
use std::hash::BuildHasherDefault;
use std::sync::Arc;

use super::WorldError;
use crate::bodies::{Groups, NumberHasher};

/// The id of a body of a world. It stays the same until the body is removed, and is never reused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BodyId {
    pub(super) slot: u32,
    pub(super) generation: u32,
}

impl BodyId {
    /// The body's index into columns with one entry per body: less than
    /// [`LivingSet::slots`](super::LivingSet::slots), and reused for another body once this one is
    /// removed.
    #[must_use]
    pub fn slot(self) -> usize {
        self.slot as usize
    }

    /// The id as a number, for other languages and for files: the generation in the upper half, the
    /// slot in the lower.
    #[must_use]
    pub fn to_bits(self) -> u64 {
        u64::from(self.generation) << 32 | u64::from(self.slot)
    }

    /// The id of [`Self::to_bits`]. Any other number is an id that no body has.
    #[must_use]
    pub fn from_bits(bits: u64) -> Self {
        Self { slot: bits as u32, generation: (bits >> 32) as u32 }
    }
}

impl BodyId {
    /// The bodies in two rows, at the time of these ids.
    #[inline(always)]
    pub(super) fn pair_of(rows: [u32; 2], ids: &[Self]) -> [Self; 2] {
        rows.map(|row| ids[row as usize])
    }
}

/// The number of [`BodyId::to_bits`], as other languages have it, then the slot if it was used
/// before.
impl fmt::Display for BodyId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.to_bits().fmt(f)?;
        match self.generation {
            0 => Ok(()),
            generation => write!(f, " (slot {}, generation {generation})", self.slot),
        }
    }
}

/// The row of each slot, or of each former row.
type RowsBySlot = HashMap<u32, u32, BuildHasherDefault<NumberHasher>>;

/// Rows that may be empty, whatever the number of bodies …
const ALWAYS_EMPTY: usize = 32;

/// … and the share of the bodies that may be empty in addition.
const EMPTY_SHARE: [usize; 2] = [3, 8];

/// Rows that are added at once if slots between others are given again: a share of the bodies, and
/// no fewer than this.
const BODIES_PER_NEW_ROW: usize = 8;
const LEAST_NEW_ROWS: usize = 16;

/// In a plan of rows, a row that is new.
pub(crate) const NEW_ROW: u32 = u32::MAX;

/// The rows of a world's columns, and their bodies.
///
/// Rows are in the order of slots. At first, row and slot are the same number: a removed body's row
/// stays empty until its slot is given again. When too many rows are empty, they are removed
/// ([`Self::compact`]), and the slots left are *vacant*: they have no row, and the generation of
/// their next body is above those of all that were removed. The rooms above call a row a slot.
#[derive(Clone, Debug, Default)]
pub(crate) struct Ids {
    pub(super) present: Vec<bool>,
    /// The present or last body of each row; shared with the lists of pairs.
    pub(super) table: Arc<Vec<BodyId>>,
    /// The rows by slot, or `None` if each row has the number of its slot.
    rows: Option<RowsBySlot>,
    /// Empty rows to be filled, the last one first.
    pub(super) free: Vec<u32>,
    /// Rows emptied since the last cull, whose pairs still contain them, and rows whose slots have
    /// used all their generations.
    pub(super) emptied: Vec<u32>,
    /// The generation of a slot without a row.
    pub(super) first_generation: u32,
    pub(super) bodies: usize,
    /// Bodies that came or went before the last cull, and since then.
    exchanged: [usize; 2],
}

impl Ids {
    /// The ids of rows in the order of slots, each with the generation of its present or last body.
    pub fn of_rows(table: Vec<BodyId>, first_generation: u32) -> Self {
        let is_same = (0..).zip(&table).all(|(row, id)| row == id.slot);
        let by_slot = || (0..).zip(&table).map(|(row, id)| (id.slot, row)).collect();
        Self {
            present: vec![false; table.len()],
            rows: (!is_same).then(by_slot),
            table: Arc::new(table),
            first_generation,
            ..Self::default()
        }
    }

    /// The row that the next body gets, if no slot is vacant.
    pub fn next(&self) -> usize {
        self.free.last().map_or(self.rows(), |&row| row as usize)
    }

    /// The slot that the next body gets.
    pub fn next_slot(&self) -> usize {
        self.free.last().map_or(self.slots(), |&row| self.id(row).slot())
    }

    /// Gives [`Self::next`] to a body. Returns whether the row is new, so that columns have no
    /// entry for it yet.
    pub fn take(&mut self) -> bool {
        self.bodies += 1;
        self.exchanged[1] += 1;
        let (row, slot) = (self.rows(), self.slots() as u32);
        let table = Arc::make_mut(&mut self.table);
        if let Some(row) = self.free.pop() {
            let row = row as usize;
            table[row].generation += 1;
            self.present[row] = true;
            return false;
        }
        self.present.push(true);
        table.push(BodyId { slot, generation: self.first_generation });
        if let Some(rows) = &mut self.rows {
            rows.insert(slot, row as u32);
        }
        true
    }

    /// Removes a body and returns its row, which isn't reused before [`Self::settle`].
    pub fn remove(&mut self, id: BodyId) -> Result<usize, WorldError> {
        let row = self.slot(id)?;
        self.present[row] = false;
        self.emptied.push(row as u32);
        self.bodies -= 1;
        self.exchanged[1] += 1;
        Ok(row)
    }

    /// Frees the rows of removed bodies after a cull, whose pairs don't contain them, except those
    /// of slots that have used all their generations.
    pub fn settle(&mut self) {
        let Self { table, free, .. } = self;
        self.emptied.retain(|&row| {
            let is_lasting = table[row as usize].generation < u32::MAX;
            if is_lasting {
                free.push(row);
            }
            !is_lasting
        });
        self.exchanged = [self.exchanged[1], 0];
    }

    /// How many bodies came or went before the last cull.
    pub fn exchanged(&self) -> usize {
        self.exchanged[0]
    }

    /// Whether so many rows are empty that [`Self::compact`] pays.
    pub fn are_sparse(&self) -> bool {
        let share = self.bodies * EMPTY_SHARE[0] / EMPTY_SHARE[1];
        self.rows() - self.bodies > ALWAYS_EMPTY + share
    }

    /// Removes all empty rows. The ids of their bodies are never reused. Returns the plan of rows:
    /// the former row of each.
    pub fn compact(&mut self) -> Vec<u32> {
        let is_last = |row: u32| self.id(row).generation == u32::MAX;
        let rows = 0..self.rows() as u32;
        let (kept, gone): (Vec<u32>, Vec<u32>) =
            rows.partition(|&row| self.present[row as usize] || is_last(row));
        let after = gone.iter().map(|&row| self.id(row).generation + 1);
        let first_generation = after.fold(self.first_generation, u32::max);
        let table = kept.iter().map(|&row| self.id(row)).collect();
        self.renumber(&kept, Self::of_rows(table, first_generation));
        kept
    }

    /// Whether the next body gets a vacant slot, once that has a row.
    pub fn need_rows(&self) -> bool {
        self.free.is_empty() && self.rows() < self.slots()
    }

    /// Adds rows for some vacant slots, the lowest ones. Returns the plan of rows: the former row
    /// of each, or [`NEW_ROW`].
    pub fn add_rows(&mut self) -> Vec<u32> {
        let mut more = LEAST_NEW_ROWS.max(self.bodies / BODIES_PER_NEW_ROW);
        let (mut table, mut plan) = (Vec::new(), Vec::new());
        let mut next = 0;
        for (row, &id) in (0..).zip(self.table.iter()) {
            while next < id.slot && more > 0 {
                // Taking it counts one up.
                table.push(BodyId { slot: next, generation: self.first_generation - 1 });
                plan.push(NEW_ROW);
                (next, more) = (next + 1, more - 1);
            }
            table.push(id);
            plan.push(row);
            next = id.slot + 1;
        }
        self.renumber(&plan, Self::of_rows(table, self.first_generation));
        let rows = 0..self.rows() as u32;
        self.free = rows.rev().filter(|&row| plan[row as usize] == NEW_ROW).collect();
        plan
    }

    /// Moves the state of rows to those of a plan.
    fn renumber(&mut self, plan: &[u32], rows: Self) {
        let mut present = std::mem::take(&mut self.present);
        renumber_column(&mut present, plan, false);
        let row_of = rows_of(plan);
        let emptied = self.emptied.iter().filter_map(|row| row_of.get(row).copied()).collect();
        let (bodies, exchanged) = (self.bodies, self.exchanged);
        *self = Self { present, emptied, bodies, exchanged, ..rows };
    }

    /// The id of the present or last body in a row.
    pub fn id(&self, row: u32) -> BodyId {
        self.table[row as usize]
    }

    /// The present bodies, by slot.
    pub fn iter(&self) -> impl Iterator<Item = BodyId> + Clone + '_ {
        self.filled().map(|row| self.table[row])
    }

    /// The rows that have a body.
    pub fn filled(&self) -> impl Iterator<Item = usize> + Clone + '_ {
        let rows = self.present.iter().enumerate();
        rows.filter(|(_, is_present)| **is_present).map(|(row, _)| row)
    }

    /// The row of a present body.
    #[inline]
    pub fn slot(&self, id: BodyId) -> Result<usize, WorldError> {
        let row = self.row_of(id.slot);
        // An error that isn't needed would be made and dropped for every body that is set.
        if self.has_in(row, id) { Ok(row) } else { Err(WorldError::Gone(id)) }
    }

    /// The row of a slot. There may be none of the number.
    #[inline]
    pub fn row_of(&self, slot: u32) -> usize {
        match &self.rows {
            None => slot as usize,
            Some(rows) => rows.get(&slot).map_or(usize::MAX, |&row| row as usize),
        }
    }

    /// Whether all these bodies are present.
    pub fn have(&self, ids: &[BodyId]) -> bool {
        ids.iter().all(|&id| self.has_in(self.row_of(id.slot), id))
    }

    #[inline]
    fn has_in(&self, row: usize, id: BodyId) -> bool {
        self.present.get(row) == Some(&true) && self.table[row] == id
    }

    /// Whether each row has a body.
    pub fn present(&self) -> &[bool] {
        &self.present
    }

    /// Whether each row has a body that collides with any.
    pub fn colliding<'a>(&'a self, groups: &[Groups]) -> Cow<'a, [bool]> {
        if !groups.iter().any(|groups| groups.collide_with_none()) {
            return Cow::Borrowed(&self.present);
        }
        let rows = self.present.iter().zip(groups);
        rows.map(|(&is_present, groups)| is_present && !groups.collide_with_none()).collect()
    }

    /// The present or last body of each row.
    pub fn table(&self) -> &Arc<Vec<BodyId>> {
        &self.table
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.present.len()
    }

    /// One more than the largest slot of a row.
    pub fn slots(&self) -> usize {
        self.table.last().map_or(0, |id| id.slot() + 1)
    }

    /// Number of bodies.
    pub fn len(&self) -> usize {
        self.bodies
    }
}

/// Moves a column's entries to the rows of a plan; new rows get `empty`.
pub(crate) fn renumber_column<T: Copy>(column: &mut Vec<T>, plan: &[u32], empty: T) {
    *column = plan.iter().map(|&row| column.get(row as usize).copied().unwrap_or(empty)).collect();
}

/// The row of each former one.
fn rows_of(plan: &[u32]) -> RowsBySlot {
    (0..).zip(plan).map(|(row, &former)| (former, row)).collect()
}

/// Pairs of rows, in the rows of a plan. Those with a row that is gone are left out.
pub(crate) fn renumbered_pairs<T>(
    pairs: impl IntoIterator<Item = ([u32; 2], T)>,
    plan: &[u32],
) -> Vec<([u32; 2], T)> {
    let rows = rows_of(plan);
    let pair = |([a, b], value): ([u32; 2], T)| Some(([*rows.get(&a)?, *rows.get(&b)?], value));
    pairs.into_iter().filter_map(pair).collect()
}

#[cfg(test)]
pub(super) mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;

    /// The ids of this number of bodies.
    pub fn filled(slots: u32) -> Ids {
        let mut ids = Ids::default();
        (0..slots).for_each(|_| assert!(ids.take()));
        ids
    }

    /// Rows of empty slots are removed, and slots are given again with new generations.
    #[test]
    fn empty_rows_are_removed() {
        let mut ids = filled(6);
        for slot in [1, 4, 5] {
            ids.remove(ids.id(slot)).unwrap();
        }
        assert_eq!(ids.compact(), [0, 2, 3]);
        assert_eq!((ids.rows(), ids.slots(), ids.len()), (3, 4, 3));
        let rows = [0, 2, 3].map(|slot| ids.slot(BodyId { slot, generation: 0 }));
        assert_eq!(rows, [Ok(0), Ok(1), Ok(2)]);
        assert!(ids.need_rows());
        assert_eq!(ids.add_rows(), [0, NEW_ROW, 1, 2]);
        assert!(!ids.take() && ids.take());
        let given = [1, 4].map(|slot| ids.id(slot));
        let again = |slot| BodyId { slot, generation: 1 };
        assert_eq!(given, [1, 4].map(again), "generation 0 was another's");
        assert_eq!((ids.iter().count(), ids.row_of(4)), (5, 4));
    }

    /// However bodies come and go, rows follow their number, and no id is given twice.
    #[test]
    fn rows_follow_the_bodies() {
        let (mut ids, mut given, mut living) = (Ids::default(), Vec::new(), Vec::new());
        for step in 0..40_000_usize {
            // Thousands of steps in which most come, then most go.
            if living.is_empty() || step * 7919 % 9 < [2, 7][step / 4000 % 2] {
                if ids.need_rows() {
                    ids.add_rows();
                }
                let row = ids.next() as u32;
                ids.take();
                living.push(ids.id(row));
                given.push(ids.id(row));
            } else {
                ids.remove(living.swap_remove(step * 31 % living.len())).unwrap();
            }
            if step % 100 == 0 {
                ids.settle();
            }
            if ids.are_sparse() {
                ids.compact();
            }
            assert!(8 * ids.rows() <= 11 * ids.len() + 8 * 64, "{} of {}", ids.rows(), ids.len());
        }
        living.sort_unstable();
        assert!(ids.have(&living) && ids.iter().eq(living) && ids.slots() < 10_000);
        given.sort_unstable();
        assert!(given.is_sorted_by(|a, b| a < b));
    }

    /// A slot without generations left is retired.
    #[test]
    fn used_up_slot_is_retired() {
        let mut ids = filled(2);
        let id = |slot, generation| BodyId { slot, generation };
        ids.table = Arc::new(vec![id(0, u32::MAX - 1), id(1, 7)]);
        for _ in 0..2 {
            ids.remove(ids.id(0)).unwrap();
            ids.settle();
            ids.take();
        }
        assert!(ids.iter().eq([id(1, 7), id(2, 0)]));
        assert_eq!((ids.len(), ids.slots()), (2, 3));
        assert_eq!((ids.compact(), ids.need_rows()), (vec![0, 1, 2], false));
    }
}
