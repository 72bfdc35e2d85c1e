//! `sdop completions`: writes a script with which a shell completes commands and flags.

use clap::CommandFactory as _;
use clap_complete::{Shell, generate};

use super::output::print;
use super::{Cli, Outcome};

/// Write a shell's completions to standard output
#[derive(clap::Args)]
#[command(
    after_help = "Examples: sdop completions bash > ~/.local/share/bash-completion/completions/sdop\n          sdop completions fish > ~/.config/fish/completions/sdop.fish"
)]
pub struct Args {
    /// The shell
    shell: Shell,
}

/// Runs the command.
///
/// # Errors
/// Standard output can't be written.
pub fn run(args: &Args) -> miette::Result<Outcome> {
    let mut script = Vec::new();
    generate(args.shell, &mut Cli::command(), "sdop", &mut script);
    print(String::from_utf8_lossy(&script).trim_end())?;
    Ok(Outcome::Passed)
}
