//! F and Cv of the first test: finding pairs in the calibration scenes, an element a test. And the pair finders side by
//! side: update and finding, an element a body.
//!
//! Calibration scenes of one number of bodies differ in their box, and so in their hits: the difference prices a hit. The
//! finders' scenes have 1.5 sphere partners a body, which moves a tenth of the smallest radius a frame; a control loop tells
//! what a second thread can be worth on the machine at the time.

#![allow(clippy::unwrap_used, reason = "a bench without its scene can't go on")]

mod common;

use std::time::{Duration, Instant};

use criterion::measurement::WallTime;
use criterion::{
    BenchmarkGroup, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sdop::crew::Crew;
use sdop::mesh::shapes::ProceduralShape;
use sdop::pipeline::Culler;
use sdop::scene::bodies::Bodies;
use sdop::scene::settings::{CullSettings, Finder, Strategy};
use sdop::simd::Level;
use sdop::volume::{Shape, ShapeSpec};

fn pair_finding(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("pair finding");
    group.sample_size(20);
    let volumes: [common::Counted; 5] = [
        (Strategy::Sphere, |c| c.sphere.tests),
        (Strategy::OrDop, |c| c.ordop.tests),
        (Strategy::Aabb, |c| c.aabb.tests),
        (Strategy::KDop, |c| c.kdop.tests),
        (Strategy::Obb, |c| c.obb.tests),
    ];
    for (name, scene) in common::calibration_scenes() {
        for (strategy, count) in volumes {
            let id = BenchmarkId::new(strategy.name(), &name);
            common::stage(
                &mut group,
                id,
                (&scene, strategy),
                |s| s.pair_finding + s.ordop,
                count,
            );
        }
    }
}

/// Where bodies are, and how their radii spread.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Uniform,
    Plane,
    /// Ten clusters far apart.
    Clusters,
    /// Radii 1:16, log-uniform.
    Mixed,
    /// Radii 1:1000, log-uniform.
    Wild,
}

/// Bodies that sway about their homes.
struct Swarm {
    shapes: Vec<Shape>,
    bodies: Bodies,
    step: Vec<[f32; 3]>,
    frame: usize,
}

impl Swarm {
    fn new(kind: Kind, n: usize) -> Self {
        let octaves = match kind {
            Kind::Mixed => 4,
            Kind::Wild => 10,
            _ => 0,
        };
        let radii: Vec<f32> = (0..=8 * octaves)
            .map(|i| 2f32.powf(i as f32 / 8.0))
            .collect();
        let mesh = ProceduralShape::default_of("box").unwrap().build().unwrap();
        let shape = |&radius: &f32| {
            let radius = Some(radius);
            let spec = ShapeSpec {
                radius,
                ..ShapeSpec::default()
            };
            Shape::build(&mesh, &spec).unwrap()
        };
        let shapes: Vec<Shape> = radii.iter().map(shape).collect();
        // The mean of (r_a + r_b)³ over pairs, from the radii's moments.
        let moment = |p: i32| radii.iter().map(|r| r.powi(p)).sum::<f32>() / radii.len() as f32;
        let cubes = 2.0 * moment(3) + 6.0 * moment(1) * moment(2);
        let side = (n as f32 * 4.189 * cubes / 1.5).cbrt();
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        let (mut bodies, mut step) = (Bodies::default(), Vec::new());
        for i in 0..n {
            let mut at: [f32; 3] = std::array::from_fn(|_| rng.random_range(0.0..side));
            match kind {
                Kind::Plane => {
                    let side = (n as f32 * 12.57 / 1.5).sqrt();
                    at = [
                        rng.random_range(0.0..side),
                        3.0,
                        rng.random_range(0.0..side),
                    ];
                }
                Kind::Clusters => {
                    let centre = [3.0, 5.0, 7.0].map(|k| k * 10.0 * side * (i % 10) as f32);
                    at = std::array::from_fn(|k| centre[k] + 0.464 * at[k]);
                }
                Kind::Uniform | Kind::Mixed | Kind::Wild => {}
            }
            bodies.push(
                rng.random_range(0..radii.len() as u32),
                true,
                [0.0, 0.0, 0.0, 1.0],
                at,
            );
            step.push(std::array::from_fn(|_| rng.random_range(-0.1..0.1)));
        }
        Self {
            shapes,
            bodies,
            step,
            frame: 0,
        }
    }

    /// One more frame: sixteen to, sixteen fro.
    fn sway(&mut self) {
        let sign = if (self.frame / 16).is_multiple_of(2) {
            1.0
        } else {
            -1.0
        };
        for (t, step) in self.bodies.translation.iter_mut().zip(&self.step) {
            for (x, by) in t.iter_mut().zip(step) {
                *x += sign * by;
            }
        }
        self.frame += 1;
    }
}

fn bench_finder(
    group: &mut BenchmarkGroup<'_, WallTime>,
    (kind, n): (Kind, usize),
    finder: Finder,
    threads: usize,
) {
    let mut swarm = Swarm::new(kind, n);
    let settings = CullSettings {
        strategy: Strategy::Sphere,
        pairs: finder,
        ..CullSettings::default()
    };
    let culler = Culler::new(&swarm.shapes, &swarm.bodies, &settings, Level::detect()).unwrap();
    let mut culler = culler.with_threads(threads).unwrap();
    for _ in 0..64 {
        swarm.sway();
        culler.cull(&swarm.bodies);
    }
    group.throughput(Throughput::Elements(n as u64));
    let kind = format!("{kind:?}").to_lowercase();
    let id = BenchmarkId::new(format!("{finder}/{kind}"), format!("{n}/{threads}"));
    group.bench_function(id, |bencher| {
        bencher.iter_custom(|iterations| {
            let before = culler.seconds().total;
            for _ in 0..iterations {
                swarm.sway();
                culler.cull(&swarm.bodies);
            }
            Duration::from_secs_f64(culler.seconds().total - before)
        });
    });
}

/// Arithmetic without memory, shared by the same threads: the speed-up that the machine has to give.
fn bench_control(group: &mut BenchmarkGroup<'_, WallTime>, threads: usize) {
    const NUMBERS: usize = 1 << 17;
    let crew = Crew::new(threads).unwrap();
    let mut numbers = vec![1.0f32; NUMBERS];
    group.throughput(Throughput::Elements(NUMBERS as u64));
    group.bench_function(BenchmarkId::new("control", threads), |bencher| {
        bencher.iter_custom(|iterations| {
            let start = Instant::now();
            for _ in 0..iterations {
                crew.pieces(&mut numbers, 4096, |_, piece| {
                    for x in piece {
                        *x = (0..16).fold(*x, |x, _| x * 0.999 + 0.001);
                    }
                });
            }
            start.elapsed()
        });
    });
}

fn finders(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("finders");
    group.sample_size(10);
    group.measurement_time(Duration::from_secs(2));
    group.warm_up_time(Duration::from_millis(200));
    for (finder, most) in [
        (Finder::AllPairs, 1000),
        (Finder::Sweep, 10_000),
        (Finder::Grid, 1_000_000),
    ] {
        for n in [64, 500, 1000, 10_000, 100_000, 1_000_000] {
            if n <= most {
                bench_finder(&mut group, (Kind::Uniform, n), finder, 1);
            }
        }
    }
    for kind in [Kind::Plane, Kind::Clusters, Kind::Mixed, Kind::Wild] {
        bench_finder(&mut group, (kind, 10_000), Finder::Sweep, 1);
        for n in [1000, 10_000, 100_000] {
            bench_finder(&mut group, (kind, n), Finder::Grid, 1);
        }
    }
    for n in [100_000, 1_000_000] {
        bench_finder(&mut group, (Kind::Uniform, n), Finder::Grid, 2);
    }
    bench_control(&mut group, 1);
    bench_control(&mut group, 2);
}

criterion_group!(benches, pair_finding, finders);
criterion_main!(benches);
