//! Seeded random draws that are equal to the bit on every platform and don't change with library
//! versions.
//!
//! Only ChaCha's words come from a crate, because that stream cipher is specified to the bit. The
//! maps from words to floats are in this file. Directions and rotations are drawn by rejection
//! (Marsaglia 1972), which needs a square root but no trigonometry.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use crate::number::Interval;

/// A stream of draws. Streams of one seed are independent of each other.
#[derive(Clone, Debug)]
pub struct Stream(ChaCha8Rng);

impl Stream {
    /// Stream number `stream` of `seed`.
    #[must_use]
    pub fn new(seed: u64, stream: u64) -> Self {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        let mut words = ChaCha8Rng::from_seed(key);
        words.set_stream(stream);
        Self(words)
    }

    /// Uniform in [0, 1), a multiple of 2⁻²⁴.
    pub fn unit(&mut self) -> f32 {
        (self.0.next_u32() >> 8) as f32 * (1.0 / (1 << 24) as f32)
    }

    /// Uniform between the two ends, never outside of them.
    pub fn between(&mut self, lo: f32, hi: f32) -> f32 {
        (lo + self.unit() * (hi - lo)).clamp(lo, hi)
    }

    /// Uniform in 0 … n − 1 without the bias of a plain remainder (Lemire 2019).
    ///
    /// `n` is not zero.
    pub fn index(&mut self, n: u32) -> u32 {
        let refused = n.wrapping_neg() % n;
        loop {
            let product = u64::from(self.0.next_u32()) * u64::from(n);
            if product as u32 >= refused {
                return (product >> 32) as u32;
            }
        }
    }

    /// A point of the open unit disc and its squared norm.
    fn disc(&mut self) -> (f32, f32, f32) {
        loop {
            let (x, y) = (2.0 * self.unit() - 1.0, 2.0 * self.unit() - 1.0);
            let norm2 = x * x + y * y;
            if norm2 < 1.0 {
                return (x, y, norm2);
            }
        }
    }

    /// A direction, uniform on the unit sphere.
    pub fn direction(&mut self) -> [f32; 3] {
        let (x, y, norm2) = self.disc();
        let stretch = 2.0 * libm::sqrtf(1.0 - norm2);
        [x * stretch, y * stretch, 1.0 - 2.0 * norm2]
    }

    /// A vector with uniform direction and uniform length.
    pub fn vector(&mut self, length: Interval) -> [f32; 3] {
        let scale = self.between(length.min, length.max);
        self.direction().map(|x| x * scale)
    }

    /// A rotation, uniform over all rotations; a unit quaternion to rounding.
    pub fn rotation(&mut self) -> [f32; 4] {
        let (x, y, s) = self.disc();
        loop {
            let (z, w, t) = self.disc();
            // t = 0 has no direction to stretch; it is one draw in 2⁴⁶.
            if t > 0.0 {
                let stretch = libm::sqrtf((1.0 - s) / t);
                return [x, y, z * stretch, w * stretch];
            }
        }
    }

    /// A point uniform in the ball of radius r about the origin.
    pub fn ball(&mut self, r: f32) -> [f32; 3] {
        loop {
            let p = [(); 3].map(|()| 2.0 * self.unit() - 1.0);
            if p[0] * p[0] + p[1] * p[1] + p[2] * p[2] <= 1.0 {
                return p.map(|x| x * r);
            }
        }
    }

    /// A radius, log-uniform between the ends, snapped to the nearest of eight steps per octave
    /// (mantissas 1, 1.125 … 1.875). Every radius needs its own shape, so few radii mean few
    /// shapes.
    pub fn radius(&mut self, range: Interval) -> f32 {
        if range.min == range.max {
            return range.min;
        }
        let ratio = f64::from(range.max) / f64::from(range.min);
        let radius = f64::from(range.min) * libm::pow(ratio, f64::from(self.unit()));
        let step = libm::ldexp(1.0, libm::ilogb(radius) - 3);
        ((libm::round(radius / step) * step) as f32).clamp(range.min, range.max)
    }
}
