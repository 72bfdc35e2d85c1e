//! The paper's equation 1, T = Nu·Cu + Nv·Cv + Co, with Cv split into hits and misses.

/// The counts of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Sphere pairs tested.
    pub sphere_tests: u64,
    /// Sphere pairs that overlap: the potentially colliding set.
    pub sphere_hits: u64,
    /// or-DOP pairs tested.
    pub ordop_tests: u64,
    /// or-DOP pairs that overlap.
    pub ordop_hits: u64,
    /// Pairs of a single volume (`aabb`, `k-dop` or `obb`) tested.
    pub volume_tests: u64,
    /// Those that overlap.
    pub volume_hits: u64,
    /// Sphere hits reported without an or-DOP test, because the budget was spent.
    pub untested: u64,
    /// Pairs reported.
    pub reported: u64,
}

/// Nv of all pairs: N(N−1)/2 − S(S−1)/2 for N bodies of which S are static.
pub fn pair_tests(bodies: u64, static_bodies: u64) -> u64 {
    let pairs = |n: u64| n * n.saturating_sub(1) / 2;
    pairs(bodies) - pairs(static_bodies)
}

/// The prices of a volume in seconds: one update, one hit and one miss, and building it once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VolumeCost {
    /// Cu
    pub update: f64,
    /// Cv of a pair that overlaps.
    pub hit: f64,
    /// Cv of a pair that does not.
    pub miss: f64,
    /// Co
    pub construct: f64,
}

/// T = Nu·Cu + hits·Cv(hit) + misses·Cv(miss) + Co in seconds.
pub fn total(updates: u64, hits: u64, misses: u64, cost: &VolumeCost) -> f64 {
    let times = |n: u64, c: f64| n as f64 * c;
    times(updates, cost.update) + times(hits, cost.hit) + times(misses, cost.miss) + cost.construct
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn static_pairs_are_not_tests() {
        assert_eq!(pair_tests(500, 100), 124_750 - 4_950);
        assert_eq!(pair_tests(0, 0), 0);
        assert_eq!(pair_tests(3, 3), 0);
    }

    #[test]
    fn total_is_linear_in_the_counts() {
        let cost = VolumeCost { update: 2.0, hit: 3.0, miss: 5.0, construct: 7.0 };
        assert_eq!(total(1, 10, 100, &cost), 2.0 + 30.0 + 500.0 + 7.0);
    }
}
