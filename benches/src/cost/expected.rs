//! Expected values from the counts of a frame, if its hits are spread evenly: the number of bodies
//! with a hit, and the number of slabs that vectors of tests compare.
//!
//! Cullers count tests and hits. Their time depends on two more numbers, because pairs are tested a
//! vector at a time: hits are listed by the vector for each body, and world-aligned slabs are
//! compared until all lanes of the vector are separated. Both are expected values for hits that are
//! independent of each other. If hits gather (clusters, a floor), fewer bodies have them.

use sdop::simd::{Kernel, Lanes, Tier, dispatch};

/// The number of lanes of a tier's vectors.
pub(super) fn lanes(tier: Tier) -> usize {
    struct LaneWidth;
    impl Kernel for LaneWidth {
        type Output = usize;
        #[inline(always)]
        fn run<L: Lanes>(self, _: L) -> usize {
            L::WIDTH
        }
    }
    dispatch(tier, LaneWidth)
}

/// The number of moving bodies with a hit, if the candidates of each are the bodies after it,
/// static ones last: Σ 1 − e^−λ, where λ, a body's expected number of hits, decreases linearly.
pub(super) fn rows(moving: f64, bodies: f64, tests: f64, hits: f64) -> f64 {
    if moving <= 0.0 || hits <= 0.0 {
        return 0.0;
    }
    let share = hits / tests;
    let [most, least] = [bodies, bodies - moving].map(|after| share * after);
    moving * (1.0 - ((-least).exp() - (-most).exp()) / (most - least))
}

/// The mean number of slabs after the first on which a test is compared: a vector continues while
/// one of its lanes overlaps on all slabs so far. For the three axes of a box, the logarithm of
/// that probability is a third, two thirds and all of that of a hit.
pub(super) fn further(tests: f64, hits: f64, lanes: usize) -> f64 {
    if tests <= 0.0 {
        return 0.0;
    }
    let share = (hits / tests).clamp(0.0, 1.0);
    let goes_on = |axes: f64| 1.0 - (1.0 - share.powf(axes / 3.0)).powi(lanes as i32);
    goes_on(1.0) + goes_on(2.0)
}

/// The mean number of idle lanes in the vectors of this number of tests, over frames whose numbers
/// of tests scatter as counts do.
pub(super) fn idle(tests: f64, lanes: usize) -> f64 {
    let width = lanes as f64;
    if tests > 16.0 * width {
        // The last test is equally likely at each lane.
        return 0.5 * (width - 1.0);
    }
    // Each P(count = k) from the one before; a vector begins with its first test.
    let (mut probability, mut at_most, mut vectors) = ((-tests).exp(), 0.0, 0.0);
    for count in 0..64 * lanes {
        at_most += probability;
        if count % lanes == 0 {
            vectors += 1.0 - at_most;
        }
        probability *= tests / (count as f64 + 1.0);
    }
    (width * vectors - tests).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Stream;

    /// Rows are those of hits drawn at random.
    #[test]
    fn rows_match_random_draws() {
        let (moving, bodies) = (80, 100);
        let mut draws = Stream::new(7, 0);
        for share in [0.001, 0.01, 0.1] {
            let (mut tests, mut hits, mut rows_seen) = (0_u32, 0_u32, 0_u32);
            let rounds = 400;
            for _ in 0..rounds {
                for i in 0..moving {
                    let found = (i + 1..bodies).filter(|_| draws.unit() < share).count() as u32;
                    tests += bodies - 1 - i;
                    hits += found;
                    rows_seen += u32::from(found > 0);
                }
            }
            let per = |count: u32| f64::from(count) / f64::from(rounds);
            let expected = rows(f64::from(moving), f64::from(bodies), per(tests), per(hits));
            let seen = per(rows_seen);
            assert!((expected / seen - 1.0).abs() < 0.03, "{share}: {expected} for {seen}");
        }
        assert_eq!(rows(10.0, 10.0, 45.0, 0.0), 0.0);
    }

    /// Vectors go on for as long as a lane does.
    #[test]
    fn vectors_continue_until_last_lane() {
        let mut draws = Stream::new(8, 0);
        for (lanes, axis) in [(1, 0.3), (8, 0.1), (16, 0.05), (16, 0.3)] {
            let (vectors, mut compared) = (20_000, 0_u32);
            for _ in 0..vectors {
                let mut alive = lanes;
                for _ in 0..2 {
                    alive = (0..alive).filter(|_| draws.unit() < axis).count();
                    compared += u32::from(alive > 0);
                }
            }
            let seen = f64::from(compared) / f64::from(vectors);
            let share = f64::from(axis).powi(3);
            let expected = further(1.0, share, lanes);
            assert!((expected / seen - 1.0).abs() < 0.05, "{axis}: {expected} for {seen}");
        }
        assert_eq!(further(0.0, 0.0, 16), 0.0);
    }

    /// A few tests leave most of a vector idle.
    #[test]
    fn few_tests_idle_most_lanes() {
        assert_eq!(idle(0.0, 16), 0.0);
        assert!((idle(5.0, 1)).abs() < 1e-6);
        // There is one vector if there is a test, which has the probability 1 − e^−λ.
        let rare: f64 = 0.01;
        assert!((idle(rare, 16) - (16.0 * (1.0 - (-rare).exp()) - rare)).abs() < 1e-9);
        for tests in [200.0, 800.0, 5000.0] {
            assert!((idle(tests, 16) - 7.5).abs() < 0.2, "{}", idle(tests, 16));
        }
    }

    #[test]
    fn lanes_are_the_tier_s() {
        assert_eq!(lanes(Tier::SCALAR), 1);
        assert!([1, 4, 8, 16].contains(&lanes(Tier::detect())));
    }
}
