//! Full S-DOP on the paper's 500 objects: a frame in every SIMD tier of this CPU, and in the plain
//! reference.
//!
//! `cargo bench --bench tiers` ends with a Markdown table of the medians and their ratios to the
//! reference.

mod common;

use std::cell::RefCell;
use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::Criterion;
use sdop::culler::Culler;
use sdop::simd::Tier;
use sdop_bench::measure::turns::median;
use sdop_judge::truth::{Shapes, reference_shapes};
use sdop_reference as reference;

/// Seconds an iteration, sample by sample.
type Samples = RefCell<Vec<f64>>;

/// Times `frame`, which is handed the iteration's number, and returns the median of the samples.
fn measure(criterion: &mut Criterion, name: &str, mut frame: impl FnMut(usize)) -> f64 {
    let samples = Samples::default();
    criterion.bench_function(name, |bencher| {
        bencher.iter_custom(|iterations| {
            let start = Instant::now();
            (0..iterations as usize).for_each(&mut frame);
            let elapsed: Duration = start.elapsed();
            samples.borrow_mut().push(elapsed.as_secs_f64() / iterations as f64);
            elapsed
        });
    });
    median(samples.into_inner())
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args().sample_size(30);
    let scene = common::scene("paper-500");
    let frames = common::frames(&scene);
    let mut rows = Vec::new();
    for tier in Tier::available() {
        let culler =
            Culler::builder().settings(&scene.cull).tier(tier).build(&scene.shapes, &scene.bodies);
        let mut culler = culler.unwrap_or_else(|error| panic!("{error}"));
        let seconds = measure(&mut criterion, &format!("s-dop, {tier}"), |i| {
            black_box(
                culler.cull(&frames[i % frames.len()]).expect("bodies within the contract").len(),
            );
        });
        rows.push((tier.name(), seconds));
    }
    let overlap = reference_shapes::overlap(scene.cull.overlap);
    let shapes = Shapes::new(scene.shapes.clone()).unwrap_or_else(|error| panic!("{error}"));
    let plain = measure(&mut criterion, "s-dop, reference", |i| {
        let bodies = shapes.bodies(&frames[i % frames.len()]);
        let bodies = bodies.unwrap_or_else(|error| panic!("{error}"));
        black_box(reference::pairs(&bodies, reference::Strategy::Sequential, overlap).len());
    });
    rows.push(("plain reference", plain));
    criterion.final_summary();
    println!(
        "\n| full S-DOP, {} bodies | µs a frame | reference over it |\n|---|---|---|",
        scene.bodies.len()
    );
    for (name, seconds) in rows {
        println!("| {name} | {:.1} | {:.0} |", 1e6 * seconds, plain / seconds);
    }
}
