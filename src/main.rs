//! `sdop`: parse the arguments, call the command.

fn main() {}
