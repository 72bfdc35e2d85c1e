//! Frames in which few boxes move: engines that are given the changed boxes and keep the others,
//! checked to have the same pairs and timed in turns.
//!
//! A frame is a list of bodies with their new boxes. An engine's time runs from that list to its
//! answer in memory: its events (the pairs that began and ended) if it has any, otherwise its list
//! of pairs.

mod course;
mod follower;
mod judge;
mod measure;
mod record;
mod schedule;

use std::path::PathBuf;

use course::Motion;

use crate::entry::Setup;
use crate::incremental::MoverEntry;
use crate::roster;

/// Time engines in frames in which few boxes move
#[derive(clap::Args)]
pub struct Args {
    /// Numbers of bodies
    #[arg(long, value_delimiter = ',', default_value = "10000,100000,1000000")]
    sizes: Vec<usize>,
    /// Movers, in thousandths of the bodies [default: by the number of bodies]
    #[arg(long, value_delimiter = ',')]
    shares: Option<Vec<usize>>,
    /// Which bodies move [default: what the table of the record has]
    #[arg(long, value_delimiter = ',')]
    motions: Option<Vec<Motion>>,
    /// Engines, by the beginning of their names [default: all that are compiled in]
    #[arg(long, value_delimiter = ',')]
    peers: Option<Vec<String>>,
    /// Milliseconds per frame beyond which an engine is left out and listed; ours never is
    #[arg(long, default_value_t = 400.0)]
    limit_ms: f64,
    /// A few frames of 10,000 bodies, to see that all engines agree
    #[arg(long)]
    quick: bool,
    /// Other load on the machine, for the record
    #[arg(long, default_value = "nothing said of other work")]
    note: String,
    /// Write movers.csv, movers.json and movers.md here
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Checks, measures, prints the table, and writes it if asked to.
pub fn run(args: &Args) -> miette::Result<()> {
    let entries = roster::chosen(
        roster::incremental(),
        args.peers.as_deref(),
        |entry| entry.name,
        MoverEntry::is_ours,
    )?;
    let mut record = record::Record::new(args.note.clone());
    for case in schedule::cases(args) {
        eprintln!("{case}");
        record.add(measure::run(case, &entries, args.limit_ms)?);
        if let Some(directory) = &args.out {
            record.write(directory)?;
        }
    }
    print!("{}", record.page());
    Ok(())
}

/// What an engine is built for, with as many threads as it may use here.
fn alone<'a>(course: &'a crate::scenes::Course, first: &'a crate::boxes::Frame) -> Setup<'a> {
    Setup { scene: &course.scene, first, threads: 1 }
}
