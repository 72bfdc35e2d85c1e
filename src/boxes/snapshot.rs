//! Snapshots of a world of boxes, to save, restore and roll back.

use serde::{Deserialize, Serialize};

use super::BoxWorld;
use crate::bodies::{Aabb, Groups};
use crate::world::{
    IdsSnapshot, LivePairs, PairsSnapshot, SnapshotError, Version, excluded_slots, flag_column,
    flagged_slots, restored_column, restored_excluded,
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
        let rows = || self.ids.filled();
        let log = self.log.to_log(&self.ids);
        BoxWorldSnapshot {
            version: Version,
            ids: IdsSnapshot::of(&self.ids),
            bounds: rows().map(|row| bits(&self.bounds[row])).collect(),
            dynamic: rows().map(|row| self.dynamic[row]).collect(),
            resting: flagged_slots(&self.resting, &self.ids),
            groups: rows().map(|row| self.groups[row]).map(|g| [g.member, g.mask]).collect(),
            pairs: PairsSnapshot::of(&log, self.movers.all_changed(), &self.ids),
            excluded: excluded_slots(&self.excluded, &self.ids),
        }
    }

    /// Replaces this world by that of a snapshot. From then on the same calls give the same ids,
    /// pairs and events, in the same order, as in the world from which it was taken; finder,
    /// threads and tier may differ.
    ///
    /// # Errors
    /// The snapshot is inconsistent. The world stays unchanged.
    pub fn restore(&mut self, snapshot: &BoxWorldSnapshot) -> Result<(), SnapshotError> {
        let (ids, plan) = snapshot.ids.restored()?;
        let corners = |corners: &[[u32; 3]; 2]| corners.map(|corner| corner.map(f32::from_bits));
        let bounds = snapshot.bounds.iter().map(corners).map(|[min, max]| Aabb { min, max });
        let bounds = restored_column("bounds", bounds, &plan, Aabb::default())?;
        for row in ids.filled() {
            bounds[row].check(ids.id(row as u32).slot())?;
        }
        let dynamic = restored_column("dynamic", snapshot.dynamic.iter().copied(), &plan, true)?;
        let groups = snapshot.groups.iter().map(|&[member, mask]| Groups { member, mask });
        let groups = restored_column("groups", groups, &plan, Groups::ALL)?;
        let (log, changed) = snapshot.pairs.restored(&ids)?;
        let excluded = restored_excluded(&snapshot.excluded, &ids)?;
        let resting = flag_column(&snapshot.resting, &ids, "at rest")?;

        (self.ids, self.log, self.bounds) = (ids, LivePairs::of(log), bounds);
        (self.dynamic, self.resting, self.groups) = (dynamic, resting, groups);
        self.excluded = excluded;
        self.count_groups();
        self.movers.forget();
        self.replaced = true;
        if let Some(changed) = changed {
            self.movers.resume(&changed, &self.ids);
            self.warm_up();
        }
        Ok(())
    }
}
