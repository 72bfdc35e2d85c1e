//! `sdop-field`: other engines on the same frames as sdop, checked to find the same pairs and
//! timed.

mod answer;
mod case;
mod engines;
mod entry;
mod frame;
mod memory;
mod movers;
mod oracle;
mod questions;
mod run;
mod scenes;
mod table;
mod threads;
mod truth;

use std::path::PathBuf;

use case::Case;
use clap::{Parser, Subcommand};
use movers::Motion;
use questions::Question;
use scenes::{Order, Spread};
use sdop_bench::roster::Workload;
use table::Table;

/// Compare sdop with other engines: check that they find the same, and time them in turns
///
/// Exit codes: 0 success, 1 an engine's pairs differ or an engine failed, 2 invalid arguments.
#[derive(Parser)]
#[command(
    after_help = "Examples: sdop-field boxes --sizes 500,10000 --scenes uniform --threads 1 --out results\n          sdop-field quick"
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// All boxes move
    Boxes(BoxesArgs),
    /// Few boxes move: engines that are given what has changed
    Movers(MoversArgs),
    /// Boxes rest and are asked: single questions and batches
    Queries(QueriesArgs),
    /// A few frames of each, with every engine
    Quick(Common),
    Answer(answer::Args),
}

#[derive(clap::Args)]
struct Common {
    /// Engines, by the beginning of their names [default: all that are compiled in]
    #[arg(long, value_delimiter = ',')]
    engines: Option<Vec<String>>,
    /// Milliseconds per frame beyond which an engine is left out and listed; ours never is
    #[arg(long, default_value_t = f64::INFINITY)]
    limit_ms: f64,
    /// Warm-up frames [default: by the number of bodies]
    #[arg(long)]
    warm_up: Option<usize>,
    /// Timed frames [default: by the number of bodies]
    #[arg(long)]
    timed: Option<usize>,
    /// Other load on the machine, for the record
    #[arg(long, default_value = "nothing said of other work")]
    note: String,
    /// Write the table as CSV and JSON, and a page, here
    #[arg(long)]
    out: Option<PathBuf>,
}

#[derive(clap::Args)]
struct BoxesArgs {
    #[command(flatten)]
    common: Common,
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
}

#[derive(clap::Args)]
struct MoversArgs {
    #[command(flatten)]
    common: Common,
    /// Numbers of bodies
    #[arg(long, value_delimiter = ',', default_value = "10000,100000,1000000")]
    sizes: Vec<usize>,
    /// Movers, in thousandths of the bodies [default: by the number of bodies]
    #[arg(long, value_delimiter = ',')]
    shares: Option<Vec<usize>>,
    /// Which bodies move [default: what the table of the record has]
    #[arg(long, value_delimiter = ',')]
    motions: Option<Vec<Motion>>,
}

#[derive(clap::Args)]
struct QueriesArgs {
    #[command(flatten)]
    common: Common,
    /// Numbers of boxes
    #[arg(long, value_delimiter = ',', default_value = "1000,10000,100000")]
    sizes: Vec<usize>,
    /// Kinds of questions
    #[arg(long, value_delimiter = ',', default_value = "box,ball,along,first,sets")]
    kinds: Vec<Question>,
    /// Questions of each kind
    #[arg(long, default_value_t = 1000)]
    questions: usize,
    /// Threads: on several, all questions are one batch
    #[arg(long, value_delimiter = ',', default_value = "1,2")]
    threads: Vec<usize>,
}

fn main() -> miette::Result<()> {
    let cli = Cli::parse();
    if !matches!(cli.command, Command::Answer(_)) {
        is_fair(env!("SDOP_PROFILE"))?;
    }
    threads::claim_caller()?;
    let (common, cases, name) = match &cli.command {
        Command::Answer(args) => return answer::run(args),
        Command::Boxes(args) => (&args.common, boxes(args), "peers"),
        Command::Movers(args) => (&args.common, movers(args), "movers"),
        Command::Queries(args) => (&args.common, queries(args), "queries"),
        Command::Quick(common) => (common, quick(), "times"),
    };
    let mut table = Table::new(&common.note);
    for mut case in cases {
        case.warm_up = common.warm_up.unwrap_or(case.warm_up);
        case.timed = common.timed.unwrap_or(case.timed).max(1);
        case.checked = case.checked.min(case.warm_up).max(1);
        eprintln!("{case}");
        let entries = entry::chosen(case.workload, common.engines.as_deref())?;
        let compare = || run::run(case, &entries, common.limit_ms);
        table.add(match case.threads {
            1 => compare()?,
            _ => threads::outside_of_pools(compare)?,
        });
        if let Some(directory) = &common.out {
            table.write(directory, name)?;
        }
    }
    print!("{}", table.page());
    Ok(())
}

/// Whether cargo has optimised the engines, too. The workspace's other profiles optimise what works
/// in the program alone.
fn is_fair(profile: &str) -> miette::Result<()> {
    if profile == "optimised" {
        return Ok(());
    }
    let help = "cargo run --profile optimised -p sdop-field -- quick";
    Err(miette::miette!(help = help, "the profile `{profile}` leaves the engines unoptimised"))
}

fn boxes(args: &BoxesArgs) -> Vec<Case> {
    let mut cases = Vec::new();
    for &spread in &args.scenes {
        for &order in &args.order {
            for &threads in &args.threads {
                let sizes = args.sizes.iter();
                cases.extend(sizes.map(|&bodies| Case::boxes(spread, order, bodies, threads)));
            }
        }
    }
    cases
}

fn queries(args: &QueriesArgs) -> Vec<Case> {
    let mut cases = Vec::new();
    for &bodies in &args.sizes {
        for &threads in &args.threads {
            let case = |&kind| Case::queries(bodies, threads, kind, args.questions, 31);
            cases.extend(args.kinds.iter().map(case));
        }
    }
    cases
}

fn movers(args: &MoversArgs) -> Vec<Case> {
    let mut cases = Vec::new();
    for &bodies in &args.sizes {
        for share in shares(args, bodies) {
            let movers = (bodies * share / 1000).max(1);
            let motions = motions(args, bodies, share).into_iter();
            cases.extend(motions.map(|motion| Case::movers(bodies, movers, motion, false)));
        }
        if args.motions.is_none() {
            cases.extend(further_cases(bodies));
        }
    }
    cases
}

/// Movers in thousandths: fewer cases with a million bodies, which take long to build.
fn shares(args: &MoversArgs, bodies: usize) -> Vec<usize> {
    match &args.shares {
        Some(shares) => shares.clone(),
        None if bodies > 100_000 => vec![1, 10, 1000],
        None => vec![1, 10, 50, 200, 1000],
    }
}

/// The motions of a share: with all moving there is one.
fn motions(args: &MoversArgs, bodies: usize, share: usize) -> Vec<Motion> {
    match &args.motions {
        Some(motions) => motions.clone(),
        None if share == 1000 || (bodies > 100_000 && share > 1) => vec![Motion::Same],
        None if share == 10 && bodies == 100_000 => {
            vec![Motion::Same, Motion::Fresh, Motion::Wave, Motion::Teleport]
        }
        None => vec![Motion::Same, Motion::Fresh],
    }
}

/// Cases beyond the shares.
fn further_cases(bodies: usize) -> Vec<Case> {
    let replaced = Case::movers(bodies, 1, Motion::Replaced, false);
    match bodies {
        100_000 => vec![
            Case::movers(bodies, 10, Motion::Same, false),
            Case { timed: 60, turn: 20, ..Case::movers(bodies, bodies, Motion::Waking, false) },
            replaced,
            Case::movers(bodies, 100, Motion::Same, true),
            Case::movers(bodies, 100, Motion::Fresh, true),
        ],
        1_000_000 => vec![Case { timed: 300, turn: 20, ..replaced }],
        _ => Vec::new(),
    }
}

/// A few frames of each kind, to see that all engines agree.
fn quick() -> Vec<Case> {
    let mut cases = Vec::new();
    for threads in [1, 2] {
        for spread in [Spread::Uniform, Spread::Long] {
            cases.push(Case::boxes(spread, Order::Random, 1000, threads));
        }
        let kinds = <Question as clap::ValueEnum>::value_variants().iter();
        cases.extend(kinds.map(|&kind| Case::queries(1000, threads, kind, 100, 4)));
    }
    let movers = [
        (100, Motion::Same, false),
        (1000, Motion::Fresh, false),
        (10_000, Motion::Waking, false),
        (100, Motion::Teleport, false),
        (1, Motion::Replaced, false),
        (100, Motion::Fresh, true),
    ];
    cases.extend(
        movers.map(|(movers, motion, meshes)| Case::movers(10_000, movers, motion, meshes)),
    );
    let few = |case: Case| match case.workload {
        Workload::Queries => case,
        _ => Case { warm_up: 20, timed: 20, turn: 10, ..case },
    };
    cases.into_iter().map(few).collect()
}
