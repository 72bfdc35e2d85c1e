//! The constants of spheres and poses are tight: hill climbing stays below each, and comes close to
//! it. `cargo bench --bench worst_case` is a longer search. Bounds of or-DOPs are decided for every
//! input of small formats (`tests/arithmetic/small`).

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod climb;
mod poses;
mod spheres;

use sdop::rounding::pose::{COORDINATE_ERROR, REFIT_MARGIN};
use sdop::rounding::sphere::{CENTRE_ERROR, RADIUS_FLOOR};
use sdop::rounding::{FINDER_FACTOR, U};

/// 2⁻⁵³.
const EPSILON: f64 = f64::EPSILON / 2.0;

/// Steps of each short search.
#[allow(dead_code, reason = "the longer search has its own")]
const EVALUATIONS: u64 = 400_000;

/// The largest error that a search with a seed finds in a number of steps.
type Search = fn(u64, u64) -> f64;

/// Each bound's name and unit; what a short search must reach; what none may exceed.
pub const BOUNDS: [(&str, &str, f64, f64, Search); 5] = [
    ("sphere decision", "u", 7.7, 8.0, spheres::decision),
    ("reported sphere distance", "u", 3.8, (FINDER_FACTOR - 1.0) / U, spheres::reported),
    ("pose coordinate", "2⁻⁵³", 7.0, COORDINATE_ERROR / EPSILON, poses::coordinate),
    ("ball centre", "2⁻⁵³", 8.0, CENTRE_ERROR / EPSILON, poses::centre),
    ("world extent", "2⁻⁵³", 11.0, REFIT_MARGIN / EPSILON, poses::extent),
];

/// Errors that are never positive: something leaves its volume, or a touching pair is culled.
pub const CONTAINMENTS: [(&str, Search); 4] = [
    ("posed ball out of its world ball", poses::ball_outside),
    ("posed vertex out of its world extent", poses::extent_outside),
    ("touching spheres culled", spheres::touching),
    ("tiny touching spheres culled", |seed, n| spheres::tiny(seed, n, RADIUS_FLOOR)),
];

#[test]
fn searches_stay_below_bounds() {
    for (name, unit, teeth, constant, search) in BOUNDS {
        let found = (1..=4).map(|seed| search(seed, EVALUATIONS)).fold(f64::NEG_INFINITY, f64::max);
        println!("{name:40} {found:.3} of {constant}");
        assert!(teeth <= found && found <= constant, "{name}: {found} {unit}, of {constant}");
    }
}

#[test]
fn nothing_leaves_its_volume() {
    for (name, search) in CONTAINMENTS {
        let found = search(1, EVALUATIONS);
        assert!(found <= 0.0, "{name}: {found:e}");
    }
}

/// Controls: with less than the constants, the same searches find a touching pair that is culled.
#[test]
fn lower_constants_miss() {
    let floor = 2.0f32.powi(-78);
    assert!((1..4).any(|seed| spheres::tiny(seed, EVALUATIONS, floor) > 0.0));
    let naive = |r: f32| r * (1.0 + f32::EPSILON);
    assert!((1..4).any(|seed| spheres::touching_with(seed, EVALUATIONS, naive) > 0.0));
}
