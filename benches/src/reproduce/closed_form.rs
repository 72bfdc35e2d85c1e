//! The closed form of the sphere percentage, without a simulation.
//!
//! Two points uniform in a cube of side L are within 2r of each other with probability
//!
//! > P(s) = (4/3)πs³ − (3/2)πs⁴ + (8/5)s⁵ − s⁶/6, s = 2r/L ≤ 1
//!
//! (the cube's distance distribution; Philip 2007). A body turns round when its sphere reaches a
//! wall, so centres are in a cube with L = side − 2r. Straight motion with elastic walls keeps them
//! uniform there, and static bodies are placed uniformly. N does not occur in the formula: a box
//! that stays the same for all N has one sphere percentage.

use std::f64::consts::PI;

/// P(s), for s in [0, 1].
#[must_use]
pub fn probability(s: f64) -> f64 {
    let (s2, s3) = (s * s, s * s * s);
    s3 * (4.0 / 3.0 * PI - 1.5 * PI * s + 1.6 * s2 - s3 / 6.0)
}

/// The s at which P(s) is `p`, by bisection: P grows on [0, 1].
#[must_use]
pub fn inverse(p: f64) -> f64 {
    let (mut lo, mut hi) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (lo + hi);
        if probability(middle) < p { lo = middle } else { hi = middle }
    }
    0.5 * (lo + hi)
}

/// s = 2r/L of a box of side `side` whose bodies have radius `radius`.
#[must_use]
pub fn relative_reach(side: f64, radius: f64) -> f64 {
    2.0 * radius / (side - 2.0 * radius)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Stream;

    #[test]
    fn probability_is_that_of_drawn_points() {
        let mut draws = Stream::new(3, 0);
        let n = 400_000;
        for s in [0.14, 0.25, 0.6, 1.0] {
            let mut near = 0;
            for _ in 0..n {
                let d2: f32 = (0..3).map(|_| (draws.unit() - draws.unit()).powi(2)).sum();
                near += i32::from(f64::from(d2) <= s * s);
            }
            let (p, seen) = (probability(s), f64::from(near) / f64::from(n));
            let error = (p * (1.0 - p) / f64::from(n)).sqrt();
            assert!((seen - p).abs() < 4.0 * error, "s = {s}: {seen} for {p}");
        }
    }

    /// The paper's row inverts to a seventh or an eighth.
    #[test]
    fn paper_row_inverts_to_box_size() {
        let s = [0.0076, 0.0082, 0.0094, 0.0106].map(inverse);
        for (s, expected) in s.iter().zip([0.128, 0.132, 0.138, 0.144]) {
            assert!((s - expected).abs() < 5e-4, "{s} for {expected}");
            assert!((probability(*s) - probability(expected)).abs() < 1e-4);
        }
    }
}
