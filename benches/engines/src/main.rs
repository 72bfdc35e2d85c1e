//! `sdop-peers`: other engines on the same frames as sdop, checked to find the same pairs and
//! timed.

#[cfg(feature = "box3d")]
mod box3d;
mod boxes;
mod broccoli;
#[cfg(feature = "debian")]
mod bullet;
mod changes;
mod check;
mod compare;
mod control;
#[cfg(feature = "debian")]
mod embree;
mod entry;
mod facts;
mod incremental;
mod kernels;
mod memory;
mod movers;
mod narrow;
#[cfg(feature = "debian")]
mod native;
mod obvhs;
mod oracle;
mod ours;
mod parry;
mod partners;
#[cfg(feature = "physx")]
mod physx;
mod queries;
mod rapier;
mod record;
mod robots;
mod roster;
mod scenes;
mod threads;
mod turns;
mod verdicts;

use std::path::PathBuf;

use clap::{Parser, Subcommand};
use compare::Case;
use entry::OURS;
use record::Record;
use scenes::{Order, Schedule, Spread};

/// Compare sdop with other engines: check that they find the same pairs, and time them in turns
///
/// Exit codes: 0 success, 1 an engine's pairs differ or an engine failed, 2 invalid arguments.
#[derive(Parser)]
#[command(
    after_help = "Example: sdop-peers --sizes 500,10000 --scenes uniform --order random --threads 1 --out results"
)]
#[command(args_conflicts_with_subcommands = true)]
struct Cli {
    #[command(subcommand)]
    other: Option<OtherCommand>,
    /// Numbers of bodies
    #[arg(long, value_delimiter = ',', default_value = "500,1000,10000,100000,1000000")]
    sizes: Vec<usize>,
    /// How bodies are spread
    #[arg(long, value_delimiter = ',', default_value = "uniform,mixed,clustered")]
    scenes: Vec<Spread>,
    /// In which order bodies are numbered
    #[arg(long, value_delimiter = ',', default_value = "random,sorted")]
    order: Vec<Order>,
    /// Threads that each engine may use; engines without threads only run with 1
    #[arg(long, value_delimiter = ',', default_value = "1,2")]
    threads: Vec<usize>,
    /// Engines, by the beginning of their names [default: all that are compiled in]
    #[arg(long, value_delimiter = ',')]
    peers: Option<Vec<String>>,
    /// Warm-up frames [default: by the number of bodies]
    #[arg(long)]
    warm_up: Option<usize>,
    /// Milliseconds per frame beyond which an engine is left out and listed; ours never is
    #[arg(long, default_value_t = f64::INFINITY)]
    limit_ms: f64,
    /// Timed frames [default: by the number of bodies]
    #[arg(long)]
    timed: Option<usize>,
    /// Other load on the machine, for the record
    #[arg(long, default_value = "nothing said of other work")]
    note: String,
    /// Write peers.csv, peers.json and peers.md here
    #[arg(long)]
    out: Option<PathBuf>,
}

#[derive(Subcommand)]
enum OtherCommand {
    Narrow(narrow::Args),
    Movers(movers::Args),
    Queries(queries::Args),
    Robots(robots::Args),
    Control(control::Args),
    Kernels(kernels::Args),
    Verdicts(verdicts::Args),
    Answer(verdicts::AnswerArgs),
}

fn main() -> miette::Result<()> {
    let cli = Cli::parse();
    threads::claim_caller()?;
    match &cli.other {
        Some(OtherCommand::Narrow(args)) => return narrow::run(args),
        Some(OtherCommand::Movers(args)) => return movers::run(args),
        Some(OtherCommand::Queries(args)) => return queries::run(args),
        Some(OtherCommand::Robots(args)) => return robots::run(args),
        Some(OtherCommand::Control(args)) => {
            return threads::outside_of_pools(|| control::run(args));
        }
        Some(OtherCommand::Kernels(args)) => return kernels::run(args),
        Some(OtherCommand::Verdicts(args)) => return verdicts::run(args),
        Some(OtherCommand::Answer(args)) => return verdicts::answer(args),
        None => {}
    }
    let entries = roster::chosen(
        roster::roster(),
        cli.peers.as_deref(),
        |entry| entry.name,
        |entry| entry.name == OURS,
    )?;
    let mut record = Record::new(cli.note.clone());
    for case in cases(&cli) {
        eprintln!(
            "{:?}, {:?}, {} bodies, {} threads",
            case.spread, case.order, case.bodies, case.threads
        );
        let compare = || compare::run(case, &entries, cli.limit_ms);
        record.add(match case.threads {
            1 => compare()?,
            _ => threads::outside_of_pools(compare)?,
        });
        if let Some(directory) = &cli.out {
            record.write(directory)?;
        }
    }
    print!("{}", record.page());
    Ok(())
}

fn cases(cli: &Cli) -> Vec<Case> {
    let mut cases = Vec::new();
    for &spread in &cli.scenes {
        for &order in &cli.order {
            for &threads in &cli.threads {
                for &bodies in &cli.sizes {
                    let usual = Schedule::of(bodies);
                    let schedule = Schedule {
                        warm_up: cli.warm_up.unwrap_or(usual.warm_up),
                        timed: cli.timed.unwrap_or(usual.timed).max(1),
                        ..usual
                    };
                    cases.push(Case { spread, order, bodies, threads, schedule });
                }
            }
        }
    }
    cases
}
