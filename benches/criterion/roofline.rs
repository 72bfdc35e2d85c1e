//! How close each kernel comes to the CPU's limits. `cargo bench --bench roofline` prints a
//! Markdown table.
//!
//! The limits are measured in the same run: vector operations per nanosecond with all data in
//! registers, and bytes per nanosecond from a column that fits into no cache. A kernel's work is
//! counted from its source: f32 operations on the longest path (without early exit or padding
//! lanes), and bytes of the columns that it has to read or write once. The least possible time is
//! the larger of the two works over their limits; the share is that over the measured time.

mod common;

use std::hint::black_box;
use std::time::Instant;

use sdop::counters::{Counters, Seconds};
use sdop::culler::Culler;
use sdop::settings::{CullSettings, Finder, Strategy};
use sdop::simd::{Kernel, Lanes, Tier, dispatch};
use sdop_bench::measure::turns::median;
use sdop_bench::scene::Scene;

/// Samples of every measurement.
const SAMPLES: usize = 15;

/// A kernel's work per element, and where it is measured.
struct Work {
    name: &'static str,
    /// f32 operations.
    operations: f64,
    /// Bytes from and to memory.
    bytes: f64,
    scene: &'static str,
    culling: (Strategy, Finder),
    stage: Stage,
}

/// What of a frame is a kernel's own.
#[derive(Clone, Copy)]
enum Stage {
    /// Pair finding, a sphere test.
    Spheres,
    /// The or-DOP test.
    OrDops,
    /// Update and pair finding, a body.
    Finding,
}

impl Stage {
    /// Seconds and elements so far.
    fn read(self, seconds: &Seconds, counters: &Counters) -> (f64, u64) {
        match self {
            Self::Spheres => (seconds.pair_finding, counters.sphere.tests),
            Self::OrDops => (seconds.ordop, counters.ordop.tests),
            Self::Finding => (seconds.update + seconds.pair_finding, counters.sphere.updates),
        }
    }
}

/// Relating two frames, one body's nine normals, and half of the pairs going on to the second's.
const ORDOP_OPERATIONS: f64 = 87.0 + 1.5 * 456.0;
const S_DOP: (Strategy, Finder) = (Strategy::SDopBatch, Finder::Grid);

/// Counted from `overlap/sphere.rs`, `overlap/ordop/` and `update/`.
const KERNELS: [Work; 4] = [
    Work {
        name: "sphere test, a run of slots",
        operations: 11.0,
        bytes: 0.0,
        scene: "paper-500",
        culling: (Strategy::Sphere, Finder::AllPairs),
        stage: Stage::Spheres,
    },
    Work {
        name: "or-DOP test, k = 18, two-sided",
        operations: ORDOP_OPERATIONS,
        bytes: 0.0,
        scene: "paper-500",
        culling: S_DOP,
        stage: Stage::OrDops,
    },
    Work {
        name: "or-DOP test, among a million bodies",
        operations: ORDOP_OPERATIONS,
        bytes: 128.0,
        scene: "uniform-1m",
        culling: S_DOP,
        stage: Stage::OrDops,
    },
    Work {
        name: "spheres of a million bodies found",
        operations: 0.0,
        // Ball in and out of the update, in and out of the sort, in again by the pairs; name and
        // cell each way.
        bytes: 5.0 * 16.0 + 4.0 * 4.0,
        scene: "uniform-1m",
        culling: (Strategy::Sphere, Finder::Grid),
        stage: Stage::Finding,
    },
];

fn main() {
    let tier = Tier::detect();
    let (operations, bytes) = (operations_a_nanosecond(tier), bytes_a_nanosecond());
    println!("{tier}: {operations:.0} f32 operations and {bytes:.1} bytes a nanosecond at most\n");
    println!("| kernel | operations | bytes | floor, ns | measured, ns | share |");
    println!("|---|---:|---:|---:|---:|---:|");
    let mut loaded: Option<(&str, Scene)> = None;
    for work in KERNELS {
        if loaded.as_ref().is_none_or(|(name, _)| *name != work.scene) {
            loaded = Some((work.scene, common::scene(work.scene)));
        }
        let Some((_, scene)) = &loaded else { continue };
        let measured = nanoseconds(&work, scene, tier);
        let floor = (work.operations / operations).max(work.bytes / bytes);
        println!(
            "| {} | {:.0} | {:.0} | {floor:.2} | {measured:.2} | {:.0} % |",
            work.name,
            work.operations,
            work.bytes,
            100.0 * floor / measured
        );
    }
}

/// The median over samples of a stage's time an element.
fn nanoseconds(work: &Work, scene: &Scene, tier: Tier) -> f64 {
    let (strategy, pairs) = work.culling;
    let settings = CullSettings { strategy, pairs, ..scene.cull.clone() };
    let mut culler = match Culler::builder()
        .settings(&settings)
        .tier(tier)
        .build(&scene.shapes, &scene.bodies)
    {
        Ok(culler) => culler,
        Err(error) => panic!("{error}"),
    };
    let frames = (2_000_000 / scene.bodies.len()).clamp(1, 200);
    let read = |culler: &Culler| work.stage.read(culler.seconds(), culler.counters());
    let mut sample = || {
        let before = read(&culler);
        for _ in 0..frames {
            black_box(culler.cull(&scene.bodies).expect("bodies within the contract"));
        }
        let after = read(&culler);
        1e9 * (after.0 - before.0) / (after.1 - before.1) as f64
    };
    sample(); // caches, buffers
    median((0..SAMPLES).map(|_| sample()).collect())
}

/// Multiplications and additions in equal parts, on sixteen vectors that don't wait for one
/// another.
fn operations_a_nanosecond(tier: Tier) -> f64 {
    struct Spin;
    impl Kernel for Spin {
        type Output = f64;
        #[inline(always)]
        fn run<L: Lanes>(self, l: L) -> f64 {
            const ROUNDS: usize = 1_000_000;
            let (half, one) = (l.splat(0.5), l.splat(1.0));
            let mut chains = [l.splat(0.0); 16];
            let start = Instant::now();
            for _ in 0..ROUNDS {
                for chain in &mut chains {
                    *chain = *chain * half + one;
                }
            }
            let elapsed = start.elapsed().as_secs_f64();
            black_box(chains.map(|chain| l.bits(l.gt(chain, one))));
            (ROUNDS * chains.len() * 2 * L::WIDTH) as f64 / (1e9 * elapsed)
        }
    }
    median((0..SAMPLES).map(|_| dispatch(tier, Spin)).collect())
}

/// Reading a column of 256 MiB from end to end.
fn bytes_a_nanosecond() -> f64 {
    let column = vec![1u64; 32 << 20];
    let sample = || {
        let start = Instant::now();
        black_box(column.iter().fold(0, |sum: u64, x| sum.wrapping_add(*x)));
        8.0 * column.len() as f64 / (1e9 * start.elapsed().as_secs_f64())
    };
    median((0..SAMPLES).map(|_| sample()).collect())
}
