//! The interface for C and C++ (`sdop.h`): handles, columns in, pairs out.
//!
//! A function that can fail returns an [`SdopStatus`] and leaves the reason, with its remedy, in
//! [`sdop_last_error`]. No panic crosses the border. Handles may move between threads. Only one
//! thread at a time may use a handle, except in functions that take it as `const`: such calls may
//! run at the same time.
//!
//! # Safety
//! What C promises of the arguments of each function is at the head of `sdop.h`.

#![allow(unsafe_code, reason = "pointers of C cross the border here")]
#![allow(clippy::missing_safety_doc, reason = "stated once for all, in `sdop.h`")]

mod bodies;
mod border;
mod boxes;
mod call;
mod compounds;
mod pair_test;
mod periodic;
mod queries;
mod world;

use std::ffi::c_char;

pub use bodies::*;
pub use border::{
    SdopEvent, SdopEventKind, SdopIdPair, SdopPair, SdopStatus, SdopTakeEvent, SdopTakeIdPairs,
    SdopTakePairs,
};
pub use boxes::*;
pub use compounds::*;
pub use pair_test::*;
pub use periodic::*;
pub use queries::*;
pub use world::*;

/// The version of the library, such as "0.1.0".
#[unsafe(no_mangle)]
pub extern "C" fn sdop_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}

/// Why the last call on this thread failed and how to mend it, until the next call; empty if it did
/// not.
#[unsafe(no_mangle)]
pub extern "C" fn sdop_last_error() -> *const c_char {
    call::last_error()
}
