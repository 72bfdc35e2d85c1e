//! `sdop`: the program, whose commands are in the library.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(sdop_bench::commands::main(std::env::args_os()))
}
