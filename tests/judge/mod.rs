//! Judges foreign cullers: Rust cullers and programs, right ones and one with each flaw.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod catalogue;
mod cullers;
mod flawed;
mod flaws;
mod ours;
mod parts;
mod periodic;
mod programs;
mod rust;
mod vectors;

/// `tests/cmd/judge.console`: cases, answers to them, smallest cases as scenes and unit tests.
#[cfg(target_os = "linux")]
#[test]
fn commands() {
    crate::cli::check("judge");
}
