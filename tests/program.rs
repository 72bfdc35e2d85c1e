//! The program `sdop`, as a user runs it.

#[path = "support/answers.rs"]
mod answers;
mod cli;
mod judge;
