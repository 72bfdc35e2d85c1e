//! Bullet's dynamic tree broad phase: `native/bullet.cpp`.

#![allow(unsafe_code, reason = "Bullet is C++")]

use std::ffi::c_void;

use crate::boxes::Slabs;
use crate::entry::{Entry, Setup, Work};
use crate::incremental::{Extras, Found, HUNDRED_THOUSAND, Incremental, MoverEntry, Moves};
use crate::native::{new, shim};

const VERSION: &str = "3.24";

/// One way to drive it.
pub const ENTRIES: [Entry; 1] = [Entry {
    name: "Bullet",
    version: VERSION,
    work: Work::Boxes,
    threads: 1,
    ages: true,
    new: |setup| new(setup, shim!(bullet_new, bullet_frame, bullet_pairs, bullet_free)),
}];

/// Bullet's margin, and the share of pairs that it looks through in each frame for those that have
/// ended.
const MARGIN: f32 = 0.05;
const CLEANED_PER_CENT: i32 = 10;

const EXACT: MoverEntry = MoverEntry {
    name: "Bullet",
    version: VERSION,
    margin: 0.0,
    extras: Extras::None,
    work: Work::Boxes,
    only: None,
    most_bodies: HUNDRED_THOUSAND,
    new: |setup| Ok(Box::new(Incrementally::new(setup, 0.0, 100))),
};

/// Given what has changed: without a margin, all pairs looked through; and by default.
pub const MOVERS: [MoverEntry; 2] = [
    EXACT,
    MoverEntry {
        name: "Bullet, margin 0.05",
        margin: MARGIN,
        extras: Extras::Late,
        new: |setup| Ok(Box::new(Incrementally::new(setup, MARGIN, CLEANED_PER_CENT))),
        ..EXACT
    },
];

unsafe extern "C" {
    fn bullet_movers_new(boxes: *const Slabs, count: usize, cleaned: i32) -> *mut c_void;
    fn bullet_move(
        peer: *mut c_void,
        margin: f32,
        bodies: *const u32,
        boxes: *const Slabs,
        count: usize,
    );
    fn bullet_pairs(peer: *mut c_void, count: *mut usize) -> *const [u32; 2];
    fn bullet_free(peer: *mut c_void);
}

/// A broad phase that is given the changed boxes.
struct Incrementally {
    peer: *mut c_void,
    bodies: usize,
    margin: f32,
}

impl Incrementally {
    fn new(setup: &Setup<'_>, margin: f32, cleaned: i32) -> Self {
        let boxes = &setup.first.boxes;
        // SAFETY: as many boxes as the call says.
        let peer = unsafe { bullet_movers_new(boxes.as_ptr(), boxes.len(), cleaned) };
        Self { peer, bodies: boxes.len(), margin }
    }
}

impl Incremental for Incrementally {
    fn frame(&mut self, moves: &Moves) {
        let last = moves.bodies.last();
        assert!(last.is_none_or(|&body| (body as usize) < self.bodies));
        let (bodies, boxes) = (moves.bodies.as_ptr(), moves.boxes.as_ptr());
        // SAFETY: as many bodies as boxes, sorted, all of the scene.
        unsafe { bullet_move(self.peer, self.margin, bodies, boxes, moves.boxes.len()) };
    }

    fn found(&self) -> Found<'_> {
        let mut count = 0;
        // SAFETY: the list stays until the next call, and has as many pairs as the engine says.
        let pairs = unsafe {
            let pairs = bullet_pairs(self.peer, &raw mut count);
            match count {
                0 => Vec::new(),
                _ => std::slice::from_raw_parts(pairs, count).to_vec(),
            }
        };
        Found::Pairs(pairs)
    }
}

impl Drop for Incrementally {
    fn drop(&mut self) {
        // SAFETY: made once, ended once.
        unsafe { bullet_free(self.peer) };
    }
}
