//! Engines in C++: `native/engine.h` declares the four functions that each one has.

#![allow(unsafe_code, reason = "the other side is C++")]

use std::ffi::c_void;
use std::ptr;

use miette::miette;
use sdop_judge::contestant::Contestant;

use crate::entry::{Engine, New, Setup};
use crate::frame::{Frame, Slabs};

/// The functions of an engine.
#[derive(Clone, Copy)]
struct Shim {
    /// Makes it from the first frame's boxes; null if it can't be made.
    new: unsafe extern "C" fn(*const Slabs, usize, u32, u32) -> *mut c_void,
    /// Finds the pairs after bodies have moved: their numbers (null: all bodies) and new boxes.
    frame: unsafe extern "C" fn(*mut c_void, *const u32, *const Slabs, usize),
    /// The pairs of the last frame and their number.
    pairs: unsafe extern "C" fn(*mut c_void, *mut usize) -> *const [u32; 2],
    /// Ends it.
    free: unsafe extern "C" fn(*mut c_void),
}

/// Declares the functions of an engine in `native/`.
macro_rules! shim {
    ($shim:ident: $new:ident, $frame:ident, $pairs:ident, $free:ident) => {
        unsafe extern "C" {
            fn $new(boxes: *const Slabs, count: usize, threads: u32, way: u32) -> *mut c_void;
            fn $frame(engine: *mut c_void, bodies: *const u32, boxes: *const Slabs, count: usize);
            fn $pairs(engine: *mut c_void, count: *mut usize) -> *const [u32; 2];
            fn $free(engine: *mut c_void);
        }
        const $shim: Shim = Shim { new: $new, frame: $frame, pairs: $pairs, free: $free };
    };
}
shim!(EMBREE: embree_new, embree_frame, embree_pairs, embree_free);
shim!(BULLET: bullet_new, bullet_frame, bullet_pairs, bullet_free);

/// Ways to drive Bullet: one search of the tree by itself, or one for each moved box; without a
/// margin, and as it is by default.
const AT_ONCE: u32 = 0;
const ONE_BY_ONE: u32 = 1;
const BY_DEFAULT: u32 = 2;

/// Embree's `rtcCollide`, and Bullet's dynamic tree broad phase.
pub const ENGINES: [(&str, New); 3] = [
    ("Embree", |setup| new(setup, EMBREE, 0)),
    ("Bullet", |setup| new(setup, BULLET, if setup.is_sparse { ONE_BY_ONE } else { AT_ONCE })),
    ("Bullet, margin 0.05", |setup| new(setup, BULLET, BY_DEFAULT)),
];

/// An engine in C++ with the bodies of one scene.
struct NativeEngine {
    shim: Shim,
    engine: *mut c_void,
    bodies: usize,
}

fn new(setup: &Setup<'_>, shim: Shim, way: u32) -> miette::Result<Engine> {
    let (boxes, threads) = (&setup.first.boxes, setup.threads as u32);
    // SAFETY: as many boxes as the call says.
    let engine = unsafe { (shim.new)(boxes.as_ptr(), boxes.len(), threads, way) };
    if engine.is_null() {
        return Err(miette!("the engine can't be made"));
    }
    Ok(Box::new(NativeEngine { shim, engine, bodies: boxes.len() }))
}

impl Contestant<Frame> for NativeEngine {
    fn frame(&mut self, frame: &Frame) {
        let (boxes, changed) = (&frame.boxes, frame.changed.as_ref());
        let last = changed.map_or(boxes.len(), |bodies| {
            assert_eq!(bodies.len(), boxes.len());
            bodies.last().map_or(0, |&last| last as usize + 1)
        });
        assert!(last <= self.bodies, "a scene keeps its bodies");
        let bodies = changed.map_or(ptr::null(), |bodies| bodies.as_ptr());
        // SAFETY: as many bodies as boxes, sorted, all of the scene; looked at during the call
        // alone.
        unsafe { (self.shim.frame)(self.engine, bodies, boxes.as_ptr(), boxes.len()) };
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        let mut count = 0;
        // SAFETY: the list stays until the next call, and has as many pairs as the engine says.
        unsafe {
            let pairs = (self.shim.pairs)(self.engine, &raw mut count);
            match count {
                0 => Vec::new(),
                _ => std::slice::from_raw_parts(pairs, count).to_vec(),
            }
        }
    }
}

impl Drop for NativeEngine {
    fn drop(&mut self) {
        // SAFETY: made by the shim, ended once.
        unsafe { (self.shim.free)(self.engine) };
    }
}
