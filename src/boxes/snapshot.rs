//! Snapshots of a world of boxes, to save, restore and roll back.

use serde::{Deserialize, Serialize};

use super::BoxWorld;
use crate::bodies::{Aabb, Groups};
use crate::world::{
    IdsSnapshot, LivePairs, PairsSnapshot, SnapshotError, Version, check_length, flag_column,
    flagged_slots, restored_excluded,
};

/// A [`BoxWorld`] at one moment, to be stored or sent in any format of serde.
///
/// It has a version, and snapshots of other versions are rejected. Equal calls produce equal
/// snapshots. Numbers are saved as their bits, which no text format rounds.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BoxWorldSnapshot {
    version: Version,
    ids: IdsSnapshot,
    /// The lower corner of each box, then the upper one.
    bounds: Vec<[[u32; 3]; 2]>,
    dynamic: Vec<bool>,
    /// Slots of boxes at rest, sorted.
    #[serde(default)]
    resting: Vec<u32>,
    groups: Vec<[u32; 2]>,
    pairs: PairsSnapshot,
    #[serde(default)]
    excluded: Vec<[u32; 2]>,
}

impl BoxWorld {
    /// The present state of the world, for [`Self::restore`]: boxes with ids and groups, excluded
    /// pairs, free slots, the pairs of the last cull and those of the last events. Counters are not
    /// in it.
    #[must_use]
    pub fn snapshot(&self) -> BoxWorldSnapshot {
        let bits = |aabb: &Aabb| [aabb.min, aabb.max].map(|corner| corner.map(f32::to_bits));
        BoxWorldSnapshot {
            version: Version,
            ids: IdsSnapshot::of(&self.ids),
            bounds: self.bounds.iter().map(bits).collect(),
            dynamic: self.dynamic.clone(),
            resting: flagged_slots(&self.resting),
            groups: self.groups.iter().map(|g| [g.member, g.mask]).collect(),
            pairs: PairsSnapshot::of(&self.log.to_log(&self.ids)),
            excluded: self.excluded.sorted(),
        }
    }

    /// Replaces this world by that of a snapshot. From then on the same calls give the same ids,
    /// pairs and events, in the same order, as in the world from which it was taken; finder,
    /// threads and tier may differ.
    ///
    /// # Errors
    /// The snapshot is inconsistent. The world stays unchanged.
    pub fn restore(&mut self, snapshot: &BoxWorldSnapshot) -> Result<(), SnapshotError> {
        let ids = snapshot.ids.restored()?;
        for (column, entries) in [
            ("bounds", snapshot.bounds.len()),
            ("dynamic", snapshot.dynamic.len()),
            ("groups", snapshot.groups.len()),
        ] {
            check_length(column, entries, ids.slots())?;
        }
        let corners = |corners: &[[u32; 3]; 2]| corners.map(|corner| corner.map(f32::from_bits));
        let boxes = snapshot.bounds.iter().map(corners);
        let bounds: Vec<Aabb> = boxes.map(|[min, max]| Aabb { min, max }).collect();
        for (slot, aabb) in bounds.iter().enumerate() {
            aabb.check(slot)?;
        }
        let log = LivePairs::of(snapshot.pairs.restored(&ids)?);
        let excluded = restored_excluded(&snapshot.excluded, &ids)?;
        let resting = flag_column(&snapshot.resting, ids.slots(), "at rest")?;

        (self.ids, self.log, self.bounds) = (ids, log, bounds);
        self.dynamic.clone_from(&snapshot.dynamic);
        self.resting = resting;
        self.excluded = excluded;
        let groups = snapshot.groups.iter();
        self.groups = groups.map(|&[member, mask]| Groups { member, mask }).collect();
        self.count_groups();
        self.movers.forget();
        self.replaced = true;
        Ok(())
    }
}
