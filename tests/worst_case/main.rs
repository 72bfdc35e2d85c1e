//! The worst error that hill climbing finds stays below each bound's constant, and comes close
//! enough to that of a long search for the short one to be a real test. `cargo bench --bench
//! worst_case` is the long search.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod bounds;
mod climb;
mod exact;
mod kernel;
#[path = "../support/limit.rs"]
mod limit;
mod machine;
mod ordop;
mod poses;
mod slabs;
mod spheres;

use sdop::simd::Tier;

/// Steps of each short search.
const EVALUATIONS: u64 = 400_000;

/// No search exceeds its bound and every search has teeth.
#[test]
fn searches_stay_below_bounds() {
    let mut failures = Vec::new();
    for bound in bounds::all() {
        let found = (bound.search)(1, EVALUATIONS);
        println!("{:40} {found:.3} of {}", bound.name, bound.constant);
        if !(bound.teeth <= found && found <= bound.constant) {
            failures.push(format!(
                "{}: found {found:.3} {}, expected {} to {}",
                bound.name, bound.unit, bound.teeth, bound.constant
            ));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn nothing_leaves_its_volume() {
    for bound in bounds::containments() {
        let found = (bound.search)(1, EVALUATIONS);
        assert!(found <= 0.0, "{}: {found:e} {}", bound.name, bound.unit);
    }
}

/// Controls: with less than the constants, the same searches do find a touching pair that is
/// culled.
#[test]
fn a_lower_floor_or_factor_misses() {
    let floor = 2.0f32.powi(-78);
    assert!((1..4).any(|seed| spheres::tiny::<false>(seed, EVALUATIONS, floor) > 0.0));
    let naive = |r: f32| r * (1.0 + f32::EPSILON);
    assert!((1..4).any(|seed| spheres::touching_with(seed, EVALUATIONS, naive) > 0.0));
}

/// The searches attack the cullers own arithmetic.
#[test]
fn searches_use_the_cullers_arithmetic() {
    kernel::supports_agree::<false>(Tier::SCALAR);
    kernel::supports_agree::<true>(Tier::SCALAR_FLUSH);
    kernel::decisions_agree::<false>(Tier::detect());
    kernel::decisions_agree::<true>(Tier::SCALAR_FLUSH);
}
