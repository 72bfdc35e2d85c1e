//! The long search for a pair that a finder loses on a border between cells: `cargo bench --bench
//! finder_borders -- SCENES`.
//!
//! Runs one search per thread, each with its own seeds, over the scenes of
//! `sdop_judge::draw::borders`. Prints a Markdown table, and fails if a finder's list differs from
//! that of all pairs or a finder panics.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sdop::simd::Tier;
use sdop_judge::draw::borders::{Borders, bar};

/// The default number of scenes.
const SCENES: u64 = 1_000_000;

#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    scenes: u64,
    divides: u64,
    pairs: u64,
    missed: u64,
    surplus: u64,
    panicked: u64,
}

fn search(seed: u64, scenes: u64) -> Tally {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let (settings, tiers) = (Borders::settings(), Tier::available());
    let mut tally = Tally::default();
    for n in 0..scenes {
        let scene = Borders::draw(&mut |below| rng.random_range(0..below));
        let shapes = scene.radii.map(|r| bar(r).expect("within the contract"));
        let tier = tiers[n as usize % tiers.len()];
        let frames = if n % 16 == 0 { 6 } else { 1 };
        let judge = || scene.judge(&shapes, &settings, tier, frames);
        tally.scenes += 1;
        tally.divides += u64::from(scene.divides);
        match catch_unwind(AssertUnwindSafe(judge)) {
            Ok(judged) => {
                let (pairs, difference) = judged.expect("the strategy needs nothing");
                tally.pairs += pairs as u64;
                if let Some(difference) = difference {
                    tally.missed += u64::from(!difference.lost.is_empty());
                    tally.surplus += u64::from(difference.surplus > 0);
                }
            }
            Err(_) => tally.panicked += 1,
        }
    }
    tally
}

fn main() -> ExitCode {
    let scenes = std::env::args().find_map(|arg| arg.parse().ok());
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get() as u64);
    let each = scenes.unwrap_or(SCENES).div_ceil(threads);
    std::panic::set_hook(Box::new(|_| {}));
    let sum = std::thread::scope(|scope| {
        let searches: Vec<_> =
            (1..=threads).map(|seed| scope.spawn(move || search(seed, each))).collect();
        let tallies = searches.into_iter().map(|search| search.join());
        tallies.fold(Tally::default(), |sum, tally| {
            let tally = tally.expect("panics are caught");
            Tally {
                scenes: sum.scenes + tally.scenes,
                divides: sum.divides + tally.divides,
                pairs: sum.pairs + tally.pairs,
                missed: sum.missed + tally.missed,
                surplus: sum.surplus + tally.surplus,
                panicked: sum.panicked + tally.panicked,
            }
        })
    });
    println!(
        "| scenes | a division would count other cells in | pairs | scenes that lose a pair | that have one too many | panics |"
    );
    println!("|--:|--:|--:|--:|--:|--:|");
    println!(
        "| {} | {} | {} | {} | {} | {} |",
        sum.scenes, sum.divides, sum.pairs, sum.missed, sum.surplus, sum.panicked
    );
    match sum.missed + sum.surplus + sum.panicked {
        0 => ExitCode::SUCCESS,
        _ => ExitCode::FAILURE,
    }
}
