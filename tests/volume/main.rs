//! Volumes contain their meshes exactly, and are as small as they claim.
#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod containment;
mod exact;
