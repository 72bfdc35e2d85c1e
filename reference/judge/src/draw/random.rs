//! Random numbers of suites and benches, the same on every machine.

use rand::distr::uniform::SampleUniform;
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

/// The numbers of a seed.
#[derive(Clone, Debug)]
pub struct Random(ChaCha8Rng);

impl Random {
    /// The numbers of this seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    /// A number from 0 on that is below another.
    pub fn below<N: SampleUniform + PartialOrd + Default>(&mut self, n: N) -> N {
        self.0.random_range(N::default()..n)
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f32 {
        self.0.random()
    }

    /// In [−reach, reach).
    pub fn within(&mut self, reach: f32) -> f32 {
        (2.0 * self.unit() - 1.0) * reach
    }
}
