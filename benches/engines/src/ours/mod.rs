//! Our cullers: boxes for the comparison on equal work, and the meshes' volumes that users cull
//! instead of boxes.

mod boxes;
mod culler;
pub mod movers;

use sdop::settings::Strategy;

use crate::entry::{Entry, OURS, Work};

const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Boxes; spheres alone; spheres, then or-DOPs.
pub const ENTRIES: [Entry; 3] = [
    Entry {
        name: OURS,
        version: VERSION,
        work: Work::Boxes,
        threads: usize::MAX,
        ages: true,
        new: |setup| Ok(Box::new(boxes::Boxes::new(setup)?)),
    },
    Entry {
        name: "sdop spheres",
        version: VERSION,
        work: Work::Spheres,
        threads: usize::MAX,
        ages: true,
        new: |setup| Ok(Box::new(culler::StrategyCuller::new(setup, Strategy::Sphere)?)),
    },
    Entry {
        name: "sdop s-dop",
        version: VERSION,
        work: Work::SDop,
        threads: usize::MAX,
        ages: true,
        new: |setup| Ok(Box::new(culler::StrategyCuller::new(setup, Strategy::SDopSequential)?)),
    },
];
