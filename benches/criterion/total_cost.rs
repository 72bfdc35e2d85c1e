//! The paper's formula: Co, Cu, F and Cv of hits and misses from calibration scenes, whole frames
//! of other scenes, and at the end the predicted and measured time and the residual of every
//! strategy.
//!
//! An iteration is a pass, as in `sdop cost`, with another seed each time. Criterion shows the mean
//! seconds per frame of every strategy. `cargo bench --bench total_cost` takes two minutes.

mod common;

use std::time::Duration;

use criterion::{BenchmarkId, Criterion, SamplingMode, criterion_group, criterion_main};
use sdop::simd::Tier;
use sdop_bench::cost::calibrate::{Calibration, Effort};
use sdop_bench::cost::pass::{Pass, SceneFrames, pass};
use sdop_bench::cost::study::possible;
use sdop_bench::cost::table::{Cost, PriceRow, cost, prices};
use sdop_bench::measure::turns::Regime;
use sdop_bench::measure::variant::Variant;
use sdop_bench::scene::SceneFile;

/// What is predicted. They have the same shapes, and bodies for the same cache: one set of prices.
const SCENES: [&str; 3] = ["paper-300", "paper-500", "crowded-500"];
/// Frames per pass.
const FRAMES: u32 = 96;
const EFFORT: Effort = Effort { turns: 1, builds: 5 };

fn total_cost(criterion: &mut Criterion) {
    let mut scenes = Vec::new();
    for name in SCENES {
        let mut file = common::scene_file(name);
        let scene = file.build().unwrap_or_else(|error| panic!("{error}"));
        let strategies = possible(&scene).into_iter();
        let variants: Vec<Variant> =
            strategies.map(|strategy| Variant::strategy(&scene.cull, strategy)).collect();
        let mut calibration = Calibration::new(&scene, &variants, Tier::detect(), EFFORT)
            .unwrap_or_else(|error| panic!("{error}"));
        let mut passes: Vec<Pass> = Vec::new();
        let mut group = criterion.benchmark_group("total cost");
        // Durations are of single frames, and a pass has a hundred after a round of calibration.
        group
            .sampling_mode(SamplingMode::Flat)
            .sample_size(10)
            .warm_up_time(Duration::from_micros(200))
            .measurement_time(Duration::from_millis(1));
        group.bench_function(BenchmarkId::from_parameter(name), |bencher| {
            bencher.iter_custom(|iterations| {
                let mut seconds = 0.0;
                for _ in 0..iterations {
                    file.spec.seed += 1;
                    let pass = another_pass(&file, &variants, &mut calibration);
                    let culled = pass.culled.iter();
                    seconds += culled.map(|culled| culled.times.mean()).sum::<f64>();
                    passes.push(pass);
                }
                Duration::from_secs_f64(seconds)
            });
        });
        group.finish();
        scenes.push((scene, variants, passes));
    }
    let priced: Vec<&Pass> = scenes.iter().flat_map(|(.., passes)| passes).collect();
    println!("\nPrices for warm frames, ns (Co: ms); ± is a 95 % interval over rounds\n");
    println!(
        "| strategy | volume | cache | Co | Cu | F per frame | per body | per body with hits \
         | per listed pair | Cv hit | miss | further slab |"
    );
    println!("|---|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|");
    for price in prices(&priced, Regime::Warm) {
        println!("{}", price_line(&price));
    }
    println!("\nWarm frames, Nu·Cu + F + Nv·Cv; ± is a 95 % interval over passes\n");
    println!("| scene | strategy | predicted µs | measured µs | residual % | what fails |");
    println!("|---|---|--:|--:|--:|---|");
    for (scene, variants, passes) in &scenes {
        let passes: Vec<&Pass> = passes.iter().collect();
        for of in variants.iter().enumerate() {
            let scene = (&scene.name[..], scene.bodies.len());
            let cost = cost(scene, of, (&passes, &priced), Regime::Warm);
            println!("{}", cost.as_ref().map_or_else(String::new, line));
        }
    }
}

fn another_pass(file: &SceneFile, variants: &[Variant], calibration: &mut Calibration) -> Pass {
    let mut made = || -> miette::Result<Pass> {
        let scene = file.build()?;
        let mut frames = SceneFrames::new(&scene, FRAMES)?;
        let calibration = Some(calibration.round()?);
        Ok(pass(&scene, variants, Tier::detect(), &mut frames, calibration, &mut ())?)
    };
    made().unwrap_or_else(|error| panic!("{error}"))
}

fn price_line(price: &PriceRow) -> String {
    let number = |key: &str, unit: f64| {
        let of = price.prices.get(key).map(|estimate| estimate.scaled(unit));
        of.map_or_else(String::new, |of| format!("{:.2} ± {:.2}", of.mean, of.half_width))
    };
    let level = price.level.map_or("", |level| level.name());
    let keys = ["update", "frame", "body", "row", "handle", "hit", "miss", "further"];
    let ns = keys.map(|key| number(key, 1e9));
    let (variant, volume) = (&price.variant, price.volume);
    let construct = number("construct", 1e3);
    format!("| {variant} | {volume} | {level} | {construct} | {} |", ns.join(" | "))
}

fn line(cost: &Cost) -> String {
    let fails = cost.fails.map_or("", |assumption| assumption.name());
    format!(
        "| {} | {} | {:.2} | {:.2} ± {:.2} | {:+.1} ± {:.1} | {fails} |",
        cost.scene,
        cost.variant,
        1e6 * cost.frame.predicted.mean,
        1e6 * cost.frame.measured.mean,
        1e6 * cost.frame.measured.half_width,
        100.0 * cost.frame.residual.mean,
        100.0 * cost.frame.residual.half_width,
    )
}

criterion_group!(benches, total_cost);
criterion_main!(benches);
