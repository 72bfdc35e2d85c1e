//! The paper's formula: Co, Cu, F and Cv of hits and misses from calibration scenes, whole frames
//! with another seed, and at the end the predicted and measured time and the residual of every
//! strategy.
//!
//! An iteration is a pass, as in `sdop cost`, with another seed each time. Criterion shows the mean
//! seconds per frame. `cargo bench --bench total_cost` takes a few minutes.

mod common;

use std::time::Duration;

use criterion::{BenchmarkId, Criterion, SamplingMode, criterion_group, criterion_main};
use sdop::simd::Tier;
use sdop_bench::cost::calibrate::{Calibration, Effort};
use sdop_bench::cost::pass::{Pass, Simulated, pass};
use sdop_bench::cost::study::possible;
use sdop_bench::cost::table::{cost, prices};
use sdop_bench::measure::turns::Regime;
use sdop_bench::measure::variant::Variant;
use sdop_bench::scene::SceneFile;

/// What is predicted; calibration scenes have other numbers of bodies and other boxes.
const SCENES: [&str; 3] = ["paper-300", "paper-500", "crowded-500"];
/// Frames per pass.
const FRAMES: u32 = 96;
const EFFORT: Effort = Effort {
    turns: 1,
    builds: 5,
};

fn total_cost(criterion: &mut Criterion) {
    let mut lines = Vec::new();
    for name in SCENES {
        let mut file = common::scene_file(name);
        let scene = file.build().unwrap_or_else(|error| panic!("{error}"));
        for strategy in possible(&scene) {
            let variant = Variant::strategy(&scene.cull, strategy);
            let variants = std::slice::from_ref(&variant);
            let mut calibration = Calibration::new(&scene, variants, Tier::detect(), EFFORT)
                .unwrap_or_else(|error| panic!("{error}"));
            let mut passes: Vec<Pass> = Vec::new();
            let mut group = criterion.benchmark_group("total cost");
            // Durations are of single frames, and a pass has a hundred with as many again of
            // calibration.
            group
                .sampling_mode(SamplingMode::Flat)
                .sample_size(10)
                .warm_up_time(Duration::from_micros(200))
                .measurement_time(Duration::from_millis(1));
            group.bench_function(BenchmarkId::new(name, strategy), |bencher| {
                bencher.iter_custom(|iterations| {
                    let mut seconds = 0.0;
                    for _ in 0..iterations {
                        file.spec.seed += 1;
                        let pass = another_pass(&file, variants, &mut calibration);
                        seconds += pass.culled[0].times.mean();
                        passes.push(pass);
                    }
                    Duration::from_secs_f64(seconds)
                });
            });
            group.finish();
            lines.extend(line(&scene.name, scene.bodies.len(), &variant, &passes));
        }
    }
    println!("\nWarm frames, T = Co + Nu·Cu + F + Nv·Cv; ± is a 95 % interval over passes\n");
    println!(
        "| scene | strategy | Co ms | Cu ns | F ns per frame | per body | per listed pair | Cv hit ns | miss ns \
         | predicted µs | measured µs | residual % |"
    );
    println!("|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|");
    lines.iter().for_each(|line| println!("{line}"));
}

fn another_pass(file: &SceneFile, variants: &[Variant], calibration: &mut Calibration) -> Pass {
    let made = || -> miette::Result<Pass> {
        let scene = file.build()?;
        let mut frames = Simulated::new(&scene, FRAMES)?;
        let calibration = Some(calibration);
        Ok(pass(
            &scene,
            variants,
            Tier::detect(),
            &mut frames,
            calibration,
            &mut (),
        )?)
    };
    made().unwrap_or_else(|error| panic!("{error}"))
}

fn line(scene: &str, bodies: usize, variant: &Variant, passes: &[Pass]) -> Option<String> {
    let passes: Vec<&Pass> = passes.iter().collect();
    let cost = cost((scene, bodies), (0, variant), &passes, Regime::Warm)?;
    let prices = prices(&passes, Regime::Warm);
    let joined = |price: &dyn Fn(usize) -> f64| {
        let volumes = (0..prices.len()).map(|at| format!("{:.2}", price(at)));
        volumes.collect::<Vec<_>>().join(" + ")
    };
    Some(format!(
        "| {scene} | {} | {} | {} | {} | {} | {} | {} | {} | {:.2} | {:.2} ± {:.2} | {:+.1} ± {:.1} |",
        variant.name,
        joined(&|at| 1e3 * prices[at].construct.mean),
        joined(&|at| 1e9 * prices[at].update.mean),
        joined(&|at| 1e9 * prices[at].frame.mean),
        joined(&|at| 1e9 * prices[at].body.mean),
        joined(&|at| 1e9 * prices[at].handle.mean),
        joined(&|at| 1e9 * prices[at].hit.mean),
        joined(&|at| 1e9 * prices[at].miss.mean),
        1e6 * cost.frame.predicted.mean,
        1e6 * cost.frame.measured.mean,
        1e6 * cost.frame.measured.half_width,
        100.0 * cost.frame.residual.mean,
        100.0 * cost.frame.residual.half_width,
    ))
}

criterion_group!(benches, total_cost);
criterion_main!(benches);
