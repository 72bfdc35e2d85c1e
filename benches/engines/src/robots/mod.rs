//! Robots of thirty parts that all move: the pairs of parts of two robots, by bodies of several
//! shapes, by bodies of one shape with excluded pairs, and by other engines' boxes of parts.
//!
//! In the last frame, every pair of parts whose meshes meet has to be among an engine's pairs.

mod contenders;
mod scene;

use std::path::PathBuf;
use std::time::Instant;

use contenders::{Compounds, Contender, Parry, Parts, Rapier};
use miette::IntoDiagnostic as _;
use scene::{PARTS, Robots};
use sdop_bench::measure::turns::{Quartiles, median};
use serde::Serialize;

use crate::compare::median_ratio;
use crate::facts;

/// Time the pairs of robots' parts
#[derive(clap::Args)]
pub struct Args {
    /// Numbers of robots
    #[arg(long, value_delimiter = ',', default_value = "23,100,1000")]
    sizes: Vec<usize>,
    /// Frames, of which the first fifth is not timed
    #[arg(long, default_value_t = 100)]
    frames: usize,
    /// Write robots.csv here
    #[arg(long)]
    out: Option<PathBuf>,
}

/// One engine with one number of robots.
#[derive(Serialize)]
struct RobotTiming {
    robots: usize,
    parts: usize,
    engine: &'static str,
    version: &'static str,
    pairs: usize,
    meeting: usize,
    missed: usize,
    ms_low: f64,
    ms: f64,
    ms_high: f64,
    /// Its time over that of our bodies of several shapes, the median over frames.
    ratio: f64,
}

/// Checks, measures, prints the table, and writes it if asked to.
pub fn run(args: &Args) -> miette::Result<()> {
    let mut rows = Vec::new();
    for &count in &args.sizes {
        eprintln!("{count} robots");
        rows.extend(measure(&Robots::new(count, args.frames.max(5))?)?);
    }
    let text = facts::csv(&rows)?;
    print!("{text}");
    if let Some(directory) = &args.out {
        std::fs::create_dir_all(directory).into_diagnostic()?;
        sdop::files::write(&directory.join("robots.csv"), text).into_diagnostic()?;
    }
    Ok(())
}

fn measure(robots: &Robots) -> miette::Result<Vec<RobotTiming>> {
    let ours = env!("CARGO_PKG_VERSION");
    let mut engines: Vec<(&str, &str, Box<dyn Contender>)> = vec![
        (
            "sdop, bodies of parts",
            ours,
            Box::new(Compounds::new(robots)?),
        ),
        ("sdop, a body per part", ours, Box::new(Parts::new(robots)?)),
        (
            "parry3d",
            crate::parry::VERSION,
            Box::new(Parry::new(robots)),
        ),
        (
            "rapier3d",
            crate::rapier::VERSION,
            Box::new(Rapier::new(robots)),
        ),
    ];
    let mut times = vec![Vec::new(); engines.len()];
    for (number, poses) in robots.frames.iter().enumerate() {
        for turn in 0..engines.len() {
            let turn = (turn + number) % engines.len();
            let start = Instant::now();
            engines[turn].2.frame(robots, poses);
            let ms = 1e3 * start.elapsed().as_secs_f64();
            engines[turn].2.settle();
            if number >= robots.frames.len() / 5 {
                times[turn].push(ms);
            }
        }
    }
    let last = robots.frames.last().map_or(&[][..], Vec::as_slice);
    let truth = robots.truth(last)?;
    let rows = engines
        .iter()
        .zip(&times)
        .map(|((engine, version, found), ms)| {
            let pairs = found.pairs();
            let missed = truth
                .iter()
                .filter(|pair| pairs.binary_search(pair).is_err());
            let spread = Quartiles::of(ms.clone());
            RobotTiming {
                robots: robots.count(),
                parts: robots.count() * PARTS,
                engine,
                version,
                meeting: truth.len(),
                missed: missed.count(),
                pairs: pairs.len(),
                ms_low: spread.low,
                ms: median(ms.clone()),
                ms_high: spread.high,
                ratio: median_ratio(ms, &times[0]),
            }
        });
    Ok(rows.collect())
}
