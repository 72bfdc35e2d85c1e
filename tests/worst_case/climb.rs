//! Hill climbing over f32 parameters: worst cases of rounding are needles that sampling doesn't
//! hit.
//!
//! A step moves up to three parameters by ± 2^j ulps, j uniform, so that all scales are tried
//! alike. A step that doesn't make the result worse is taken, so that the walk can cross plateaus.
//! A walk that is stuck starts again from a new point or from its best.

/// SplitMix64: a seeded stream that is the same everywhere.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        ((u128::from(self.next()) * n as u128) >> 64) as usize
    }

    /// Uniform in [−1, 1), all 24 bits random.
    pub fn signed(&mut self) -> f32 {
        (self.next() >> 39) as f32 / 16_777_216.0 - 1.0
    }

    /// Uniform in [lo, hi).
    pub fn between(&mut self, lo: f32, hi: f32) -> f32 {
        lo + (hi - lo) * (self.next() >> 40) as f32 / 16_777_216.0
    }
}

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
    start: impl Fn(&mut Random) -> [f32; N],
    score: impl Fn(&[f32; N]) -> f64,
) -> (f64, [f32; N]) {
    let mut random = Random::new(seed);
    let mut here = start(&mut random);
    let mut here_score = score(&here);
    let (mut best, mut best_score) = (here, here_score);
    let mut memory = vec![here_score; MEMORY];
    let (mut peak, mut stuck) = (here_score, 0);
    for step in 0..evaluations {
        if stuck > PATIENCE {
            here = if random.below(3) == 0 { best } else { start(&mut random) };
            here_score = score(&here);
            memory.fill(here_score);
            (peak, stuck) = (here_score, 0);
        }
        let mut next = here;
        for _ in 0..=random.below(3) {
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
fn nudge<const N: usize>(random: &mut Random, point: &mut [f32; N]) {
    let x = &mut point[random.below(N)];
    if random.below(32) == 0 {
        *x = -*x;
        return;
    }
    let step = 1u32 << random.below(24);
    let bits = x.to_bits();
    let moved =
        if random.below(2) == 0 { bits.wrapping_add(step) } else { bits.wrapping_sub(step) };
    if f32::from_bits(moved).is_finite() {
        *x = f32::from_bits(moved);
    }
}
