//! The command line: one file a command. A command parses its arguments, calls the library and prints the result.
//!
//! A new command is a file with `Args` and `run`, a module line, a variant and a line in [`Cli::run`].

mod advise;
mod bench;
mod cases;
mod check;
mod cmp;
mod completions;
mod cost;
mod files;
mod judge;
mod man;
mod merge;
mod mesh;
mod output;
mod palette;
mod prices;
mod ranks;
mod record;
mod report;
mod reproduce;
mod run;
mod scene_args;
mod sweep;
mod tradeoff;
mod verify;
mod view;

use std::io::Write as _;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Parser, Subcommand};
use miette::MietteHandlerOpts;

/// Collision culling by sphere-encapsulated or-DOPs (S-DOP): verified, vectorised, measured.
#[derive(Parser)]
#[command(
    name = "sdop",
    version,
    after_help = "Exit codes: 0 all is well, 1 a check failed, 2 bad input."
)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Reproduce(reproduce::Args),
    Run(run::Args),
    Cost(cost::Args),
    Advise(advise::Args),
    Mesh(mesh::Args),
    Tradeoff(tradeoff::Args),
    Verify(verify::Args),
    Merge(merge::Args),
    Cases(cases::Args),
    Check(check::Args),
    Bench(bench::Args),
    View(view::Args),
    Record(record::Args),
    Cmp(cmp::Args),
    Report(report::Args),
    Completions(completions::Args),
    Man(man::Args),
}

impl Command {
    /// Whether its work is cut into units, which many can share.
    fn is_sweep(&self) -> bool {
        match self {
            Self::Verify(args) => args.is_sweep(),
            Self::Tradeoff(args) => args.is_sweep(),
            Self::Record(args) => args.is_sweep(),
            Self::Reproduce(_) => true,
            Self::Run(_)
            | Self::Cost(_)
            | Self::Advise(_)
            | Self::Mesh(_)
            | Self::Merge(_)
            | Self::Cases(_)
            | Self::Check(_)
            | Self::Bench(_)
            | Self::View(_)
            | Self::Cmp(_)
            | Self::Report(_)
            | Self::Completions(_)
            | Self::Man(_) => false,
        }
    }

    /// Whether its work can be shared by the ranks of `mpirun`. Another command would be run by each of them, all of it.
    fn takes_ranks(&self) -> bool {
        self.is_sweep() || matches!(self, Self::Run(_))
    }
}

/// How a command ended when its input was good.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// All is well: exit code 0.
    Passed,
    /// A check failed: exit code 1.
    Failed,
    /// The input was bad, all ranks know, and one of them has said it: exit code 2.
    #[cfg(feature = "mpi")]
    Told,
}

impl Outcome {
    /// A failed check, with the reason on standard error, in one line. JSON has the same text as `why`.
    fn failed(why: impl std::fmt::Display) -> Self {
        // Nobody may be listening: that is no reason to panic.
        let _ = writeln!(std::io::stderr(), "sdop: {why}");
        Self::Failed
    }

    /// Whether there is no reason why a check failed.
    fn of(why: Option<&str>) -> Self {
        why.map_or(Self::Passed, Self::failed)
    }
}

impl Cli {
    /// Refuses to share work that can't be, above all to be one of many ranks where each would do all of it.
    ///
    /// # Errors
    /// Many ranks, and the program or the command doesn't take them.
    pub fn refuse(&self) -> miette::Result<()> {
        if let Command::Record(args) = &self.command {
            args.refuse()?;
        }
        ranks::refuse(self.command.takes_ranks())
    }

    /// Runs the command.
    ///
    /// # Errors
    /// Bad input: exit code 2.
    pub fn run(self) -> miette::Result<Outcome> {
        match self.command {
            Command::Reproduce(args) => reproduce::run(&args),
            Command::Run(args) => run::run(&args),
            Command::Cost(args) => cost::run(&args),
            Command::Advise(args) => advise::run(&args),
            Command::Mesh(args) => mesh::run(&args),
            Command::Tradeoff(args) => tradeoff::run(&args),
            Command::Verify(args) => verify::run(&args),
            Command::Merge(args) => merge::run(&args),
            Command::Cases(args) => cases::run(&args),
            Command::Check(args) => check::run(&args),
            Command::Bench(args) => bench::run(&args),
            Command::View(args) => view::run(&args),
            Command::Record(args) => record::run(&args),
            Command::Cmp(args) => cmp::run(&args),
            Command::Report(args) => report::run(&args),
            Command::Completions(args) => completions::run(&args),
            Command::Man(args) => man::run(&args),
        }
    }
}

/// Says an error. Nobody may be listening on standard error: that is no reason to panic.
pub fn complain(report: &miette::Report) {
    let _ = writeln!(std::io::stderr(), "{report:?}");
}

/// Has errors printed unwrapped: a path or a command in a hint must survive being copied.
pub fn report_errors_whole() {
    let hook = miette::set_hook(Box::new(|_| {
        Box::new(MietteHandlerOpts::new().wrap_lines(false).build())
    }));
    debug_assert!(hook.is_ok(), "set before the first error");
}

/// Reads one of a library enum's names; help and errors list them all.
fn one_of<T>(names: &[&'static str]) -> impl TypedValueParser<Value = T> + use<T>
where
    T: std::str::FromStr + Clone + Send + Sync + 'static,
    T::Err: std::error::Error + Send + Sync + 'static,
{
    PossibleValuesParser::new(names).try_map(|name| name.parse())
}
