//! Volumes contain their meshes exactly, are as small as they claim, and are built the same way
//! everywhere.
#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

mod ball;
mod basis;
mod containment;
mod exact;
mod grown;
mod hull;
mod meshes;
mod principal;
mod shape;
mod shipped;
mod tightness;
