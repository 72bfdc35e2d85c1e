//! The program `sdop`, as a user runs it.

#[path = "support/answers.rs"]
mod answers;
mod cli;
#[path = "support/drawn_pairs.rs"]
mod drawn_pairs;
mod judge;
mod tradeoff;
