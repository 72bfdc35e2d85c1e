//! Bullet's dynamic tree broad phase: `native/bullet.cpp`.

use crate::entry::{Entry, Work};
use crate::native::{new, shim};

/// One way to drive it.
pub const ENTRIES: [Entry; 1] = [Entry {
    name: "Bullet",
    version: "3.24",
    work: Work::Boxes,
    threads: 1,
    ages: true,
    new: |setup| {
        new(
            setup,
            shim!(bullet_new, bullet_frame, bullet_pairs, bullet_free),
        )
    },
}];
