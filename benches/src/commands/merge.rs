//! `sdop merge`: joins the files of shards to the result of one process.

use std::path::PathBuf;

use sdop_bench::sweep::{Units, merge};

use super::output::Format;
use super::{Outcome, reproduce, tradeoff, verify};

/// Join the shards of a sweep
///
/// Joins the files that --shard wrote, on any machines, to the result of the whole command: the
/// same counts, hashes and pages. Shards with different code, settings or scenes, duplicate shards
/// and missing shards are errors.
#[derive(clap::Args)]
#[command(after_help = "Example: sdop merge shards/verify-*.units -o target/verify")]
pub struct Args {
    /// All files of the shards
    #[arg(required = true)]
    shards: Vec<PathBuf>,
    /// Output directory
    #[arg(short, long, value_name = "DIR", default_value = ".")]
    out: PathBuf,
    /// Output format
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Runs the command.
///
/// # Errors
/// Files that can't be read or don't belong together.
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
