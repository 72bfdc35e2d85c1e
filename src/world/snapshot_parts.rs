//! The common parts of the snapshots of both worlds: version, ids, pairs, and errors.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::Ids;
use super::pair_log::PairLog;
use super::reported_pairs::ReportedPairs;
use crate::bodies::ExcludedPairs;
use crate::bodies::contract::{ContractError, check_number};
use crate::pairs::PairList;

/// The version of snapshots that this library writes and reads.
const VERSION: u32 = 1;

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

/// Checks that a column has one entry for each slot.
pub(crate) fn check_length(
    column: &str,
    entries: usize,
    slots: usize,
) -> Result<(), SnapshotError> {
    if entries == slots {
        return Ok(());
    }
    damaged(format!("`{column}` has {entries} entries for {slots} slots"))
}

/// Excluded pairs of bodies, as a snapshot has them: sorted pairs of slots that have bodies, the
/// lower first.
pub(crate) fn restored_excluded(
    pairs: &[[u32; 2]],
    ids: &Ids,
) -> Result<ExcludedPairs, SnapshotError> {
    let has_body = |slot: u32| ids.present.get(slot as usize) == Some(&true);
    let is_sound = |&[a, b]: &[u32; 2]| a < b && has_body(a) && has_body(b);
    if pairs.is_sorted_by(|a, b| a < b) && pairs.iter().all(is_sound) {
        return Ok(pairs.iter().copied().collect());
    }
    damaged("excluded pairs that there can't be")
}

/// The slots of bodies with a flag, such as those at rest, sorted.
pub(crate) fn flagged_slots(flags: &[bool]) -> Vec<u32> {
    let slots = (0..).zip(flags);
    let flagged = slots.filter(|(_, is_flagged)| **is_flagged);
    flagged.map(|(slot, _)| slot).collect()
}

/// Whether the body in each slot has a flag, which `name` describes.
pub(crate) fn flag_column(
    flagged: &[u32],
    slots: usize,
    name: &str,
) -> Result<Vec<bool>, SnapshotError> {
    let mut flags = vec![false; slots];
    for &slot in flagged {
        match flags.get_mut(slot as usize) {
            Some(is_flagged) => *is_flagged = true,
            None => return damaged(format!("slot {slot} of {slots} is {name}")),
        }
    }
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

/// The slots of a world, and their bodies.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct IdsSnapshot {
    present: Vec<bool>,
    generation: Vec<u32>,
    free: Vec<u32>,
    emptied: Vec<u32>,
    first_generation: u32,
}

impl IdsSnapshot {
    pub fn of(ids: &Ids) -> Self {
        Self {
            present: ids.present.clone(),
            generation: ids.generation.to_vec(),
            free: ids.free.clone(),
            emptied: ids.emptied.clone(),
            first_generation: ids.first_generation,
        }
    }

    pub fn restored(&self) -> Result<Ids, SnapshotError> {
        let slots = self.present.len();
        check_number(slots)?;
        check_length("generation", self.generation.len(), slots)?;
        let mut is_known = self.present.clone();
        for &slot in self.free.iter().chain(&self.emptied) {
            match is_known.get_mut(slot as usize) {
                Some(is_known) if !*is_known => *is_known = true,
                Some(_) => return damaged(format!("slot {slot} is in two states at once")),
                None => return damaged(format!("slot {slot} of {slots} is free")),
            }
        }
        let last = |slot: usize| self.generation[slot] == u32::MAX;
        if let Some(slot) = (0..slots).find(|&slot| !is_known[slot] && !last(slot)) {
            return damaged(format!("slot {slot} is neither taken nor free"));
        }
        if let Some(slot) = self.free.iter().find(|&&slot| last(slot as usize)) {
            return damaged(format!("slot {slot} is free and has no generation left"));
        }
        Ok(Ids {
            present: self.present.clone(),
            generation: Arc::new(self.generation.clone()),
            free: self.free.clone(),
            emptied: self.emptied.clone(),
            first_generation: self.first_generation,
            bodies: self.present.iter().filter(|is| **is).count(),
        })
    }
}

/// The pairs of the last cull, and those of the last events.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct PairsSnapshot {
    last: [Vec<u32>; 2],
    /// `None` if they are the same.
    watched: Option<WatchedSnapshot>,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct WatchedSnapshot {
    pairs: [Vec<u32>; 2],
    generation: Vec<u32>,
}

impl PairsSnapshot {
    pub fn of(log: &PairLog) -> Self {
        let columns = |list: &PairList| [list.first().to_vec(), list.second().to_vec()];
        let watched = (!Arc::ptr_eq(&log.last, &log.watched)).then(|| {
            let watched = log.watched.compacted();
            WatchedSnapshot {
                pairs: columns(watched.slots()),
                generation: watched.generation.to_vec(),
            }
        });
        Self { last: columns(log.last.slots()), watched }
    }

    pub fn restored(&self, ids: &Ids) -> Result<PairLog, SnapshotError> {
        let slots = sorted(&self.last, ids.slots())?;
        let mut is_named = ids.present.clone();
        for &slot in &ids.emptied {
            is_named[slot as usize] = true;
        }
        if let Some([i, j]) =
            slots.iter().find(|pair| pair.iter().any(|&slot| !is_named[slot as usize]))
        {
            return damaged(format!("the pair {i}, {j} has a slot that was empty"));
        }
        let generation = ids.generation().clone();
        let last = Arc::new(ReportedPairs::sorted(slots, generation));
        let watched = match &self.watched {
            None => last.clone(),
            Some(WatchedSnapshot { pairs, generation }) => {
                let named = pairs[1].iter().max().map_or(0, |&last| last as usize + 1);
                check_length("watched generation", generation.len(), named)?;
                let mut unnamed: Vec<u32> = generation.clone();
                for &slot in pairs.iter().flatten() {
                    if let Some(generation) = unnamed.get_mut(slot as usize) {
                        *generation = 0;
                    }
                }
                if let Some(slot) = unnamed.iter().position(|&generation| generation > 0) {
                    return damaged(format!("no watched pair names slot {slot}"));
                }
                let slots = sorted(pairs, generation.len())?;
                Arc::new(ReportedPairs::sorted(slots, Arc::new(generation.clone())))
            }
        };
        Ok(PairLog::of(last, watched))
    }
}

/// Pairs of numbers below `slots`, the lower one first, sorted, each once.
fn sorted([first, second]: &[Vec<u32>; 2], slots: usize) -> Result<PairList, SnapshotError> {
    if first.len() != second.len() {
        return damaged(format!("{} and {} halves of pairs", first.len(), second.len()));
    }
    let pairs = || first.iter().zip(second).map(|(&i, &j)| [i, j]);
    if let Some([i, j]) = pairs().find(|&[i, j]| i >= j || j as usize >= slots) {
        return damaged(format!("the pair {i}, {j} of {slots} slots"));
    }
    if !pairs().is_sorted_by(|a, b| a < b) {
        return damaged("pairs aren't sorted");
    }
    Ok(pairs().collect())
}
