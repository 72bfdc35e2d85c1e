//! The list of engines in the comparison.

#[cfg(feature = "box3d")]
use crate::box3d;
use crate::entry::Entry;
use crate::incremental::MoverEntry;
#[cfg(feature = "physx")]
use crate::physx;
use crate::{broccoli, obvhs, ours, parry, rapier};
#[cfg(feature = "debian")]
use crate::{bullet, embree};

/// Every engine that was compiled in.
pub fn roster() -> Vec<Entry> {
    let all: &[&[Entry]] = &[
        &ours::ENTRIES,
        &parry::ENTRIES,
        &rapier::ENTRIES,
        &broccoli::ENTRIES,
        #[cfg(feature = "physx")]
        &physx::ENTRIES,
        #[cfg(feature = "debian")]
        &embree::ENTRIES,
        #[cfg(feature = "debian")]
        &bullet::ENTRIES,
    ];
    all.concat()
}

/// Every engine that was compiled in and can be given what has changed.
pub fn incremental() -> Vec<MoverEntry> {
    let all: &[&[MoverEntry]] = &[
        &ours::movers::ENTRIES,
        &rapier::MOVERS,
        &obvhs::MOVERS,
        #[cfg(feature = "box3d")]
        &box3d::MOVERS,
        #[cfg(feature = "physx")]
        &physx::MOVERS,
        #[cfg(feature = "debian")]
        &bullet::MOVERS,
    ];
    all.concat()
}
