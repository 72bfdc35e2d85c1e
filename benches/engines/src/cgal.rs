//! CGAL's box intersection: `native/cgal.cpp`.

use crate::entry::{Entry, Work};
use crate::native::{new, shim};

/// One way to drive it.
pub const ENTRIES: [Entry; 1] = [Entry {
    name: "CGAL",
    version: "5.5.1",
    work: Work::Boxes,
    threads: 1,
    slack: 0,
    ages: false,
    new: |setup| new(setup, shim!(cgal_new, cgal_frame, cgal_pairs, cgal_free)),
}];
