//! Why margins are needed: without them, or with smaller ones, the same f32 arithmetic misses pairs
//! that touch exactly.
//!
//! A Pythagorean quadruple x² + y² + z² = n² of 24-bit integers is a centre distance that f32 holds
//! exactly, so spheres of radii r and n − r touch in exact arithmetic, which integers decide. Small
//! quadruples test nothing, because every operation on them is exact.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use sdop::rounding::sphere::{RADIUS_FACTOR, inflate_radius};

/// Centres and radii of an exact touch, all integers of at most 24 bits.
struct Touch {
    centres: [[i64; 3]; 2],
    radii: [i64; 2],
}

/// Touches from random quadruples (m²+n²−p²−q², 2(mq+np), 2(nq−mp), m²+n²+p²+q²) whose last number
/// has `bits` bits. Distance and radius are shared between the two, so that 25 bits fit and
/// differences and sums must round.
fn touches(bits: u32, count: usize) -> Vec<Touch> {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut below = |n: i64| ((u128::from(random.next_u64()) * n as u128) >> 64) as i64;
    let mut touches = Vec::with_capacity(count);
    while touches.len() < count {
        let [m, n, p, q] = [(); 4].map(|()| below(1 << bits.div_ceil(2)));
        let length = m * m + n * n + p * p + q * q;
        if length >> (bits - 1) != 1 {
            continue;
        }
        let way = [m * m + n * n - p * p - q * q, 2 * (m * q + n * p), 2 * (n * q - m * p)];
        let least = (length - (1 << 24)).max(0);
        let radius = least + below(length + 1 - 2 * least);
        let first = if bits > 24 { way.map(|x| -x / 2) } else { [0; 3] };
        touches.push(Touch {
            centres: [first, [0, 1, 2].map(|i| first[i] + way[i])],
            radii: [radius, length - radius],
        });
    }
    touches
}

/// How many of these exact touches the f32 sphere test culls when it adds the radii `stored`, all
/// scaled by 2^`exponent`.
fn misses(touches: &[Touch], exponent: i32, stored: impl Fn(f32) -> f32) -> usize {
    let number = |x: i64| {
        assert!(x.abs() <= 1 << 24, "{x} is not an f32");
        x as f32 * 2.0f32.powi(exponent)
    };
    let culled = |touch: &&Touch| {
        let way = [0, 1, 2].map(|i| i128::from(touch.centres[1][i] - touch.centres[0][i]));
        let sum = i128::from(touch.radii[0] + touch.radii[1]);
        assert_eq!(way.iter().map(|x| x * x).sum::<i128>(), sum * sum, "an exact touch");
        let [a, b] = touch.centres.map(|centre| centre.map(number));
        let [x, y, z] = [0, 1, 2].map(|i| b[i] - a[i]);
        let s = stored(number(touch.radii[0])) + stored(number(touch.radii[1]));
        (x * x + y * y) + z * z > s * s
    };
    touches.iter().filter(culled).count()
}

const U: f32 = f32::EPSILON / 2.0;

/// Naive radii miss exact touches and inflated ones none.
#[test]
fn naive_radii_miss_touches() {
    for (bits, expected) in [(24, [7_477, 0, 0]), (25, [13_592, 20, 0])] {
        let touches = touches(bits, 50_000);
        let found = [1.0, 1.0 + 2.0 * U, 1.0 + 4.0 * U].map(|k| misses(&touches, 0, |r| r * k));
        assert_eq!(found, expected, "{bits} bits: factors 1, 1 + 2u, 1 + 4u");
        assert_eq!(misses(&touches, 0, inflate_radius), 0);
    }
}

#[test]
fn small_quadruples_are_toothless() {
    assert_eq!(misses(&touches(12, 50_000), 0, |r| r), 0);
}

/// No size misses down to subnormal numbers.
#[test]
fn subnormal_sizes_miss_nothing() {
    let touches = touches(25, 20_000);
    // Squares underflow below 2⁻⁷⁵, at numbers of some 2⁻⁹⁹·2²⁴.
    for exponent in [-149, -120, -105, -100, -95, -90, -60, 0, 36] {
        assert_eq!(misses(&touches, exponent, inflate_radius), 0, "scale 2^{exponent}");
    }
    let floorless = |r: f32| r * RADIUS_FACTOR;
    let found = [-95, -60].map(|exponent| misses(&touches, exponent, floorless));
    assert_eq!(found, [3_183, 0], "the factor alone, without the floor");
}
