//! Robots of thirty parts that all move: the pairs of parts of two robots, by bodies of several
//! shapes, by bodies of one shape with excluded pairs, and by other engines' boxes of parts.
//!
//! In the last frame, every pair of parts whose meshes meet has to be among an engine's pairs.

mod contenders;
mod scene;

use std::path::PathBuf;

use contenders::{Compounds, PartBoxes, Parts};
use scene::{PARTS, Robots};
use sdop::Body;
use sdop_bench::measure::turns::{Quartiles, Turns};
use sdop_judge::contestant::Contestant;
use serde::Serialize;

use crate::compare::median_ratio;
use crate::facts;
use crate::{parry, rapier};

/// Frames of a turn.
const TURN: usize = 10;

/// Time the pairs of robots' parts
#[derive(clap::Args)]
pub struct Args {
    /// Numbers of robots
    #[arg(long, value_delimiter = ',', default_value = "23,100,1000")]
    sizes: Vec<usize>,
    /// Frames, of which the first ten are not timed
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

/// An engine with its name, its version and the milliseconds of its frames.
type TimedContender = (&'static str, &'static str, Box<dyn Contestant<Vec<Body>>>, Vec<f64>);

/// Checks, measures, prints the table, and writes it if asked to.
pub fn run(args: &Args) -> miette::Result<()> {
    let mut rows = Vec::new();
    for &count in &args.sizes {
        eprintln!("{count} robots");
        let robots = Robots::new(count, args.frames.max(2 * TURN))?;
        rows.extend(measure(&robots)?);
    }
    facts::print_csv(&rows, args.out.as_deref(), "robots")
}

fn measure(robots: &Robots) -> miette::Result<Vec<RobotTiming>> {
    let ours = env!("CARGO_PKG_VERSION");
    let (compounds, parts) = (Compounds::new(robots)?, Parts::new(robots)?);
    let mut all: Vec<TimedContender> = vec![
        ("sdop, bodies of parts", ours, Box::new(compounds), vec![]),
        ("sdop, a body per part", ours, Box::new(parts), vec![]),
    ];
    for entry in [&parry::ENTRIES[0], &rapier::ENTRIES[0]] {
        let engine = PartBoxes::new(robots, entry)?;
        all.push((entry.name, entry.version, Box::new(engine), vec![]));
    }
    let mut turns = Turns::default();
    for (turn, frames) in robots.frames.chunks(TURN).enumerate() {
        let engines = all.iter_mut().map(|(_, _, engine, ms)| (engine, ms));
        let (mut engines, mut times): (Vec<_>, Vec<_>) = engines.unzip();
        turns.round(&mut engines, frames, |timed| {
            if turn > 0 {
                times[timed.number].push(1e3 * timed.seconds);
            }
        });
    }
    let last = robots.frames.last().map_or(&[][..], Vec::as_slice);
    let truth = robots.truth(last)?;
    let base = all[0].3.clone();
    let rows = all.into_iter().map(|(engine, version, found, ms)| {
        let mut pairs = found.pairs();
        pairs.iter_mut().for_each(|pair| pair.sort_unstable());
        pairs.sort_unstable();
        let missed = truth.iter().filter(|pair| pairs.binary_search(pair).is_err());
        let ratio = median_ratio(&ms, &base);
        let spread = Quartiles::of(ms);
        RobotTiming {
            robots: robots.count(),
            parts: robots.count() * PARTS,
            engine,
            version,
            meeting: truth.len(),
            missed: missed.count(),
            pairs: pairs.len(),
            ms_low: spread.low,
            ms: spread.median,
            ms_high: spread.high,
            ratio,
        }
    });
    Ok(rows.collect())
}
