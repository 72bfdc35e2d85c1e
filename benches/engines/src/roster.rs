//! The engines that stand in the comparison.

use crate::entry::Entry;
#[cfg(feature = "physx")]
use crate::physx;
use crate::{broccoli, bvh, obvhs, ours, parry, rapier, rstar};
#[cfg(feature = "debian")]
use crate::{bullet, cgal, embree};

/// Every engine that was compiled in.
pub fn roster() -> Vec<Entry> {
    let all: &[&[Entry]] = &[
        &ours::ENTRIES,
        &parry::ENTRIES,
        &rapier::ENTRIES,
        &obvhs::ENTRIES,
        &bvh::ENTRIES,
        &broccoli::ENTRIES,
        &rstar::ENTRIES,
        #[cfg(feature = "physx")]
        &physx::ENTRIES,
        #[cfg(feature = "debian")]
        &embree::ENTRIES,
        #[cfg(feature = "debian")]
        &bullet::ENTRIES,
        #[cfg(feature = "debian")]
        &cgal::ENTRIES,
    ];
    all.concat()
}
