//! What culling costs: the counters, and the paper's formula (equation 1) T = Nu·Cu + Nv·Cv + Co.
//!
//! Nu and Nv are counted here; Cu, Cv and Co are calibrated elsewhere. A test counts when a candidate pair is handed to
//! it, so counts are equal on every CPU, tier and thread count.

pub mod calibrate;
mod fit;
pub mod machine;
pub mod measure;
pub mod predict;

use serde::Serialize;

/// Work done on one volume. Sums over frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct VolumeCounters {
    /// Nu: volumes updated.
    pub updates: u64,
    /// Nv: pairs tested.
    pub tests: u64,
    /// Pairs that the test let through.
    pub hits: u64,
}

/// All counters of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Bounding spheres.
    pub sphere: VolumeCounters,
    /// or-DOPs.
    pub ordop: VolumeCounters,
    /// World-aligned boxes.
    pub aabb: VolumeCounters,
    /// World-aligned k-DOPs.
    pub kdop: VolumeCounters,
    /// Oriented boxes.
    pub obb: VolumeCounters,
    /// Pairs reported untested because the budget had ended.
    pub untested: u64,
    /// Pairs reported.
    pub reported: u64,
}

/// Wall time by stage, in seconds. Sums over frames, except for `construct`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Seconds {
    /// Co: building every volume, once.
    pub construct: f64,
    /// The scene's effects; not part of culling.
    pub effects: f64,
    /// World-space updates.
    pub update: f64,
    /// Finding candidates and the first volume test.
    pub pair_finding: f64,
    /// or-DOP tests (with `s-dop-sequential`, measured a block of pairs at a time).
    pub ordop: f64,
    /// Culling: update, pair finding and or-DOP tests. Without construction and effects.
    pub total: f64,
}

impl Seconds {
    /// What was added since `before`.
    #[must_use]
    pub fn since(&self, before: &Self) -> Self {
        Self {
            construct: self.construct - before.construct,
            effects: self.effects - before.effects,
            update: self.update - before.update,
            pair_finding: self.pair_finding - before.pair_finding,
            ordop: self.ordop - before.ordop,
            total: self.total - before.total,
        }
    }
}

/// The prices of one volume, in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct VolumeCosts {
    /// Co: building the volume of every shape, once.
    pub construct: f64,
    /// Cu: one update.
    pub update: f64,
    /// Pair finding, a frame: what it costs whatever the number of bodies.
    pub frame: f64,
    /// Pair finding, a body and frame: arranging it for the finder and running over its candidates.
    pub body: f64,
    /// Cv of a pair that survives.
    pub hit: f64,
    /// Cv of a pair that is culled; it may leave at its first separating axis.
    pub miss: f64,
}

impl VolumeCosts {
    /// Nu·Cu + Nv·Cv with Cv split into hits and misses.
    #[must_use]
    pub fn predict(&self, counters: &VolumeCounters) -> f64 {
        self.update(counters) + self.test(counters)
    }

    /// Nu·Cu.
    #[must_use]
    pub fn update(&self, counters: &VolumeCounters) -> f64 {
        counters.updates as f64 * self.update
    }

    /// Nv·Cv.
    #[must_use]
    pub fn test(&self, counters: &VolumeCounters) -> f64 {
        let misses = counters.tests - counters.hits;
        counters.hits as f64 * self.hit + misses as f64 * self.miss
    }
}

/// Unordered pairs of `bodies` bodies that are not both static: all-pairs' Nv a frame.
#[must_use]
pub const fn pair_count(bodies: u64, statics: u64) -> u64 {
    (bodies * bodies.saturating_sub(1) - statics * statics.saturating_sub(1)) / 2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_of_two_statics_do_not_count() {
        assert_eq!(pair_count(0, 0), 0);
        assert_eq!(pair_count(5, 0), 10);
        assert_eq!(pair_count(5, 2), 9);
        assert_eq!(pair_count(5, 5), 0);
        assert_eq!(pair_count(1_000_000, 1), 499_999_500_000);
    }

    #[test]
    fn prediction_prices_hits_and_misses_apart() {
        let costs = VolumeCosts {
            update: 2.0,
            hit: 5.0,
            miss: 3.0,
            ..VolumeCosts::default()
        };
        let counters = VolumeCounters {
            updates: 10,
            tests: 7,
            hits: 3,
        };
        assert_eq!(costs.predict(&counters), 20.0 + 15.0 + 12.0);
    }
}
