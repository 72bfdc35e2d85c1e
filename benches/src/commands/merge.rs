//! `sdop merge`: the files of shards become the result that one process would have given.

use std::path::PathBuf;

use sdop_bench::sweep::{Units, merge};

use super::output::Format;
use super::{Outcome, reproduce, tradeoff, verify};

/// Put the shards of a sweep together
///
/// What --shard left behind, by whatever machines, becomes the result of the command run whole: the
/// same counts, hashes and pages. Shards of other code, settings or scenes are refused, and so are
/// missing ones and those that come twice.
#[derive(clap::Args)]
#[command(after_help = "Example: sdop merge shards/verify-*.units -o target/verify")]
pub struct Args {
    /// The shards' files, all of them
    #[arg(required = true)]
    shards: Vec<PathBuf>,
    /// Where the result's files go
    #[arg(short, long, value_name = "DIR", default_value = ".")]
    out: PathBuf,
    /// How the result is printed
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Runs the command.
///
/// # Errors
/// Files that can't be read or don't make a whole.
pub fn run(args: &Args) -> miette::Result<Outcome> {
    let mut files = Vec::new();
    for path in &args.shards {
        files.push((path.clone(), Units::read(path)?));
    }
    let merged = merge(files)?;
    match merged.header.command.as_str() {
        verify::NAME => verify::merged(&merged, &args.out, args.format),
        reproduce::NAME => reproduce::merged(&merged, &args.out, args.format),
        tradeoff::NAME => tradeoff::merged(&merged, &args.out, args.format),
        other => miette::bail!("this program knows no units of `sdop {other}`"),
    }
}
