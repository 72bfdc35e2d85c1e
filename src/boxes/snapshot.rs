//! Snapshots of a world of boxes, to save, restore and roll back.

use serde::{Deserialize, Serialize};

use super::BoxWorld;
use crate::bodies::Aabb;
use crate::living::{
    IdsSnapshot, Members, PairsSnapshot, RestoredMembers, SnapshotError, Version, excluded_slots,
    flagged_slots, restored_column,
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
        let Self { members, volumes } = self;
        let Members { ids, groups, .. } = members;
        let rows = || ids.filled();
        BoxWorldSnapshot {
            version: Version,
            ids: IdsSnapshot::of(ids),
            bounds: rows().map(|row| bits(&volumes.bounds[row])).collect(),
            dynamic: rows().map(|row| volumes.dynamic[row]).collect(),
            resting: flagged_slots(&members.resting, ids),
            groups: rows().map(|row| groups[row]).map(|g| [g.member, g.mask]).collect(),
            pairs: PairsSnapshot::of(&members.pairs, members.movers.all_changed(), ids),
            excluded: excluded_slots(&members.excluded, ids),
        }
    }

    /// Replaces this world by that of a snapshot. From then on the same calls give the same ids,
    /// pairs and events, in the same order, as in the world from which it was taken; finder,
    /// threads and tier may differ.
    ///
    /// # Errors
    /// The snapshot is inconsistent. The world stays unchanged.
    pub fn restore(&mut self, snapshot: &BoxWorldSnapshot) -> Result<(), SnapshotError> {
        let BoxWorldSnapshot { ids, resting, groups, pairs, excluded, .. } = snapshot;
        let restored = RestoredMembers::of(ids, resting, groups, pairs, excluded)?;
        let RestoredMembers { members, plan, changed } = restored;
        let corners = |corners: &[[u32; 3]; 2]| corners.map(|corner| corner.map(f32::from_bits));
        let bounds = snapshot.bounds.iter().map(corners).map(|[min, max]| Aabb { min, max });
        let bounds = restored_column("bounds", bounds, &plan, Aabb::default())?;
        for row in members.ids.filled() {
            bounds[row].check(members.ids.id(row as u32).slot())?;
        }
        let dynamic = restored_column("dynamic", snapshot.dynamic.iter().copied(), &plan, true)?;

        self.members = members;
        (self.volumes.bounds, self.volumes.dynamic) = (bounds, dynamic);
        if let Some(changed) = changed {
            self.resume(&changed);
        }
        Ok(())
    }
}
