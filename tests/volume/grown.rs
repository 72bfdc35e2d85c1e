//! Slabs that are grown by a margin contain every point within it, in exact arithmetic, and are not
//! an ulp larger than necessary.

use dashu_int::IBig;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sdop::mesh::ProceduralShape;
use sdop::volume::{Axes, DirectionSet, OrDop, Origin, Shape, ShapeSpec};
use sdop_judge::configuration::variants;

use super::exact::{dot, integer, point};

/// ‖d‖² of each direction, times 2²⁹⁸.
fn lengths_squared(ordop: &OrDop) -> Vec<IBig> {
    let basis = ordop.basis.columns.map(point);
    let coefficients = ordop.directions.coefficients().iter();
    let length = |c: &[i8; 3]| {
        let d: [IBig; 3] =
            std::array::from_fn(|k| (0..3).map(|j| &basis[j][k] * IBig::from(c[j])).sum());
        dot(&d, &d)
    };
    coefficients.map(length).collect()
}

/// Whether an end that was moved from `before` to `after`, upward, lets in all that a ball of
/// radius `margin` adds: after − before ≥ margin·‖d‖.
fn is_far_enough(before: f32, after: f32, margin: f32, length_squared: &IBig) -> bool {
    let (moved, margin) = (integer(after) - integer(before), integer(margin));
    // Squares of integers carry 2²⁹⁸, and ‖d‖² another 2²⁹⁸.
    after >= before && ((&moved * &moved) << 298) >= &margin * &margin * length_squared
}

/// Slabs grow by the margin to the ulp.
#[test]
fn slabs_grow_exactly_by_margin() {
    let mut rng = ChaCha8Rng::seed_from_u64(12);
    let (mut ends, mut close) = (0, 0);
    for (directions, axes) in variants() {
        for name in ProceduralShape::NAMES {
            let mesh = ProceduralShape::default_of(name).unwrap().build().unwrap();
            let spec = ShapeSpec {
                directions,
                axes,
                origin: Origin::Ball,
                radius: Some(rng.random_range(0.5..2.0)),
            };
            let ordop = Shape::build(&mesh, &spec).unwrap().ordop;
            let lengths = lengths_squared(&ordop);
            for draw in 0..24 {
                let margin = rng.random_range(0.5_f32..1.0) * 2_f32.powi(draw - 12);
                let grown = ordop.grown(margin);
                for (i, length) in lengths.iter().enumerate() {
                    let upper = (ordop.hi[i], grown.hi[i]);
                    for (before, after) in [upper, (-ordop.lo[i], -grown.lo[i])] {
                        let what =
                            || format!("{name}, k = {directions}, {axes}, slab {i}, {margin:e}");
                        assert!(is_far_enough(before, after, margin, length), "{}", what());
                        // Where the end and the margin cancel, its ulps are finer than the
                        // margin's.
                        ends += 1;
                        if after.abs() >= margin * 2_f32.powi(-8) {
                            let nearer = (0..3).fold(after, |x, _| x.next_down());
                            assert!(!is_far_enough(before, nearer, margin, length), "{}", what());
                            close += 1;
                        }
                    }
                }
            }
        }
    }
    assert!(close > ends / 2, "{close} of {ends}");
}

/// Where the margin nearly cancels an end, the end's own ulps are finer than the roundings of f64
/// that the margin takes.
#[test]
fn cancelling_margin_moves_far_enough() {
    let mut rng = ChaCha8Rng::seed_from_u64(8);
    let mesh = ProceduralShape::default_of("box").unwrap().build().unwrap();
    let spec =
        ShapeSpec { directions: DirectionSet::K26, axes: Axes::Model, ..ShapeSpec::default() };
    let mut ordop = Shape::build(&mesh, &spec).unwrap().ordop;
    let exact = lengths_squared(&ordop);
    let lengths: Vec<f64> = ordop
        .directions
        .coefficients()
        .iter()
        .map(|&c| glam::Vec3::from(ordop.basis.direction(c)).as_dvec3().length())
        .collect();
    let mut close = 0;
    for _ in 0..100_000 {
        let margin = rng.random_range(0.5_f32..1.0);
        for (i, length) in lengths.iter().enumerate() {
            let out = f64::from(margin) * length;
            let end = out as f32;
            let left = (f64::from(end) - out).abs();
            if left == 0.0 || left > out * 2_f64.powi(-38) {
                continue;
            }
            ordop.lo[i] = end;
            let grown = ordop.grown(margin);
            let what = || format!("slab {i}, {margin:e}, {end:e}");
            assert!(is_far_enough(-end, -grown.lo[i], margin, &exact[i]), "{}", what());
            ordop.hi[i] = -end;
            let grown = ordop.grown(margin);
            assert!(is_far_enough(-end, grown.hi[i], margin, &exact[i]), "{}", what());
            close += 1;
        }
    }
    assert!(close > 20, "{close}");
}
