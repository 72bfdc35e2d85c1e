//! Hosts may change the floating-point mode: flush subnormal numbers, or round differently. Shapes
//! and pairs must not depend on it, and the host's mode must be restored, also after a panic.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::panic::{AssertUnwindSafe, catch_unwind};

use sdop::bodies::Bodies;
use sdop::mesh::shapes::ProceduralShape;
use sdop::simd::FpMode;
use sdop::volume::{DirectionSet, Shape, ShapeSpec};
use sdop::world::{Body, PairTest, World};
use sdop::{Aabb, BoxCuller, BoxWorld, Culler, Finder, Strategy};
use sdop_judge::draw::random::Random;

const FRAMES: usize = 4;

fn vector(random: &mut Random, size: f64) -> [f64; 3] {
    [0; 3].map(|_| f64::from(random.unit()) * size)
}

/// Radii of bodies: ordinary, such that squares of distances are subnormal, and subnormal ones.
const SIZES: [f64; 3] = [1.0, 2e-22, 1e-40];

/// Calls `work` in every other mode and compares what it returns with what it does in the default
/// one.
fn assert_same<R: PartialEq>(what: &str, work: impl Fn() -> R) {
    assert_eq!(FpMode::current(), FpMode::DEFAULT);
    let wanted = work();
    for mode in FpMode::OTHERS {
        mode.run(|| {
            let found = work();
            assert_eq!(FpMode::current(), mode, "{what}");
            assert!(found == wanted, "{what}: another result in {mode:?}");
        });
    }
}

/// The test's own numbers are made in the default mode.
fn given<R>(numbers: impl FnOnce() -> R) -> R {
    FpMode::DEFAULT.run(numbers)
}

fn shape(size: f64) -> Shape {
    let (mesh, spec) = given(|| {
        let torus = ProceduralShape::default_of("torus").unwrap();
        let spec = ShapeSpec { radius: Some(size as f32), ..ShapeSpec::default() };
        (torus.build().unwrap(), spec)
    });
    Shape::build(&mesh, &spec).unwrap()
}

/// Poses of so many bodies, two sizes apart in the mean.
fn poses(count: usize, size: f64, frame: usize) -> Vec<([f32; 4], [f32; 3])> {
    let (mut still, mut moved) = (Random::new(5), Random::new(frame as u64));
    let side = 1.6 * size * (count as f64).cbrt();
    (0..count)
        .map(|_| {
            let (at, by) = (vector(&mut still, side), vector(&mut moved, 0.2 * size));
            let rotation = [0; 4].map(|_| (f64::from(still.unit()) - 0.5) as f32);
            (rotation, [0, 1, 2].map(|k| (at[k] + by[k]) as f32))
        })
        .collect()
}

fn culled(strategy: Strategy, finder: Finder, size: f64, threads: usize) -> Vec<Vec<[u32; 2]>> {
    let shape = shape(size);
    let mut bodies = Bodies::default();
    for (i, (q, t)) in given(|| poses(300, size, 0)).into_iter().enumerate() {
        bodies.push(0, i % 4 != 0, q, t);
    }
    let of = Culler::builder().strategy(strategy).finder(finder);
    let of = of.threads(threads).worth_waking(0);
    let mut culler = of.build(std::slice::from_ref(&shape), &bodies).unwrap();
    (0..FRAMES)
        .map(|frame| {
            for (i, (_, t)) in given(|| poses(300, size, frame)).into_iter().enumerate() {
                if bodies.dynamic[i] {
                    bodies.translation[i] = t;
                }
            }
            culler.cull(&bodies).unwrap().iter().collect()
        })
        .collect()
}

/// Shapes are the same in every mode.
#[test]
fn shapes_ignore_fp_mode() {
    for size in SIZES {
        assert_same("a shape", || {
            let shape = shape(size);
            let others = shape.clone().with_directions(DirectionSet::K26);
            // Texts are written in the default mode: they depend on comparisons, too.
            given(|| format!("{shape:?} {:?}", others.ordop))
        });
    }
}

/// Pairs of cullers are the same in every mode.
#[test]
fn cullers_ignore_fp_mode() {
    for size in SIZES {
        for strategy in [Strategy::Sphere, Strategy::SDopSequential, Strategy::Aabb] {
            for &finder in Finder::ALL {
                for threads in [1, 3] {
                    let what = format!("{strategy}, {finder}, {size}, {threads} threads");
                    assert_same(&what, || culled(strategy, finder, size, threads));
                }
            }
        }
    }
}

/// Boxes whose sides and distances are of this size.
fn boxes(size: f64, frame: usize) -> Vec<Aabb> {
    let mut random = Random::new(3 + frame as u64);
    (0..200)
        .map(|_| {
            let (min, sides) = (vector(&mut random, 6.0 * size), vector(&mut random, size));
            let max = [0, 1, 2].map(|k| (min[k] + sides[k]) as f32);
            Aabb::new(min.map(|x| x as f32), max)
        })
        .collect()
}

/// Pairs of boxes are the same in every mode.
#[test]
fn boxes_ignore_fp_mode() {
    for (size, threads) in SIZES.into_iter().flat_map(|size| [(size, 1), (size, 3)]) {
        for &finder in Finder::ALL {
            assert_same(&format!("boxes, {finder}, {size}"), || {
                let of = BoxCuller::builder().finder(finder).threads(threads);
                let mut culler = of.worth_waking(0).build().unwrap();
                let frames = (0..FRAMES).map(|frame| given(|| boxes(size, frame)));
                let pairs = frames.map(|boxes| culler.cull(&boxes).unwrap().sorted());
                pairs.collect::<Vec<_>>()
            });
        }
        assert_same("a world of boxes", || {
            let mut world = BoxWorld::new();
            for aabb in given(|| boxes(size, 0)) {
                world.insert(aabb).unwrap();
            }
            world.cull().unwrap();
            let upside_down = Aabb::new([2e-40; 3], [1e-40; 3]);
            assert!(world.insert(upside_down).is_err());
            let pairs = world.pairs().map(|pair| pair.map(|id| id.slot()));
            pairs.collect::<Vec<_>>()
        });
    }
}

/// Margins and the rounding of f64 translations choose models.
#[test]
fn worlds_ignore_fp_mode() {
    for size in SIZES {
        assert_same("a world", || {
            let mut world = World::new(vec![shape(size)]).unwrap();
            let mut random = Random::new(9);
            for (q, t) in given(|| poses(200, size, 0)) {
                let body = given(|| Body {
                    margin: (0.01 * size * f64::from(random.unit())) as f32,
                    ..Body::at(
                        0,
                        q,
                        t.map(|x| f64::from(x) + f64::from(random.unit()) * 1e-12 * size),
                    )
                });
                world.insert(body).unwrap();
            }
            world.cull().unwrap();
            let pairs = world.pairs().map(|pair| pair.map(|id| id.slot()));
            pairs.collect::<Vec<_>>()
        });
    }
}

/// Single pairs are the same in every mode.
#[test]
fn pair_tests_ignore_fp_mode() {
    for size in SIZES {
        assert_same("single pairs", || {
            let mut test = PairTest::new(DirectionSet::K18);
            let one = test.add(&shape(size)).unwrap();
            let other = test.grown(one, given(|| (0.01 * size) as f32)).unwrap();
            let poses = given(|| poses(500, 0.2 * size, 1)).into_iter();
            let touch = poses.map(|(q, t)| test.may_touch(one, other, q, t));
            touch.collect::<Vec<_>>()
        });
    }
}

/// The mode returns after an error or a panic.
#[test]
fn errors_restore_the_mode() {
    let boxes = given(|| boxes(1.0, 0));
    for mode in FpMode::OTHERS {
        mode.run(|| {
            let mut culler = BoxCuller::new();
            let invalid = Aabb::new([1.0; 3], [0.0; 3]);
            assert!(culler.cull(&[invalid]).is_err() && FpMode::current() == mode);
            let panics = AssertUnwindSafe(|| {
                culler.cull_in_portions(&boxes, |_| panic!("a callback of the host's"))
            });
            assert!(catch_unwind(panics).is_err() && FpMode::current() == mode);
        });
    }
}
