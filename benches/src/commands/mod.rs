//! The command line, one file per command. A command parses its arguments, calls the library and
//! prints the result.
//!
//! A new command is a file with `Args` and `run`, a module line, a variant and a line in
//! [`Cli::run`].

mod advise;
mod bench;
#[cfg(feature = "maintain")]
mod board;
mod cases;
mod check;
mod cmp;
#[cfg(feature = "maintain")]
mod completions;
mod cost;
mod files;
mod judge;
#[cfg(feature = "maintain")]
mod man;
mod merge;
mod mesh;
mod output;
mod ranks;
mod record;
#[cfg(feature = "maintain")]
mod report;
mod reproduce;
mod run;
mod scene_args;
mod style;
mod sweep;
mod tradeoff;
mod verify;
mod view;

use std::ffi::OsString;
use std::io::Write as _;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Parser, Subcommand};
use miette::MietteHandlerOpts;
use sdop_bench::mpi;
use sdop_judge::{Conclusion, Verdict};

/// Collision culling by sphere-encapsulated or-DOPs (S-DOP): verified, vectorised, measured.
#[derive(Parser)]
#[command(
    name = "sdop",
    version,
    after_help = "Exit codes: 0 all is well, 1 a check failed, 2 bad input, 3 some requested cases were not judged. Standard error says why."
)]
#[cfg_attr(
    not(feature = "maintain"),
    command(
        after_long_help = "A build with `--features maintain` also has `report`, `board`, `man` and `completions`."
    )
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Run(run::Args),
    View(view::Args),
    Mesh(mesh::Args),
    Advise(advise::Args),
    Cost(cost::Args),
    Tradeoff(tradeoff::Args),
    Judge(judge::Args),
    Verify(verify::Args),
    Check(check::Args),
    Bench(bench::Args),
    Reproduce(reproduce::Args),
    Record(record::Args),
    Cmp(cmp::Args),
    Cases(cases::Args),
    Merge(merge::Args),
    #[cfg(feature = "maintain")]
    Board(board::Args),
    #[cfg(feature = "maintain")]
    Report(report::Args),
    #[cfg(feature = "maintain")]
    Completions(completions::Args),
    #[cfg(feature = "maintain")]
    Man(man::Args),
}

impl Command {
    /// Whether its work is split into units that several processes can share.
    fn is_sweep(&self) -> bool {
        match self {
            Self::Verify(args) => args.is_sweep(),
            Self::Tradeoff(args) => args.is_sweep(),
            Self::Record(args) => args.is_sweep(),
            Self::Reproduce(_) => true,
            _ => false,
        }
    }

    /// Whether its work can be shared by the ranks of `mpirun`. Each rank would run any other
    /// command as a whole.
    fn takes_ranks(&self) -> bool {
        self.is_sweep() || matches!(self, Self::Run(_))
    }
}

/// The exit code of invalid input.
pub const BAD_INPUT: u8 = 2;

/// How a command with valid input ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// All is well: exit code 0.
    Passed,
    /// A check failed, with one line that says which: exit code 1.
    Failed(String),
    /// No check failed, but some requested ones did not run, with their number: exit code 3.
    Incomplete(String),
    /// The input was invalid, all ranks know it, and one of them has reported it: exit code 2.
    #[cfg(feature = "mpi")]
    Told,
}

impl Cli {
    /// Checks that the work can be shared, so that ranks don't each do all of it.
    ///
    /// # Errors
    /// The program was started as many ranks, and it or the command doesn't support that.
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
            Command::Judge(args) => judge::run(&args),
            Command::Merge(args) => merge::run(&args),
            Command::Cases(args) => cases::run(&args),
            Command::Check(args) => check::run(&args),
            Command::Bench(args) => bench::run(&args),
            #[cfg(feature = "maintain")]
            Command::Board(args) => board::run(&args),
            Command::View(args) => view::run(&args),
            Command::Record(args) => record::run(&args),
            Command::Cmp(args) => cmp::run(&args),
            #[cfg(feature = "maintain")]
            Command::Report(args) => report::run(&args),
            #[cfg(feature = "maintain")]
            Command::Completions(args) => completions::run(&args),
            #[cfg(feature = "maintain")]
            Command::Man(args) => man::run(&args),
        }
    }
}

/// Runs the program with these arguments, its own name first, and returns its exit code.
pub fn main(arguments: impl IntoIterator<Item = impl Into<OsString>>) -> u8 {
    report_errors_whole();
    let ending = mpi::RankEnding;
    let cli = match Cli::try_parse_from(by_present_names(arguments)) {
        Ok(cli) => cli,
        Err(told) => {
            // A closed standard error is no reason to panic.
            ending.alike(|| drop(told.print()));
            // Help is not an error.
            return if told.exit_code() == 0 { 0 } else { BAD_INPUT };
        }
    };
    if let Err(report) = cli.refuse() {
        ending.alike(|| complain(&report));
        return BAD_INPUT;
    }
    match cli.run() {
        Ok(outcome) => {
            ending.well();
            outcome.into_code()
        }
        Err(report) => {
            complain(&report);
            ending.badly(BAD_INPUT.into());
            BAD_INPUT
        }
    }
}

/// `sdop verify --exec CMD` is now `sdop judge CMD`.
fn by_present_names(arguments: impl IntoIterator<Item = impl Into<OsString>>) -> Vec<OsString> {
    let mut arguments: Vec<OsString> = arguments.into_iter().map(Into::into).collect();
    let is_exec = |argument: &OsString| argument.as_encoded_bytes().starts_with(b"--exec");
    if arguments.get(1).is_some_and(|name| name == "verify") && arguments.iter().any(is_exec) {
        arguments[1] = "judge".into();
    }
    arguments
}

impl Outcome {
    /// The outcome of a verdict, and why it is not [`Conclusion::Pass`].
    fn new(conclusion: Conclusion, why: Option<String>) -> Self {
        let why = why.unwrap_or_default();
        match conclusion {
            Conclusion::Pass => Self::Passed,
            Conclusion::Incomplete => Self::Incomplete(why),
            Conclusion::NotPassed => Self::Failed(why),
        }
    }

    /// The exit code. Why it is 1 or 3 goes to standard error, on one line.
    fn into_code(self) -> u8 {
        let (code, why) = match self {
            Self::Passed => return 0,
            #[cfg(feature = "mpi")]
            Self::Told => return BAD_INPUT,
            Self::Failed(why) => (1, why),
            Self::Incomplete(why) => (3, why),
        };
        // A closed standard error is no reason to panic.
        let _ = writeln!(std::io::stderr(), "sdop: {why}");
        code
    }
}

impl From<&Verdict> for Outcome {
    fn from(verdict: &Verdict) -> Self {
        Self::new(verdict.conclusion(), verdict.why())
    }
}

/// Prints an error. A closed standard error is no reason to panic.
fn complain(report: &miette::Report) {
    let _ = writeln!(std::io::stderr(), "{report:?}");
}

/// Prints errors without wrapping lines, so that paths and commands in them can be copied.
fn report_errors_whole() {
    let hook = miette::set_hook(Box::new(|_| {
        Box::new(MietteHandlerOpts::new().wrap_lines(false).build())
    }));
    drop(hook); // another call of the same process has set it before
}

/// Parses one of a library enum's names; help and errors list all of them.
fn one_of<T>(names: &[&'static str]) -> impl TypedValueParser<Value = T> + use<T>
where
    T: std::str::FromStr + Clone + Send + Sync + 'static,
    T::Err: std::error::Error + Send + Sync + 'static,
{
    PossibleValuesParser::new(names).try_map(|name| name.parse())
}
