//! Inputs of the contract, many at its edges: zeros of both signs, subnormals, powers of two and
//! their neighbours, the limit 2⁶⁰.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use sdop::rounding::{LIMIT, exp2};

pub struct Inputs(ChaCha8Rng);

impl Inputs {
    pub fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    pub fn below(&mut self, n: u32) -> u32 {
        ((u64::from(self.0.next_u32()) * u64::from(n)) >> 32) as u32
    }

    /// In [0, 1), with 53 random bits.
    pub fn share(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 * exp2(-53)
    }

    /// In [−1, 1).
    pub fn signed(&mut self) -> f64 {
        2.0 * self.share() - 1.0
    }

    /// A number of the contract of either sign.
    pub fn number(&mut self) -> f32 {
        let size = self.size();
        if self.below(2) == 0 { size } else { -size }
    }

    /// A number of the contract that isn't negative.
    pub fn size(&mut self) -> f32 {
        let random = self.0.next_u32();
        match self.below(10) {
            0 => 0.0,
            1 => f32::from_bits(random & 0x007f_ffff), // subnormal
            2 => {
                // Next to the least normal number.
                f32::from_bits(0x0080_0000 + random % 7 - 3)
            }
            3 => f32::from_bits(LIMIT.to_bits() - random % 3),
            4 | 5 => {
                // A power of two or next to one.
                let power = (1 + random % 186) << 23;
                f32::from_bits(power + self.below(3) - 1)
            }
            6 => (random % 9) as f32,
            7 => self.share() as f32,
            // Any size.
            _ => f32::from_bits(random % LIMIT.to_bits()),
        }
    }

    /// A power of two from the middle of the range, or from its lower end where products underflow.
    pub fn scale(&mut self) -> f64 {
        match self.below(3) {
            0 => 1.0,
            1 => exp2(self.below(100) as i32 - 50),
            _ => exp2(-(self.below(90) as i32) - 50),
        }
    }

    /// Three numbers of one size, or of any.
    pub fn vector(&mut self) -> [f32; 3] {
        if self.below(3) == 0 {
            return [(); 3].map(|()| self.number());
        }
        let scale = self.scale();
        [(); 3].map(|()| (self.signed() * scale) as f32)
    }

    /// A quaternion that isn't zero.
    pub fn quaternion(&mut self) -> [f32; 4] {
        loop {
            let scale = self.scale();
            let q = match self.below(3) {
                0 => [(); 4].map(|()| self.number()),
                1 => [(); 4].map(|()| self.below(3) as f32 - 1.0),
                _ => [(); 4].map(|()| (self.signed() * scale) as f32),
            };
            if q.iter().any(|&x| x != 0.0) {
                return q;
            }
        }
    }

    /// A unit vector, but for rounding.
    pub fn direction(&mut self) -> [f64; 3] {
        loop {
            let v = [(); 3].map(|()| self.signed());
            let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
            if length > 0.1 {
                return v.map(|x| x / length);
            }
        }
    }

    /// A length off by a few units of f32 in the last place.
    pub fn nearly(&mut self, length: f64) -> f64 {
        length * (1.0 + 24.0 * self.signed() * exp2(-24))
    }
}
