//! The cost of mixed radii: update and pair finding in nanoseconds per reported pair, for radii of
//! one size, 1 : 16 and 1 : 1000. `cargo bench --bench radii` prints a Markdown table.
//!
//! The three take turns, and a ratio is the median over rounds of a time over that of one size in
//! the same round.

mod common;

use common::swarm::{Kind, Swarm};
use sdop::culler::Culler;
use sdop::settings::Finder;
use sdop_bench::measure::turns::median;

/// Turns of each contestant.
const ROUNDS: usize = 15;

const KINDS: [(&str, Kind); 3] =
    [("one size", Kind::Uniform), ("1 : 16", Kind::Mixed), ("1 : 1000", Kind::Wild)];

fn main() {
    println!("| bodies | radii | pairs a body | ns a pair | of one size |");
    println!("|--:|---|--:|--:|--:|");
    for bodies in [10_000, 100_000, 1_000_000] {
        compare(bodies);
    }
}

fn compare(bodies: usize) {
    let frames = (1_000_000 / bodies).max(1);
    let mut racers = KINDS.map(|(name, kind)| {
        let mut swarm = Swarm::new(kind, bodies);
        let culler = swarm.culler(Finder::Grid, 1);
        (name, swarm, culler)
    });
    let mut rounds = [[0.0; ROUNDS]; KINDS.len()];
    for round in 0..ROUNDS {
        for ((_, swarm, culler), times) in racers.iter_mut().zip(&mut rounds) {
            times[round] = nanoseconds_a_pair(swarm, culler, frames);
        }
    }
    for ((name, _, culler), times) in racers.iter().zip(&rounds) {
        let ratios = times.iter().zip(&rounds[0]).map(|(time, one)| time / one);
        println!(
            "| {bodies} | {name} | {:.2} | {:.1} | {:.2} |",
            culler.pairs().len() as f64 / bodies as f64,
            median(times.to_vec()),
            median(ratios.collect()),
        );
    }
}

/// Of some frames.
fn nanoseconds_a_pair(swarm: &mut Swarm, culler: &mut Culler, frames: usize) -> f64 {
    let read = |culler: &Culler| (culler.seconds().total, culler.counters().reported);
    let before = read(culler);
    for _ in 0..frames {
        swarm.sway();
        culler.cull(&swarm.bodies).expect("bodies within the contract");
    }
    let after = read(culler);
    1e9 * (after.0 - before.0) / (after.1 - before.1) as f64
}
