//! Timing other programs on the same frames.

pub mod timing;
