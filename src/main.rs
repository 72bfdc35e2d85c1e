//! `sdop`: parse the arguments, call the command, turn what it says into an exit code.

mod cli;

use std::io::Write as _;
use std::process::ExitCode;

use clap::Parser as _;
use sdop::lab::mpi;

/// 0 when all is well, 1 when a check failed, 2 on bad input (clap exits with 2 by itself).
fn main() -> ExitCode {
    cli::report_errors_whole();
    let ending = mpi::Ending;
    match cli::Cli::parse().run() {
        Ok(outcome) => {
            ending.well();
            match outcome {
                cli::Outcome::Passed => ExitCode::SUCCESS,
                cli::Outcome::Failed => ExitCode::from(1),
            }
        }
        Err(report) => {
            // Nobody may be listening on standard error: that is no reason to panic.
            let _ = writeln!(std::io::stderr(), "{report:?}");
            ending.badly(2);
            ExitCode::from(2)
        }
    }
}
