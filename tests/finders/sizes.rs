//! The cost of frames for bodies of any size: no list of neighbours is searched for if the skin's
//! floor exceeds the bodies' size.

use sdop::bodies::Bodies;
use sdop::mesh::shapes::ProceduralShape;
use sdop::volume::{Origin, Shape, ShapeSpec};
use sdop::{Aabb, BoxCuller, Culler, Finder, Strategy};
use sdop_judge::draw::random::Random;

/// Frames: the first ones, and those in which lists are tried again.
const FRAMES: usize = 20;
const N: usize = 420;

/// Sizes are powers of two with these exponents, closely where floors are.
fn exponents() -> impl Iterator<Item = i32> {
    let floors = (-82..-50).step_by(2);
    let others = (-140..59).filter(|e| e % 13 == 0);
    floors.chain(others).chain([-140, 59])
}

/// How radii are mixed: all alike, every fifth one of ordinary size, and every third one a speck.
const MIXES: [(&str, [i32; 15]); 3] = [
    ("uniform", [0; 15]),
    ("some wide", [0, 0, 0, 0, 50, 0, 0, 0, 0, 50, 0, 0, 0, 0, 50]),
    ("some specks", [0, 0, -80, 1, 0, -90, 2, 0, -20, 3, 0, -70, 0, 0, -80]),
];

/// Positions of bodies, two radii of the ordinary size apart in the mean. `frame` moves them, and
/// every eighth one shuffles them.
fn placed(exponent: i32, frame: usize) -> Vec<[f32; 3]> {
    let (mut still, mut moved) = (Random::new(7 + (frame / 8) as u64), Random::new(frame as u64));
    let side = 2.0 * (N as f64).cbrt();
    let size = 2f64.powi(exponent);
    // Within the contract, whatever the size.
    let most = 2f64.powi(60);
    (0..N)
        .map(|_| [0; 3].map(|_| f64::from(still.unit()) * side + 0.03 * f64::from(moved.unit())))
        .map(|at| at.map(|x| (x * size).min(most) as f32))
        .collect()
}

/// The exponent of a body's radius.
fn radius(exponent: i32, mix: &[i32; 15], body: usize) -> i32 {
    (exponent + mix[body % 15]).clamp(-148, 59)
}

/// Holds the tests of a frame against those of the grid.
fn assert_bounded(what: &str, frame: usize, tests: u64, of_grid: u64) {
    let most = 4 * of_grid + 64 * N as u64;
    assert!(tests <= most, "{what}, frame {frame}: {tests} tests, {of_grid} by the grid");
}

fn shapes(mix: &[i32; 15], exponent: i32) -> Vec<Shape> {
    let mesh = ProceduralShape::default_of("box").unwrap().build().unwrap();
    let shape = |body| {
        let spec = ShapeSpec {
            radius: Some(2f64.powi(radius(exponent, mix, body)) as f32),
            origin: Origin::Ball,
            ..ShapeSpec::default()
        };
        Shape::build(&mesh, &spec).unwrap()
    };
    (0..15).map(shape).collect()
}

fn cullers_are_bounded(strategy: Strategy) {
    for (mix_name, mix) in MIXES {
        for exponent in exponents() {
            let (shapes, mut bodies) = (shapes(&mix, exponent), Bodies::default());
            for (body, &t) in placed(exponent, 0).iter().enumerate() {
                let shape = (body % 15) as u32;
                bodies.push(shape, body % 7 != 0, [0.0, 0.0, 0.0, 1.0], t);
            }
            let of = |finder| Culler::builder().strategy(strategy).finder(finder);
            let [mut grid, mut auto] = [Finder::Grid, Finder::Auto]
                .map(|finder| of(finder).build(&shapes, &bodies).unwrap());
            let mut before = [0; 2];
            for frame in 0..FRAMES {
                for (body, t) in placed(exponent, frame).into_iter().enumerate() {
                    if bodies.dynamic[body] {
                        bodies.translation[body] = t;
                    }
                }
                let all = grid.cull(&bodies).unwrap().sorted();
                assert_eq!(auto.cull(&bodies).unwrap().sorted(), all);
                let now = [&grid, &auto].map(|culler| culler.counters().sphere.tests);
                let [of_grid, tests] = [0, 1].map(|k| now[k] - before[k]);
                before = now;
                let what = format!("{strategy}, {mix_name}, 2^{exponent}");
                assert_bounded(&what, frame, tests + auto.list_tests(), of_grid);
            }
        }
    }
}

#[test]
fn spheres_of_any_size_are_bounded() {
    cullers_are_bounded(Strategy::Sphere);
}

/// S dops of any size are bounded.
#[test]
fn s_dop_searches_are_bounded() {
    cullers_are_bounded(Strategy::SDopSequential);
}

/// Boxes that are cubes, and such as are long.
#[test]
fn boxes_of_any_size_are_bounded() {
    for (mix_name, mix) in MIXES {
        for (exponent, aspect) in exponents().flat_map(|e| [1.0, 20.0].map(|aspect| (e, aspect))) {
            let of = |finder| BoxCuller::builder().finder(finder).build().unwrap();
            let [mut grid, mut auto] = [Finder::Grid, Finder::Auto].map(of);
            let mut before = [0; 2];
            for frame in 0..FRAMES {
                let boxes: Vec<Aabb> = placed(exponent, frame)
                    .into_iter()
                    .enumerate()
                    .map(|(body, centre)| {
                        let half = 2f64.powi(radius(exponent, &mix, body)) as f32;
                        let halves = [half, half, half / aspect];
                        let end = |sign: f32| [0, 1, 2].map(|k| centre[k] + sign * halves[k]);
                        Aabb::new(end(-1.0), end(1.0))
                    })
                    .collect();
                let all = grid.cull(&boxes).unwrap().sorted();
                assert_eq!(auto.cull(&boxes).unwrap().sorted(), all);
                let now = [&grid, &auto].map(|culler| culler.counters().tests);
                let [of_grid, tests] = [0, 1].map(|k| now[k] - before[k]);
                before = now;
                let what = format!("boxes 1:{aspect}, {mix_name}, 2^{exponent}");
                assert_bounded(&what, frame, tests + auto.list_tests(), of_grid);
            }
        }
    }
}

/// Bodies of the least size are bounded on any number of threads, with the same counts.
#[test]
fn searches_count_alike_on_any_threads() {
    for exponent in [-70, -66, -58, 0] {
        let (shapes, mut bodies) = (shapes(&MIXES[0].1, exponent), Bodies::default());
        for &t in &placed(exponent, 0) {
            bodies.push(0, true, [0.0, 0.0, 0.0, 1.0], t);
        }
        let mut counts = Vec::new();
        for threads in [1, 2, 5] {
            let builder = Culler::builder().threads(threads).worth_waking(0);
            let mut culler = builder.build(&shapes, &bodies).unwrap();
            let counted: Vec<_> = (0..FRAMES)
                .map(|_| {
                    let pairs = culler.cull(&bodies).unwrap().len();
                    (pairs, culler.list_tests(), culler.counters().sphere.tests)
                })
                .collect();
            counts.push(counted);
        }
        assert!(counts.windows(2).all(|two| two[0] == two[1]), "2^{exponent}");
    }
}

/// Lists pay for long boxes: the first one is made in the second frame, and serves those that
/// follow.
#[test]
fn long_boxes_are_listed_at_once() {
    let of = |finder| BoxCuller::builder().finder(finder).build().unwrap();
    for exponent in [-40, 0, 30] {
        let [mut grid, mut auto] = [Finder::Grid, Finder::Auto].map(of);
        let mut tests = Vec::new();
        let mut before = [0; 2];
        for frame in 0..6 {
            let size = 2f32.powi(exponent);
            let centres = placed(exponent, 0).into_iter();
            let drift = 0.001 * size * frame as f32;
            let boxes: Vec<Aabb> = centres
                .map(|centre| {
                    let halves = [size, size, 0.05 * size];
                    let end = |sign: f32| [0, 1, 2].map(|k| centre[k] + drift + sign * halves[k]);
                    Aabb::new(end(-1.0), end(1.0))
                })
                .collect();
            let all = grid.cull(&boxes).unwrap().sorted();
            assert_eq!(auto.cull(&boxes).unwrap().sorted(), all);
            let now = [&grid, &auto].map(|culler| culler.counters().tests);
            tests.push(([0, 1].map(|k| now[k] - before[k]), auto.list_tests()));
            before = now;
        }
        let (first, rest) = tests.split_at(2);
        assert!(first[0].1 == 0 && first[1].1 > 0, "2^{exponent}: {tests:?}");
        let is_followed =
            |&([of_grid, tests], searched): &([u64; 2], u64)| searched == 0 && 2 * tests < of_grid;
        assert!(rest.iter().all(is_followed), "2^{exponent}: {tests:?}");
    }
}
