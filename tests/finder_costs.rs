//! What pair finders cost apart from time: candidates beyond the output, memory, allocations in
//! steady state.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![allow(unsafe_code, reason = "an allocator that counts is an allocator")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sdop::bodies::Bodies;
use sdop::culler::Culler;
use sdop::mesh::shapes::ProceduralShape;
use sdop::settings::{Budget, CullSettings, Finder, Interest, Order, Strategy, Updates};
use sdop::volume::{Origin, Shape, ShapeSpec};

/// The system's allocator, counting what each thread asks of it: tests run side by side.
struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

fn count() {
    ALLOCATIONS.with(|count| count.set(count.get() + 1));
}

// SAFETY: the system's allocator does the work.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller vouches for the layout.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: the caller vouches for the memory and its layout.
        unsafe { System.dealloc(memory, layout) }
    }
    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: the caller vouches for the memory, its layout and the size.
        unsafe { System.realloc(memory, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

struct Scene {
    name: &'static str,
    shapes: Vec<Shape>,
    bodies: Bodies,
}

impl Scene {
    fn new(
        name: &'static str,
        radii: &[f32],
        n: usize,
        mut place: impl FnMut(usize, &mut ChaCha8Rng) -> (usize, [f32; 3]),
    ) -> Self {
        let mesh = ProceduralShape::default_of("box").unwrap().build().unwrap();
        let shape = |&radius: &f32| {
            let spec =
                ShapeSpec { origin: Origin::Ball, radius: Some(radius), ..ShapeSpec::default() };
            Shape::build(&mesh, &spec).unwrap()
        };
        let (mut rng, mut bodies) = (ChaCha8Rng::seed_from_u64(8), Bodies::default());
        for i in 0..n {
            let (shape, at) = place(i, &mut rng);
            bodies.push(shape as u32, i % 5 != 0, [0.0, 0.0, 0.0, 1.0], at);
        }
        Self { name, shapes: radii.iter().map(shape).collect(), bodies }
    }

    fn culler(&self, finder: Finder, strategy: Strategy) -> Culler {
        self.set(&CullSettings { strategy, pairs: finder, ..CullSettings::all_pairs() })
    }

    fn set(&self, settings: &CullSettings) -> Culler {
        Culler::builder().settings(settings).build(&self.shapes, &self.bodies).unwrap()
    }

    /// Moves every body to and fro by a tenth of the smallest radius.
    fn sway(&self, frame: usize, bodies: &mut Bodies) {
        let step = 0.1 * self.shapes[0].ball.radius;
        let now = self.bodies.translation.iter().zip(&mut bodies.translation);
        for (i, (home, t)) in now.enumerate() {
            let by = ((i + frame) % 16) as f32 - 8.0;
            for (axis, x) in t.iter_mut().enumerate() {
                let sign = if i >> axis & 1 == 0 { step } else { -step };
                *x = home[axis] + if bodies.dynamic[i] { sign * by.abs() } else { 0.0 };
            }
        }
    }
}

const N: usize = 4000;

fn cube(rng: &mut ChaCha8Rng, side: f32) -> [f32; 3] {
    std::array::from_fn(|_| rng.random_range(0.0..side))
}

/// 1.5 sphere partners per body, in arrangements that starve or crowd cells.
fn scenes() -> Vec<Scene> {
    let n = N as f32;
    let wide: Vec<f32> = (0..=20).map(|i| 1e-3 * 2f32.powf(0.5 * i as f32)).collect();
    vec![
        Scene::new("cube", &[1.0], N, |_, rng| (0, cube(rng, 44.7))),
        Scene::new("plane", &[1.0], N, |_, rng| {
            let [x, _, z] = cube(rng, (n * 8.4).sqrt());
            (0, [x, 5.0, z])
        }),
        Scene::new("slanted plane", &[1.0], N, |_, rng| {
            let [x, y, _] = cube(rng, (n * 6.0).sqrt());
            (0, [x, y, x + 0.3 * y])
        }),
        Scene::new("line", &[1.0], N, |_, rng| (0, [1.0, rng.random_range(0.0..n * 2.7), 2.0])),
        Scene::new("diagonal", &[1.0], N, |_, rng| (0, [rng.random_range(0.0..n * 1.5); 3])),
        Scene::new("clusters far apart", &[1.0], N, |i, rng| {
            let by = cube(rng, 21.0);
            let centre = [3e4, -1e4, 7e4].map(|x: f32| x * (i % 10) as f32);
            (0, std::array::from_fn(|k| centre[k] + by[k]))
        }),
        Scene::new("one far away", &[1.0], N, |i, rng| match i {
            7 => (0, [1e7; 3]),
            _ => (0, cube(rng, 44.7)),
        }),
        Scene::new("a giant", &[0.05, 100.0], N, |i, rng| match i {
            7 => (1, [1.0; 3]),
            _ => (0, cube(rng, 2.2)),
        }),
        Scene::new("radii 1:1000", &wide, N, |i, rng| (i % 21, cube(rng, 8.0))),
        Scene::new("coincident", &[1.0], N / 20, |_, _| (0, [3.0; 3])),
    ]
}

/// The same, and one in which lists change the kind of their skin: the small move by their own
/// radii, and most pairs are the wide ones'.
fn scenes_with_wide_bodies() -> impl Iterator<Item = Scene> {
    let radii = [0.25, 0.5, 1.0, 2.0, 4.0];
    let wide = Scene::new("radii 1:16", &radii, N, |i, rng| (i % 5, cube(rng, 91.6)));
    scenes().into_iter().chain([wide])
}

/// The grid tests few candidates beyond its output.
#[test]
fn grid_has_few_candidates() {
    for scene in scenes() {
        let mut culler = scene.culler(Finder::Grid, Strategy::Sphere);
        let mut bodies = scene.bodies.clone();
        for frame in 0..24 {
            scene.sway(frame, &mut bodies);
            culler.cull(&bodies).unwrap();
        }
        let before = culler.counters().sphere;
        culler.cull(&bodies).unwrap();
        let after = culler.counters().sphere;
        let tests = after.tests - before.tests;
        // A cube needs 6 per body, half of them for the 27 cells around it; 1:1000 searches levels.
        let needed = (bodies.len() + culler.pairs().len()) as u64;
        assert!(
            tests <= 12 * needed,
            "{}: {tests} tests, {} pairs",
            scene.name,
            culler.pairs().len()
        );
    }
}

/// No finder uses a hundred bytes per body.
#[test]
fn finders_use_under_100_bytes() {
    for scene in scenes_with_wide_bodies() {
        for &finder in Finder::ALL {
            let mut culler = scene.culler(finder, Strategy::Sphere);
            let mut bodies = scene.bodies.clone();
            for frame in 0..4 {
                scene.sway(frame, &mut bodies);
                culler.cull(&bodies).unwrap();
            }
            // A few kilobytes are there for any scene.
            let bytes = culler.finder_bytes();
            let each = bytes.saturating_sub(8192) / bodies.len();
            assert!(each <= 100, "{}, {finder}: {each} bytes a body", scene.name);
            assert!(bytes >= 16 * bodies.len(), "{finder} holds its bodies' balls");
        }
    }
}

/// Asserts that, once places have taken a new order twice (each 32 frames), frames allocate
/// nothing.
fn assert_steady(scene: &Scene, mut culler: Culler, what: &str) {
    let mut bodies = scene.bodies.clone();
    for frame in 0..140 {
        scene.sway(frame, &mut bodies);
        let before = ALLOCATIONS.get();
        culler.cull(&bodies).unwrap();
        let more = ALLOCATIONS.get() - before;
        let name = scene.name;
        assert!(frame < 72 || more == 0, "{name}, {what}: frame {frame}");
    }
}

#[test]
fn in_steady_state_nothing_is_allocated() {
    for scene in scenes_with_wide_bodies() {
        // All-pairs allocates as little as any and takes longer by far; strategies have a test of
        // their own.
        for &finder in Finder::ALL.iter().filter(|f| **f != Finder::AllPairs) {
            for strategy in [Strategy::SDopSequential, Strategy::Aabb] {
                let what = format!("{strategy}, {finder}");
                assert_steady(&scene, scene.culler(finder, strategy), &what);
            }
        }
    }
}

#[test]
fn no_strategy_allocates_in_steady_state() {
    let scene = &scenes()[0];
    for &strategy in Strategy::ALL {
        for &updates in Updates::ALL {
            for &order in Order::ALL {
                let culler = scene.set(&CullSettings {
                    strategy,
                    pairs: Finder::Grid,
                    updates,
                    order,
                    interest: Some(Interest::Bodies((0..1000).collect())),
                    budget: Some(Budget::Tests(1500)),
                    ..CullSettings::all_pairs()
                });
                assert_steady(scene, culler, &format!("{strategy}, {updates}, {order}"));
                if strategy != Strategy::SDopTimeCritical {
                    break; // the order is of no other strategy's concern
                }
            }
        }
    }
}

#[test]
fn the_counter_counts() {
    let before = ALLOCATIONS.get();
    drop(std::hint::black_box(vec![1u8; 100]));
    assert_eq!(ALLOCATIONS.get() - before, 1);
}
