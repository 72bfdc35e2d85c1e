//! The program `sdop`, as a user runs it.

mod cli;
mod judge;
mod tradeoff;
