//! Hill climbing over f32 parameters: worst cases of rounding are needles that sampling doesn't
//! hit.
//!
//! A step moves up to three parameters by ± 2^j ulps, j uniform, so that all scales are tried
//! alike. A step that doesn't make the result worse is taken, so that the walk can cross plateaus.
//! A walk that is stuck starts again from a new point or from its best.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Steps without a new peak before a new start.
const PATIENCE: u64 = 20_000;

/// Late acceptance: a step that beats the score of so many steps ago is taken too. The landscape is
/// all ridges; strict climbing found two thirds of what this finds.
const MEMORY: usize = 2_000;

/// The best score that `evaluations` steps find, and where. A score of −∞ marks a point outside the
/// search's domain.
pub fn climb<const N: usize>(
    seed: u64,
    evaluations: u64,
    start: impl Fn(&mut ChaCha8Rng) -> [f32; N],
    score: impl Fn(&[f32; N]) -> f64,
) -> (f64, [f32; N]) {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut here = start(&mut random);
    let mut here_score = score(&here);
    let (mut best, mut best_score) = (here, here_score);
    let mut memory = vec![here_score; MEMORY];
    let (mut peak, mut stuck) = (here_score, 0);
    for step in 0..evaluations {
        if stuck > PATIENCE {
            here = if random.random_range(0..3) == 0 { best } else { start(&mut random) };
            here_score = score(&here);
            memory.fill(here_score);
            (peak, stuck) = (here_score, 0);
        }
        let mut next = here;
        for _ in 0..=random.random_range(0..3) {
            nudge(&mut random, &mut next);
        }
        let next_score = score(&next);
        let past = &mut memory[step as usize % MEMORY];
        if next_score >= here_score || next_score >= *past {
            (here, here_score) = (next, next_score);
        }
        *past = past.max(here_score);
        stuck += 1;
        if here_score > peak {
            (peak, stuck) = (here_score, 0);
        }
        if here_score > best_score {
            (best, best_score) = (here, here_score);
        }
    }
    (best_score, best)
}

/// Moves one parameter by a power of two of ulps; now and then flips its sign.
fn nudge<const N: usize>(random: &mut ChaCha8Rng, point: &mut [f32; N]) {
    let x = &mut point[random.random_range(0..N)];
    if random.random_range(0..32) == 0 {
        *x = -*x;
        return;
    }
    let step = 1u32 << random.random_range(0..24);
    let bits = x.to_bits();
    let moved = if random.random() { bits.wrapping_add(step) } else { bits.wrapping_sub(step) };
    if f32::from_bits(moved).is_finite() {
        *x = f32::from_bits(moved);
    }
}
