//! Judges foreign cullers: Rust cullers and programs, right ones and one with each flaw.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod answers;
mod catalogue;
mod cheats;
mod commands;
mod cullers;
mod parts;
mod periodic;
mod programs;
mod rust;
mod twins;
mod vectors;
