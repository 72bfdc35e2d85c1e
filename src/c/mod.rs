//! The interface for C and C++ (`sdop.h`): handles, columns in, pairs out.
//!
//! A function that can fail returns an [`SdopStatus`] and leaves the reason, with its remedy, in
//! [`sdop_last_error`]. No panic crosses the border. Handles may move between threads. Only one
//! thread at a time may use a handle, except in functions that take it as `const`: such calls may
//! run at the same time.
//!
//! # Safety
//! Of every function: a handle comes from the function that makes such handles, and is not used
//! after it was freed. A column has as many entries as the count beside it says, or one for each
//! body; a vector or a quaternion has its 3 or 4 numbers; a text ends with a zero. What a call
//! gives may be written: `capacity` entries of `buffer`, and one value behind any other pointer
//! that isn't `const`. A callback may be called with its `user`. Null is refused, unless the
//! function says what it means.

#![allow(unsafe_code, reason = "pointers of C cross the border here")]
#![allow(clippy::missing_safety_doc, reason = "stated once for all, above")]

mod bodies;
mod border;
mod box_world;
mod boxes;
mod compounds;
mod pair_test;
mod periodic_boxes;
mod periodic_world;
mod queries;
mod world;

use std::ffi::c_char;

pub use bodies::*;
pub use border::{
    SdopEvent, SdopEventKind, SdopIdPair, SdopPair, SdopStatus, SdopTakeEvent, SdopTakePairs,
};
pub use box_world::*;
pub use boxes::*;
pub use compounds::*;
pub use pair_test::*;
pub use periodic_boxes::*;
pub use periodic_world::*;
pub use queries::*;
pub use world::*;

/// Functions that take these as `const` may run at the same time.
const _: () = {
    const fn is_for_all_threads<T: Sync>() {}
    is_for_all_threads::<SdopBoxWorld>();
    is_for_all_threads::<SdopCompound>();
    is_for_all_threads::<SdopPairTest>();
    is_for_all_threads::<SdopPartCuller>();
    is_for_all_threads::<SdopPeriodicBoxes>();
    is_for_all_threads::<SdopPeriodicWorld>();
    is_for_all_threads::<SdopQueryIndex>();
    is_for_all_threads::<SdopShape>();
    is_for_all_threads::<SdopWorld>();
};

/// The version of the library, such as "0.1.0".
#[unsafe(no_mangle)]
pub extern "C" fn sdop_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}

/// Why the last call on this thread failed and how to mend it, until the next call; empty if it did
/// not.
#[unsafe(no_mangle)]
pub extern "C" fn sdop_last_error() -> *const c_char {
    border::last_error()
}
