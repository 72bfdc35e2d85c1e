//! The price of safety: frames of the paper's scene culled with margins and without, in every tier. `cargo bench --bench
//! safety` prints a Markdown table.
//!
//! The two take turns frame by frame, either first every other time, and a ratio is of a round's times. `sdop tradeoff`
//! counts the extra pairs.

mod common;

use std::hint::black_box;
use std::time::Instant;

use sdop::bodies::Bodies;
use sdop::culler::Culler;
use sdop::lab::measure::turns::median;
use sdop::lab::tradeoff::safety::without_margins;
use sdop::settings::{CullSettings, Strategy};
use sdop::simd::Tier;

/// Rounds over all frames.
const ROUNDS: usize = 101;

fn main() {
    let scene = common::scene("paper-500");
    let frames = common::frames(&scene);
    let bare: Vec<_> = scene.shapes.iter().map(without_margins).collect();
    println!("| strategy | tier | µs a frame with margins | without | ratio | quartiles |");
    println!("|---|---|--:|--:|--:|---|");
    for strategy in [Strategy::Sphere, Strategy::SDopSequential] {
        let settings = CullSettings {
            strategy,
            ..scene.cull.clone()
        };
        for tier in Tier::available() {
            let cullers = [&scene.shapes, &bare].map(|shapes| {
                Culler::new(shapes, &scene.bodies, &settings, tier)
                    .unwrap_or_else(|error| panic!("{error}"))
            });
            let [on, off, ratios] = compare(cullers, &frames);
            let quartile = |q: usize| ratios[ratios.len() * q / 4];
            println!(
                "| {strategy} | {tier} | {:.1} | {:.1} | {:.4} | {:.3} to {:.3} |",
                1e6 * median(on),
                1e6 * median(off),
                quartile(2),
                quartile(1),
                quartile(3)
            );
        }
    }
}

/// Seconds a frame with margins, without, and their ratios in ascending order, round by round.
fn compare(mut cullers: [Culler; 2], frames: &[Bodies]) -> [Vec<f64>; 3] {
    let mut seconds = [vec![], vec![]];
    for round in 0..=ROUNDS {
        let mut sums = [0.0; 2];
        for (i, bodies) in frames.iter().enumerate() {
            for turn in 0..2 {
                let who = (turn + i + round) % 2;
                let start = Instant::now();
                black_box(cullers[who].cull(bodies).len());
                sums[who] += start.elapsed().as_secs_f64();
            }
        }
        if round > 0 {
            let a_frame = sums.map(|sum| sum / frames.len() as f64);
            (seconds.iter_mut().zip(a_frame)).for_each(|(all, one)| all.push(one));
        }
    }
    let [on, off] = seconds;
    let mut ratios: Vec<f64> = on.iter().zip(&off).map(|(on, off)| on / off).collect();
    ratios.sort_by(f64::total_cmp);
    [on, off, ratios]
}
