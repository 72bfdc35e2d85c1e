//! `sdop`: parse the arguments, call the command, turn what it says into an exit code.

mod commands;

use std::process::ExitCode;

use clap::Parser as _;
use sdop_bench::mpi;

/// 0 when all is well, 1 when a check failed, 2 on bad input.
fn main() -> ExitCode {
    commands::report_errors_whole();
    let ending = mpi::Ending;
    let cli = match commands::Cli::try_parse() {
        Ok(cli) => cli,
        Err(told) => {
            // Nobody may be listening: that is no reason to panic.
            ending.alike(|| drop(told.print()));
            // Help is no error.
            return ExitCode::from(if told.exit_code() == 0 { 0 } else { BAD_INPUT });
        }
    };
    if let Err(report) = cli.refuse() {
        ending.alike(|| commands::complain(&report));
        return ExitCode::from(BAD_INPUT);
    }
    match cli.run() {
        Ok(outcome) => {
            ending.well();
            ExitCode::from(match outcome {
                commands::Outcome::Passed => 0,
                commands::Outcome::Failed => 1,
                #[cfg(feature = "mpi")]
                commands::Outcome::Told => BAD_INPUT,
            })
        }
        Err(report) => {
            commands::complain(&report);
            ending.badly(BAD_INPUT.into());
            ExitCode::from(BAD_INPUT)
        }
    }
}

const BAD_INPUT: u8 = 2;
