//! [`BallBounds`]: the box of ball centres and the largest radius, from which a finder derives its
//! cells.

use crate::simd::{Kernel, Lanes, Tier, dispatch};

/// Extremes over a set of balls. For an empty set, `lo` is above `hi`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallBounds {
    /// Lowest centre coordinates.
    pub lo: [f32; 3],
    /// Highest centre coordinates.
    pub hi: [f32; 3],
    /// Largest radius.
    pub widest: f32,
}

impl BallBounds {
    /// The bounds of an empty set.
    pub const EMPTY: Self =
        Self { lo: [f32::INFINITY; 3], hi: [f32::NEG_INFINITY; 3], widest: 0.0 };

    /// The bounds of some balls.
    #[must_use]
    pub fn of(tier: Tier, balls: &[[f32; 4]]) -> Self {
        dispatch(tier, FindExtremes(balls))
    }

    /// The bounds of both sets together.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            lo: std::array::from_fn(|i| self.lo[i].min(other.lo[i])),
            hi: std::array::from_fn(|i| self.hi[i].max(other.hi[i])),
            widest: self.widest.max(other.widest),
        }
    }
}

/// The numbers of four balls, a multiple of every tier's vectors. Each of the sixteen positions has
/// separate extremes, so every tier compares the same numbers in the same order.
const NUMBERS_PER_CHUNK: usize = 16;

struct FindExtremes<'a>(&'a [[f32; 4]]);

impl Kernel for FindExtremes<'_> {
    type Output = BallBounds;
    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> BallBounds {
        let vectors = NUMBERS_PER_CHUNK / L::WIDTH;
        let mut lo = [l.splat(f32::INFINITY); NUMBERS_PER_CHUNK];
        let mut hi = [l.splat(f32::NEG_INFINITY); NUMBERS_PER_CHUNK];
        let (chunks, rest) = self.0.as_flattened().as_chunks::<NUMBERS_PER_CHUNK>();
        for chunk in chunks {
            for k in 0..vectors {
                let numbers = l.load(&chunk[k * L::WIDTH..]);
                lo[k] = l.min(numbers, lo[k]);
                hi[k] = l.max(numbers, hi[k]);
            }
        }
        let mut ends = [[f32::INFINITY; NUMBERS_PER_CHUNK], [f32::NEG_INFINITY; NUMBERS_PER_CHUNK]];
        for k in 0..vectors {
            l.store(lo[k], &mut ends[0][k * L::WIDTH..]);
            l.store(hi[k], &mut ends[1][k * L::WIDTH..]);
        }
        let [mut lo, mut hi] = [[f32::INFINITY; 4], [f32::NEG_INFINITY; 4]];
        let lows = ends[0].iter().chain(rest).enumerate();
        let highs = ends[1].iter().chain(rest).enumerate();
        lows.for_each(|(i, x)| lo[i % 4] = lo[i % 4].min(*x));
        highs.for_each(|(i, x)| hi[i % 4] = hi[i % 4].max(*x));
        let ([x, y, z, _], [to_x, to_y, to_z, widest]) = (lo, hi);
        BallBounds { lo: [x, y, z], hi: [to_x, to_y, to_z], widest: widest.max(0.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_ball_counts_in_every_tier() {
        for n in [0, 1, 3, 4, 5, 16, 37] {
            for extreme in 0..n {
                let mut balls = vec![[0.5, 0.25, -0.5, 1.0]; n];
                balls[extreme] = [3.0, -4.0, 5.0, 6.0];
                for tier in Tier::available() {
                    let bounds = BallBounds::of(tier, &balls);
                    let alone = BallBounds::of(tier, &balls[extreme..=extreme]);
                    let [lo, hi] = match n {
                        1 => [[3.0, -4.0, 5.0]; 2],
                        _ => [[0.5, -4.0, -0.5], [3.0, 0.25, 5.0]],
                    };
                    let widest = 6.0;
                    assert_eq!(bounds, BallBounds { lo, hi, widest }, "{tier}, {extreme} of {n}");
                    assert_eq!(bounds.union(alone), bounds);
                    assert_eq!(BallBounds::EMPTY.union(bounds), bounds);
                }
            }
        }
        assert_eq!(BallBounds::of(Tier::SCALAR, &[]), BallBounds::EMPTY);
    }
}
