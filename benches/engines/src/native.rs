//! Engines in C++: `native/peer.h` declares the four functions that each one has.

#![allow(unsafe_code, reason = "the other side is C++")]

use std::ffi::c_void;

use miette::miette;

use sdop_judge::contestant::Contestant;

use crate::boxes::{Frame, Slabs};
use crate::entry::{Engine, Setup};

/// The functions of an engine.
#[derive(Clone, Copy)]
pub struct Shim {
    /// Makes it from the first frame's boxes; null when it can't be made.
    pub new: unsafe extern "C" fn(*const Slabs, usize, u32) -> *mut c_void,
    /// Finds a frame's pairs.
    pub frame: unsafe extern "C" fn(*mut c_void, *const Slabs),
    /// The pairs of the last frame and their number.
    pub pairs: unsafe extern "C" fn(*mut c_void, *mut usize) -> *const [u32; 2],
    /// Ends it.
    pub free: unsafe extern "C" fn(*mut c_void),
}

/// Declares the functions of the engine of that name in `native/` and gathers them.
macro_rules! shim {
    ($new:ident, $frame:ident, $pairs:ident, $free:ident) => {{
        #[allow(unsafe_code, reason = "the other side is C++")]
        mod functions {
            unsafe extern "C" {
                pub fn $new(
                    boxes: *const crate::boxes::Slabs,
                    count: usize,
                    threads: u32,
                ) -> *mut std::ffi::c_void;
                pub fn $frame(peer: *mut std::ffi::c_void, boxes: *const crate::boxes::Slabs);
                pub fn $pairs(peer: *mut std::ffi::c_void, count: *mut usize) -> *const [u32; 2];
                pub fn $free(peer: *mut std::ffi::c_void);
            }
        }
        crate::native::Shim {
            new: functions::$new,
            frame: functions::$frame,
            pairs: functions::$pairs,
            free: functions::$free,
        }
    }};
}
pub(crate) use shim;

/// An engine in C++ with the bodies of one scene.
struct NativeEngine {
    shim: Shim,
    peer: *mut c_void,
    bodies: usize,
}

/// Makes an engine.
pub fn new(setup: &Setup<'_>, shim: Shim) -> miette::Result<Engine> {
    let (boxes, threads) = (&setup.first.boxes, setup.threads as u32);
    // SAFETY: as many boxes as the call says.
    let peer = unsafe { (shim.new)(boxes.as_ptr(), boxes.len(), threads) };
    if peer.is_null() {
        return Err(miette!("the engine can't be made"));
    }
    Ok(Box::new(NativeEngine { shim, peer, bodies: boxes.len() }))
}

impl Contestant<Frame> for NativeEngine {
    fn frame(&mut self, frame: &Frame) {
        assert_eq!(frame.boxes.len(), self.bodies, "a scene keeps its bodies");
        // SAFETY: as many boxes as the engine was made for; it looks at them during the call alone.
        unsafe { (self.shim.frame)(self.peer, frame.boxes.as_ptr()) };
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        let mut count = 0;
        // SAFETY: the list stays until the next call, and has as many pairs as the engine says.
        unsafe {
            let pairs = (self.shim.pairs)(self.peer, &raw mut count);
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
        unsafe { (self.shim.free)(self.peer) };
    }
}
