//! The price of margins: frames of the paper's scene culled with and without them, in every tier.
//! `cargo bench --bench safety` prints a Markdown table.
//!
//! Margins are in the volumes, not in the tests. "No margins" is therefore the same culler on
//! volumes that are shrunk by the margins it will add, so that it tests the true ones to within a
//! bit or two. Only this measurement can do that, since it loses touching pairs. The two take
//! turns, and a ratio is of a round's warm frames.

mod common;

use sdop::bodies::Bodies;
use sdop::rounding::pose::norm;
use sdop::rounding::slab::{SLAB_FLOOR, SLAB_MARGIN};
use sdop::rounding::sphere::inflate_radius;
use sdop::settings::{CullSettings, Strategy};
use sdop::simd::Tier;
use sdop::volume::Shape;
use sdop_bench::measure::culling::Culling;
use sdop_bench::measure::turns::{Quartiles, Regime, Turns, median, turn_frames};

/// Rounds over all frames.
const ROUNDS: usize = 101;
/// Strategies with the volumes that [`without_margins`] shrinks: first one alone, then both.
/// Volumes that are refitted each frame get their margins in the frame.
const STRATEGIES: [Strategy; 2] = [Strategy::Sphere, Strategy::SDopSequential];

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

/// A shape whose volumes, with the margins that a culler adds, are those of `shape`.
fn without_margins(shape: &Shape) -> Shape {
    let mut bare = shape.clone();
    let radius = &mut bare.ball.radius;
    while *radius > 0.0 && inflate_radius(*radius) > shape.ball.radius {
        *radius = radius.next_down();
    }
    assert!(inflate_radius(radius.next_up()) > shape.ball.radius, "the largest such ball");
    let reach = f64::from(shape.reach) + norm(shape.ball.centre);
    let ordop = &mut bare.ordop;
    let coefficients = ordop.directions.coefficients().iter();
    for ((lo, hi), &c) in ordop.lo.iter_mut().zip(&mut ordop.hi).zip(coefficients) {
        let direction = ordop.basis.direction(c);
        let margin = norm(direction) * (SLAB_MARGIN * reach + SLAB_FLOOR);
        *lo = (f64::from(*lo) + margin) as f32;
        *hi = (f64::from(*hi) - margin) as f32;
    }
    bare
}
