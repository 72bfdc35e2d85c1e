//! Other programs, timed on the same frames.

pub mod timing;
