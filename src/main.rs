//! `sdop`: parse the arguments, call the command, turn what it says into an exit code.

mod cli;

use std::process::ExitCode;

use clap::Parser as _;
use sdop::lab::mpi;

/// 0 when all is well, 1 when a check failed, 2 on bad input, 3 when not all checks were made.
fn main() -> ExitCode {
    cli::report_errors_whole();
    let ending = mpi::Ending;
    let cli = match cli::Cli::try_parse() {
        Ok(cli) => cli,
        Err(told) => {
            // Nobody may be listening: that is no reason to panic.
            ending.alike(|| drop(told.print()));
            // Help is no error.
            return ExitCode::from(if told.exit_code() == 0 { 0 } else { BAD_INPUT });
        }
    };
    if let Err(report) = cli.refuse() {
        ending.alike(|| cli::complain(&report));
        return ExitCode::from(BAD_INPUT);
    }
    match cli.run() {
        Ok(outcome) => {
            ending.well();
            ExitCode::from(match outcome {
                cli::Outcome::Passed => 0,
                cli::Outcome::Failed => 1,
                cli::Outcome::Incomplete => 3,
                #[cfg(feature = "mpi")]
                cli::Outcome::Told => BAD_INPUT,
            })
        }
        Err(report) => {
            cli::complain(&report);
            ending.badly(BAD_INPUT.into());
            ExitCode::from(BAD_INPUT)
        }
    }
}

const BAD_INPUT: u8 = 2;
