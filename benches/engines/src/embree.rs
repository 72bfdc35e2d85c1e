//! Embree's `rtcCollide`: `native/embree.cpp`.

use crate::entry::{Entry, Work};
use crate::native::{new, shim};

/// One way to drive it.
pub const ENTRIES: [Entry; 1] = [Entry {
    name: "Embree",
    version: "3.13.5",
    work: Work::Boxes,
    threads: usize::MAX,
    ages: false,
    new: |setup| new(setup, shim!(embree_new, embree_frame, embree_pairs, embree_free)),
}];
