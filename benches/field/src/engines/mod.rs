//! The engines that are linked in, by their names in `engines.toml`.

#[cfg(feature = "box3d")]
mod box3d;
mod box3d_rust;
mod broccoli;
mod events;
#[cfg(feature = "debian")]
mod native;
mod obvhs;
mod ours;
mod parry;
#[cfg(feature = "physx")]
mod physx;
mod rapier;
mod tree;

use crate::entry::New;

/// Every engine that was compiled in.
pub fn all() -> Vec<(&'static str, New)> {
    let all: &[&[(&str, New)]] = &[
        &ours::ENGINES,
        &parry::ENGINES,
        &rapier::ENGINES,
        &broccoli::ENGINES,
        &obvhs::ENGINES,
        &box3d_rust::ENGINES,
        #[cfg(feature = "box3d")]
        &box3d::ENGINES,
        #[cfg(feature = "physx")]
        &physx::ENGINES,
        #[cfg(feature = "debian")]
        &native::ENGINES,
    ];
    all.concat()
}
