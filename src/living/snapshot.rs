//! The common parts of the snapshots of both worlds: version, ids, pairs, and errors.

use std::collections::BTreeSet;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::ids::{BodyId, Ids, NEW_ROW, renumber_column};
use super::live_pairs::LivePairs;
use super::pair_log::PairLog;
use super::reported_pairs::ReportedPairs;
use super::{Groups, Members};
use crate::bodies::ExcludedPairs;
use crate::bodies::contract::{ContractError, check_number};

/// The version of snapshots that this library writes and reads.
const VERSION: u32 = 2;

/// The error of a snapshot that can't be restored. The world stays unchanged.
#[derive(Clone, PartialEq, Error)]
pub enum SnapshotError {
    /// The snapshot is inconsistent.
    #[error("the snapshot is damaged: {problem}; {help}", help = self.help())]
    Damaged {
        /// The problem.
        problem: String,
    },
    /// A body is outside of the contract.
    #[error("the snapshot is damaged: {}; {help}", .0.problem(), help = self.help())]
    Contract(#[from] ContractError),
    /// The world lacks a shape of the snapshot.
    #[error("shape {shape} of the snapshot is `{name}`, but {found}; {help}", help = self.help())]
    Shape {
        /// Its number.
        shape: u32,
        /// Its name.
        name: String,
        /// The shape that the world has under this number.
        found: String,
    },
}

crate::problem::errors!(SnapshotError);

impl SnapshotError {
    /// How to mend it.
    #[must_use]
    pub fn help(&self) -> &str {
        match self {
            Self::Damaged { .. } | Self::Contract(_) => {
                "take another from `snapshot`, and store and send it unchanged"
            }
            Self::Shape { .. } => {
                "snapshots hold no meshes: give the world the same shapes under the same numbers, built with the same `ShapeSpec`"
            }
        }
    }
}

pub(crate) fn damaged<T>(problem: impl Into<String>) -> Result<T, SnapshotError> {
    let problem = problem.into();
    Err(SnapshotError::Damaged { problem })
}

/// Entries of bodies, by row: `plan` has the number of each row's body.
pub(crate) fn restored_column<T: Copy>(
    name: &str,
    entries: impl ExactSizeIterator<Item = T>,
    plan: &[u32],
    empty: T,
) -> Result<Vec<T>, SnapshotError> {
    let bodies = plan.iter().filter(|&&number| number != NEW_ROW).count();
    check_length(name, entries.len(), bodies)?;
    let mut column = entries.collect();
    renumber_column(&mut column, plan, empty);
    Ok(column)
}

/// Checks that a column has one entry for each body.
fn check_length(column: &str, entries: usize, bodies: usize) -> Result<(), SnapshotError> {
    if entries == bodies {
        return Ok(());
    }
    damaged(format!("`{column}` has {entries} entries for {bodies} bodies"))
}

/// The rows of slots that have bodies.
fn rows_of(slots: impl Iterator<Item = u32>, ids: &Ids) -> Option<Vec<usize>> {
    let row = |slot| Some(ids.row_of(slot)).filter(|&row| ids.present.get(row) == Some(&true));
    slots.map(row).collect()
}

/// Excluded pairs of bodies, as a snapshot has them: sorted pairs of slots that have bodies, the
/// lower first.
fn restored_excluded(pairs: &[[u32; 2]], ids: &Ids) -> Result<ExcludedPairs, SnapshotError> {
    let are_sound = pairs.is_sorted_by(|a, b| a < b) && pairs.iter().all(|[a, b]| a < b);
    match rows_of(pairs.as_flattened().iter().copied(), ids) {
        Some(rows) if are_sound => {
            Ok(rows.chunks_exact(2).map(|pair| [pair[0] as u32, pair[1] as u32]).collect())
        }
        _ => damaged("excluded pairs that there can't be"),
    }
}

/// What the snapshots of both worlds have of their bodies, restored.
pub(crate) struct RestoredMembers {
    pub members: Members,
    /// The number of the body in each row, or [`NEW_ROW`].
    pub plan: Vec<u32>,
    /// The rows that have changed since the last cull, if that is known.
    pub changed: Option<Vec<u32>>,
}

impl RestoredMembers {
    /// The bodies of a snapshot.
    pub fn of(
        ids: &IdsSnapshot,
        resting: &[u32],
        groups: &[[u32; 2]],
        pairs: &PairsSnapshot,
        excluded: &[[u32; 2]],
    ) -> Result<Self, SnapshotError> {
        let (ids, plan) = ids.restored()?;
        let groups = groups.iter().map(|&[member, mask]| Groups { member, mask });
        let groups = restored_column("groups", groups, &plan, Groups::ALL)?;
        let (log, changed) = pairs.restored(&ids)?;
        let resting = flag_column(resting, &ids, "at rest")?;
        let excluded = restored_excluded(excluded, &ids)?;
        let pairs = LivePairs::of(log);
        let rest = Members { replaced: true, ..Members::default() };
        let mut members = Members { ids, resting, groups, excluded, pairs, ..rest };
        members.count_groups();
        Ok(Self { members, plan, changed })
    }
}

/// The excluded pairs by slot, sorted.
pub(crate) fn excluded_slots(pairs: &ExcludedPairs, ids: &Ids) -> Vec<[u32; 2]> {
    let slots = |pair: [u32; 2]| pair.map(|row| ids.id(row).slot);
    pairs.sorted().into_iter().map(slots).collect()
}

/// The slots of bodies with a flag, such as those at rest, sorted.
pub(crate) fn flagged_slots(flags: &[bool], ids: &Ids) -> Vec<u32> {
    let flagged = ids.filled().filter(|&row| flags[row]);
    flagged.map(|row| ids.id(row as u32).slot).collect()
}

/// Whether the body in each row has a flag, which `name` describes.
pub(crate) fn flag_column(
    flagged: &[u32],
    ids: &Ids,
    name: &str,
) -> Result<Vec<bool>, SnapshotError> {
    let mut flags = vec![false; ids.rows()];
    let rows = rows_of(flagged.iter().copied(), ids);
    let Some(rows) = rows.filter(|_| flagged.is_sorted_by(|a, b| a < b)) else {
        return damaged(format!("bodies that are {name} that there can't be"));
    };
    rows.into_iter().for_each(|row| flags[row] = true);
    Ok(flags)
}

/// The version of a snapshot, which comes first in it. Other versions are rejected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "u32", into = "u32")]
pub(crate) struct Version;

impl TryFrom<u32> for Version {
    type Error = String;
    fn try_from(version: u32) -> Result<Self, String> {
        if version == VERSION {
            return Ok(Self);
        }
        Err(format!(
            "a snapshot of version {version}, and this library reads version {VERSION}: restore it with the library that took it"
        ))
    }
}

impl From<Version> for u32 {
    fn from(_: Version) -> Self {
        VERSION
    }
}

/// The ids of a world: of its bodies, sorted by slot, and of its empty rows, each by slot and
/// generation.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct IdsSnapshot {
    slots: Vec<u32>,
    generation: Vec<u32>,
    free: Vec<[u32; 2]>,
    emptied: Vec<[u32; 2]>,
    first_generation: u32,
}

impl IdsSnapshot {
    pub fn of(ids: &Ids) -> Self {
        let empty = |rows: &[u32]| rows.iter().map(|&row| numbers_of(ids.id(row))).collect();
        Self {
            slots: ids.iter().map(|id| id.slot).collect(),
            generation: ids.iter().map(|id| id.generation).collect(),
            free: empty(&ids.free),
            emptied: empty(&ids.emptied),
            first_generation: ids.first_generation,
        }
    }

    /// The ids, and the plan of rows: the number of the body in each, or [`NEW_ROW`].
    pub fn restored(&self) -> Result<(Ids, Vec<u32>), SnapshotError> {
        check_length("generation", self.generation.len(), self.slots.len())?;
        if !self.slots.is_sorted() {
            return damaged("slots aren't sorted");
        }
        let bodies = self.slots.iter().zip(&self.generation);
        let bodies = bodies.zip(0..).map(|((&slot, &generation), body)| ([slot, generation], body));
        let empty = self.free.iter().chain(&self.emptied).map(|&id| (id, NEW_ROW));
        let mut rows: Vec<([u32; 2], u32)> = bodies.chain(empty).collect();
        rows.sort_unstable();
        let slot = |row: &([u32; 2], u32)| row.0[0];
        check_number(rows.last().map_or(0, |row| slot(row) as usize + 1))?;
        if let Some(row) = rows.windows(2).find(|rows| slot(&rows[0]) == slot(&rows[1])) {
            return damaged(format!("slot {} is in two states at once", slot(&row[0])));
        }
        if let Some([slot, _]) = self.free.iter().find(|id| id[1] == u32::MAX) {
            return damaged(format!("slot {slot} is free and has no generation left"));
        }
        let table = rows.iter().map(|&([slot, generation], _)| BodyId { slot, generation });
        let mut ids = Ids::of_rows(table.collect(), self.first_generation);
        if ids.rows() < ids.slots() && self.first_generation == 0 {
            return damaged("vacant slots whose generations have not begun");
        }
        let row = |id: &[u32; 2]| ids.row_of(id[0]) as u32;
        let [free, emptied] = [&self.free, &self.emptied].map(|all| all.iter().map(row).collect());
        (ids.free, ids.emptied, ids.bodies) = (free, emptied, self.slots.len());
        let plan: Vec<u32> = rows.iter().map(|&(_, body)| body).collect();
        ids.present = plan.iter().map(|&body| body != NEW_ROW).collect();
        Ok((ids, plan))
    }
}

fn numbers_of(id: BodyId) -> [u32; 2] {
    [id.slot, id.generation]
}

/// The pairs of the last cull, and those of the last events.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct PairsSnapshot {
    /// By slot.
    last: [Vec<u32>; 2],
    /// Slot and generation of the bodies in them that were removed since, sorted.
    gone: Vec<[u32; 2]>,
    /// Slots of the bodies that have changed since that cull, if the pairs of all others are known
    /// to be the last ones.
    changed: Option<Vec<u32>>,
    /// Slot and generation of both bodies of each pair. `None` if they are the last ones.
    watched: Option<Vec<[u32; 4]>>,
}

impl PairsSnapshot {
    pub fn of(pairs: &LivePairs, changed: Option<&[u32]>, ids: &Ids) -> Self {
        let log = pairs.to_log(ids);
        let pairs = log.last.pairs();
        let is_gone = |id: &BodyId| ids.slot(*id).is_err();
        let gone: BTreeSet<BodyId> = pairs.iter().flatten().filter(is_gone).collect();
        let named = |[a, b]: [BodyId; 2]| [a.slot, a.generation, b.slot, b.generation];
        let watched = (!Arc::ptr_eq(&log.last, &log.watched))
            .then(|| log.watched.pairs().iter().map(named).collect());
        Self {
            last: [0, 1].map(|side: usize| pairs.iter().map(|pair| pair[side].slot).collect()),
            gone: gone.into_iter().map(numbers_of).collect(),
            changed: changed.map(|rows| rows.iter().map(|&row| ids.id(row).slot).collect()),
            watched,
        }
    }

    /// The pairs, and the rows that have changed since, if that is known.
    pub fn restored(&self, ids: &Ids) -> Result<(PairLog, Option<Vec<u32>>), SnapshotError> {
        let last = self.last(ids)?;
        let row = |&slot: &u32| Some(ids.row_of(slot)).filter(|&row| row < ids.rows());
        let changed = match &self.changed {
            None => None,
            Some(slots) => {
                let rows: Option<Vec<usize>> = slots.iter().map(row).collect();
                let rows = rows.filter(|_| Arc::ptr_eq(&last.table, ids.table()));
                let Some(rows) = rows.filter(|rows| are_distinct(rows)) else {
                    return damaged("changed bodies that there can't be");
                };
                Some(rows.into_iter().map(|row| row as u32).collect())
            }
        };
        let last = Arc::new(last);
        let watched = match &self.watched {
            None => last.clone(),
            Some(pairs) => {
                let id = |slot, generation| BodyId { slot, generation };
                let pairs = pairs.iter().map(|&[i, of_i, j, of_j]| [id(i, of_i), id(j, of_j)]);
                if !pairs.clone().all(|[a, b]| a.slot < b.slot)
                    || !pairs.clone().is_sorted_by(|a, b| a < b)
                {
                    return damaged("watched pairs aren't sorted");
                }
                Arc::new(ReportedPairs::compact(pairs))
            }
        };
        Ok((PairLog::of(last, watched), changed))
    }

    /// The pairs of the last cull: by row, unless a row has another body now.
    fn last(&self, ids: &Ids) -> Result<ReportedPairs, SnapshotError> {
        let [first, second] = &self.last;
        if first.len() != second.len() {
            return damaged(format!("{} and {} halves of pairs", first.len(), second.len()));
        }
        let pairs = || first.iter().zip(second).map(|(&i, &j)| [i, j]);
        if let Some([i, j]) = pairs().find(|&[i, j]| i >= j) {
            return damaged(format!("the pair {i}, {j}"));
        }
        if !pairs().is_sorted_by(|a, b| a < b) || !self.gone.is_sorted_by(|a, b| a[0] < b[0]) {
            return damaged("pairs aren't sorted");
        }
        let mut unnamed: BTreeSet<u32> = self.gone.iter().map(|id| id[0]).collect();
        let mut are_by_row = true;
        let mut body = |slot: u32| {
            let row = ids.row_of(slot);
            let gone = self.gone.binary_search_by_key(&slot, |id| id[0]).map(|at| self.gone[at]);
            let Ok([slot, generation]) = gone else {
                return ids.table.get(row).copied().filter(|_| ids.present[row]);
            };
            unnamed.remove(&slot);
            let id = BodyId { slot, generation };
            are_by_row &= ids.table.get(row) == Some(&id);
            ids.slot(id).is_err().then_some(id)
        };
        let mut bodies = Vec::with_capacity(first.len());
        for pair in pairs() {
            let [Some(a), Some(b)] = pair.map(&mut body) else {
                return damaged(format!(
                    "the pair {}, {} has a slot that was empty",
                    pair[0], pair[1]
                ));
            };
            bodies.push([a, b]);
        }
        if let Some(slot) = unnamed.first() {
            return damaged(format!("no pair contains the removed body of slot {slot}"));
        }
        if !are_by_row {
            return Ok(ReportedPairs::compact(bodies.into_iter()));
        }
        let rows = pairs().map(|pair| pair.map(|slot| ids.row_of(slot) as u32));
        Ok(ReportedPairs::sorted(rows.collect(), ids.table().clone()))
    }
}

/// Whether no number comes twice.
fn are_distinct(numbers: &[usize]) -> bool {
    numbers.iter().collect::<BTreeSet<_>>().len() == numbers.len()
}
