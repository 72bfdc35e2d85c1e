//! The list of engines in the comparison.

use miette::miette;

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

/// Those whose names begin as requested, and those that always take part.
///
/// # Errors
/// A request that no name fits.
pub fn chosen<E>(
    all: Vec<E>,
    wished: Option<&[String]>,
    name_of: fn(&E) -> &'static str,
    always: fn(&E) -> bool,
) -> miette::Result<Vec<E>> {
    let Some(wished) = wished else {
        return Ok(all);
    };
    let known: Vec<_> = all.iter().map(name_of).collect();
    for name in wished {
        if !known.iter().any(|known| known.starts_with(name.as_str())) {
            return Err(miette!(
                help = format!(
                    "compiled in: {}; others need --features physx,debian,box3d",
                    known.join(", ")
                ),
                "no engine's name begins with `{name}`"
            ));
        }
    }
    let is_wished = |entry: &E| {
        let name = name_of(entry);
        always(entry) || wished.iter().any(|wish| name.starts_with(wish.as_str()))
    };
    Ok(all.into_iter().filter(is_wished).collect())
}
