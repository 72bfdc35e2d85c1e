//! The box of ball centres and the widest ball: what a finder sizes its cells by.

/// Extremes over a set of balls. Without any, `lo` is above `hi`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lowest centre coordinates.
    pub lo: [f32; 3],
    /// Highest centre coordinates.
    pub hi: [f32; 3],
    /// Largest radius.
    pub widest: f32,
}

impl Bounds {
    /// Of no ball.
    pub const EMPTY: Self = Self {
        lo: [f32::INFINITY; 3],
        hi: [f32::NEG_INFINITY; 3],
        widest: 0.0,
    };

    /// Of some balls.
    #[must_use]
    #[inline(always)]
    pub fn of(balls: &[[f32; 4]]) -> Self {
        // Four accumulators of four numbers each: one coordinate's chain of minima would wait for itself.
        let mut lo = [[f32::INFINITY; 4]; 4];
        let mut hi = [[f32::NEG_INFINITY; 4]; 4];
        let (chunks, rest) = balls.as_chunks::<4>();
        for chunk in chunks {
            for k in 0..4 {
                for c in 0..4 {
                    lo[k][c] = lo[k][c].min(chunk[k][c]);
                    hi[k][c] = hi[k][c].max(chunk[k][c]);
                }
            }
        }
        for ball in rest {
            for c in 0..4 {
                lo[0][c] = lo[0][c].min(ball[c]);
                hi[0][c] = hi[0][c].max(ball[c]);
            }
        }
        for k in 1..4 {
            for c in 0..4 {
                lo[0][c] = lo[0][c].min(lo[k][c]);
                hi[0][c] = hi[0][c].max(hi[k][c]);
            }
        }
        let ([x, y, z, _], [to_x, to_y, to_z, widest]) = (lo[0], hi[0]);
        Self {
            lo: [x, y, z],
            hi: [to_x, to_y, to_z],
            widest: widest.max(0.0),
        }
    }

    /// Of both sets.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            lo: std::array::from_fn(|i| self.lo[i].min(other.lo[i])),
            hi: std::array::from_fn(|i| self.hi[i].max(other.hi[i])),
            widest: self.widest.max(other.widest),
        }
    }
}
