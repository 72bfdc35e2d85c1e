//! Attacks on the sphere test: the rounding of d² against s², the floor, and what finders must
//! widen by.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use sdop::rounding::U;
use sdop::rounding::sphere::{RADIUS_FACTOR, inflate_radius};

use super::climb::climb;

/// (d², t) as the culler computes them from centres and stored radii.
fn test(a: [f32; 3], b: [f32; 3], ra: f32, rb: f32) -> (f64, f64) {
    let [x, y, z] = [0, 1, 2].map(|i| b[i] - a[i]);
    let s = rb + ra;
    (f64::from((x * x + y * y) + z * z), f64::from(s * s))
}

fn squared_distance(a: [f32; 3], b: [f32; 3]) -> f64 {
    (0..3).map(|i| (f64::from(b[i]) - f64::from(a[i])).powi(2)).sum()
}

fn start(random: &mut ChaCha8Rng) -> [f32; 8] {
    std::array::from_fn(|i| {
        if i < 6 { random.random_range(-1.0..1.0) } else { random.random_range(0.25..1.0) }
    })
}

/// d²/D ÷ t/Q − 1 in u: what the stored radii must gain.
pub fn decision(seed: u64, evaluations: u64) -> f64 {
    worst(seed, evaluations, |[d2, exact, t, s2]| d2 / exact * (s2 / t) - 1.0)
}

/// √D/(R_A + R_B) − 1 in u, for d² = t: how far beyond the stored radii bodies that are still
/// reported can be.
pub fn reported(seed: u64, evaluations: u64) -> f64 {
    worst(seed, evaluations, |[d2, exact, t, s2]| (exact / d2 * (t / s2)).sqrt() - 1.0)
}

/// The worst error in u of a comparison, given d² as computed and exact, then s².
fn worst(seed: u64, evaluations: u64, error: impl Fn([f64; 4]) -> f64) -> f64 {
    let of = |&[ax, ay, az, bx, by, bz, ra, rb]: &[f32; 8]| {
        let (a, b) = ([ax, ay, az], [bx, by, bz]);
        let (d2, t) = test(a, b, ra, rb);
        let s = f64::from(ra) + f64::from(rb);
        error([d2, squared_distance(a, b), t, s * s]) / U
    };
    climb(seed, evaluations, start, of).0
}

/// How near to being culled touching pairs come with radii as the culler inflates them: 1 culled,
/// below 0 not.
pub fn touching(seed: u64, evaluations: u64) -> f64 {
    touching_with(seed, evaluations, inflate_radius)
}

/// The same with radii inflated otherwise.
pub fn touching_with(seed: u64, evaluations: u64, inflated: impl Fn(f32) -> f32) -> f64 {
    let start = |random: &mut ChaCha8Rng| touching_start(random, 1.0);
    climb(seed, evaluations, start, |p| gain(p, &inflated)).0
}

/// The same at sizes from 2⁻⁵⁰ down to 2⁻⁹⁵, where underflow and the floor matter.
pub fn tiny(seed: u64, evaluations: u64, floor: f32) -> f64 {
    let start = |random: &mut ChaCha8Rng| {
        let exponent = random.random_range(50..95);
        touching_start(random, 2.0f32.powi(-exponent))
    };
    let inflated = |r: f32| r * RADIUS_FACTOR + floor;
    climb(seed, evaluations, start, |p| gain(p, inflated)).0
}

/// Centres and radii of spheres that barely touch.
fn touching_start(random: &mut ChaCha8Rng, scale: f32) -> [f32; 8] {
    let [ax, ay, az, bx, by, bz] = [(); 6].map(|()| random.random_range(-1.0..1.0) * scale);
    let length = squared_distance([ax, ay, az], [bx, by, bz]).sqrt();
    let share = random.random_range(0.0..1.0);
    let (ra, rb) = ((length * share) as f32, ((length * (1.0 - share)) as f32).next_up());
    [ax, ay, az, bx, by, bz, ra, rb]
}

fn gain(&[ax, ay, az, bx, by, bz, ra, rb]: &[f32; 8], inflated: impl Fn(f32) -> f32) -> f64 {
    let (a, b, ra, rb) = ([ax, ay, az], [bx, by, bz], ra.abs(), rb.abs());
    let reach = f64::from(ra) + f64::from(rb);
    let squared = squared_distance(a, b);
    // A product of f64 rounds, so a touch is believed only with 2⁻⁵⁰ to spare.
    if squared > reach * reach * (1.0 - 4.0 * f64::EPSILON) {
        return f64::NEG_INFINITY;
    }
    let (d2, t) = test(a, b, inflated(ra), inflated(rb));
    let t = t.max(1e-60);
    if d2 > t {
        return 1.0;
    }
    // d² and t are few floats apart: the exact error is what leads over the plateaus.
    let error = (d2 / t) * (reach * reach / squared).min(2.0);
    (d2 / t - 2.0) + 0.001 * error
}
