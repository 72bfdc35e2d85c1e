//! The list of engines in the comparison.

use crate::entry::Entry;
#[cfg(feature = "physx")]
use crate::physx;
use crate::{broccoli, ours, parry, rapier};
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
