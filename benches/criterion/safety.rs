//! The price of margins: frames of the paper's scene culled with and without them, in every tier.
//! `cargo bench --bench safety` prints a Markdown table.
//!
//! The two take turns, and a ratio is of a round's warm frames. `sdop tradeoff` counts the extra
//! pairs.

mod common;

use sdop::bodies::Bodies;
use sdop::settings::CullSettings;
use sdop::simd::Tier;
use sdop_bench::measure::culling::Culling;
use sdop_bench::measure::turns::{Quartiles, Regime, Turns, median, turn_frames};
use sdop_bench::tradeoff::safety::{STRATEGIES, without_margins};

/// Rounds over all frames.
const ROUNDS: usize = 101;

fn main() {
    let scene = common::scene("paper-500");
    let frames = common::frames(&scene);
    let bare: Vec<_> = scene.shapes.iter().map(without_margins).collect();
    println!("| strategy | tier | µs a frame with margins | without | ratio | quartiles |");
    println!("|---|---|--:|--:|--:|---|");
    for strategy in STRATEGIES {
        let settings = CullSettings { strategy, ..scene.cull.clone() };
        for tier in Tier::available() {
            let cullers = [&scene.shapes, &bare].map(|shapes| {
                Culling::new(shapes, &scene.bodies, &settings, tier)
                    .unwrap_or_else(|error| panic!("{error}"))
            });
            let [on, off, ratios] = compare(cullers, &frames);
            let ratios = Quartiles::of(ratios);
            println!(
                "| {strategy} | {tier} | {:.1} | {:.1} | {:.4} | {:.3} to {:.3} |",
                1e6 * median(on),
                1e6 * median(off),
                ratios.median,
                ratios.low,
                ratios.high
            );
        }
    }
}

/// Seconds per warm frame with margins, without, and their ratios, round by round.
fn compare(mut cullers: [Culling; 2], frames: &[Bodies]) -> [Vec<f64>; 3] {
    let (mut turns, mut seconds) = (Turns::default(), [vec![], vec![]]);
    for round in 0..=ROUNDS {
        let mut warm = [vec![], vec![]];
        for poses in frames.chunks(turn_frames(frames[0].len())) {
            turns.round(&mut cullers, poses, |timed| {
                if timed.regime == Regime::Warm {
                    warm[timed.number].push(timed.seconds);
                }
            });
        }
        if round > 0 {
            let medians = warm.map(median);
            (seconds.iter_mut().zip(medians)).for_each(|(all, one)| all.push(one));
        }
    }
    let [on, off] = seconds;
    let ratios = on.iter().zip(&off).map(|(on, off)| on / off).collect();
    [on, off, ratios]
}
