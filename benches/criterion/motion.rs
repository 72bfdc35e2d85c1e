//! The cost of motion for the finders that `auto` chooses between: update and finding in
//! nanoseconds per body and frame, and percentiles of frames, because a list's worst frame is the
//! one that builds it. `cargo bench --bench motion` prints a Markdown table.
//!
//! Cullers take turns of eight frames on one swarm, so that each sees the same motion and the same
//! machine; the first frame of a turn, before which others ran, isn't counted.

mod common;

use common::swarm::{Kind, Swarm};
use sdop::bodies::Bodies;
use sdop::culler::Culler;
use sdop::settings::{Finder, Strategy};
use sdop_bench::measure::turns::{Regime, Turns};
use sdop_bench::percentiles::Percentiles;
use sdop_judge::contestant::Contestant;

/// The most turns per row; [`WORK`] limits bodies times frames.
const TURNS: usize = 60;
const WORK: usize = 48_000_000;
/// Frames per turn.
const FRAMES: usize = 8;
/// By how many radii a coordinate changes per frame, at most.
const MOTIONS: [f32; 4] = [0.01, 0.03, 0.1, 0.3];

/// The finders that `auto` chooses between for many bodies, and `auto` itself.
fn takes_part(finder: Finder) -> bool {
    match finder {
        Finder::AllPairs | Finder::Sweep => false,
        Finder::Grid | Finder::Neighbours | Finder::Auto => true,
    }
}

fn main() {
    println!(
        "| bodies | radii per frame | strategy | finder | tests a body | mean | p50 | p99 | most | p50 of grid's |"
    );
    println!("|--:|--:|---|---|--:|--:|--:|--:|--:|--:|");
    for bodies in [10_000, 100_000, 1_000_000] {
        for most in MOTIONS {
            for strategy in [Strategy::Sphere, Strategy::SDopBatch] {
                compare(bodies, most, strategy);
            }
        }
    }
}

/// A culler with its frames' seconds.
struct TimedFinder {
    finder: Finder,
    culler: Culler,
    seconds: Vec<f64>,
}

impl Contestant for TimedFinder {
    fn frame(&mut self, bodies: &Bodies) {
        // A swarm stays within the contract.
        let _ = self.culler.cull(bodies);
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.culler.pairs().sorted()
    }
}

fn compare(bodies: usize, most: f32, strategy: Strategy) {
    let mut swarm = Swarm::moving(Kind::Uniform, bodies, most);
    let finders = Finder::ALL.iter().copied().filter(|&finder| takes_part(finder));
    let mut entrants: Vec<TimedFinder> = finders
        .map(|finder| TimedFinder {
            finder,
            culler: swarm.culler_by(strategy, finder, 1),
            seconds: Vec::new(),
        })
        .collect();
    let tests: Vec<u64> =
        entrants.iter().map(|entrant| entrant.culler.counters().sphere.tests).collect();
    let mut turns = Turns::default();
    for _ in 0..TURNS.min(WORK / bodies / FRAMES) {
        let frames: [Bodies; FRAMES] = std::array::from_fn(|_| {
            swarm.sway();
            swarm.bodies.clone()
        });
        turns.round(&mut entrants, &frames, |timed| {
            if timed.regime == Regime::Warm {
                timed.contestant.seconds.push(timed.seconds);
            }
        });
    }
    let statistics = |entrant: &TimedFinder| {
        let mean = entrant.seconds.iter().sum::<f64>() / entrant.seconds.len() as f64;
        let Percentiles { p50, p99, most } = Percentiles::of(entrant.seconds.clone());
        [mean, p50, p99, most].map(|seconds| seconds * 1e9 / bodies as f64)
    };
    let times: Vec<[f64; 4]> = entrants.iter().map(statistics).collect();
    let grid = entrants.iter().position(|entrant| entrant.finder == Finder::Grid);
    let of_grids = grid.map_or(f64::NAN, |at| times[at][1]);
    for ((entrant, [mean, half, late, last]), before) in entrants.iter().zip(times).zip(tests) {
        let finder = entrant.finder;
        let tests = (entrant.culler.counters().sphere.tests - before) as f64;
        let frames = (entrant.seconds.len() / (FRAMES - 1) * FRAMES) as f64;
        println!(
            "| {bodies} | {most} | {strategy} | {finder} | {:.2} | {mean:.1} | {half:.1} | {late:.1} | {last:.1} | {:.2} |",
            tests / (bodies as f64 * frames),
            half / of_grids,
        );
    }
}
