//! `sdop man`: writes a manual page for the program and for each of its commands.

use std::path::PathBuf;

use clap::CommandFactory as _;
use clap_mangen::Man;
use miette::IntoDiagnostic as _;

use super::files::write;
use super::output::print;
use super::{Cli, Outcome};

/// Write one manual page per command, with the text of --help
#[derive(clap::Args)]
#[command(after_help = "Example: sdop man --out ~/.local/share/man/man1 && man sdop-run")]
pub struct Args {
    /// The directory for sdop.1, sdop-run.1 and the others
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// Runs the command.
///
/// # Errors
/// A page that can't be written.
pub fn run(args: &Args) -> miette::Result<Outcome> {
    let mut program = Cli::command().disable_help_subcommand(true);
    // Gives each command its full name, such as `sdop run`.
    program.build();
    let commands = program.get_subcommands().cloned();
    let pages: Vec<clap::Command> = std::iter::once(program.clone()).chain(commands).collect();
    for command in &pages {
        let name = command.get_display_name().unwrap_or_else(|| command.get_name());
        let path = args.out.join(format!("{name}.1"));
        let mut page = Vec::new();
        Man::new(command.clone()).title(name).render(&mut page).into_diagnostic()?;
        write(&path, page)?;
    }
    print(&format!("{} pages in {}", pages.len(), args.out.display()))?;
    Ok(Outcome::Passed)
}
