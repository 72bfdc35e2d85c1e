//! What culling costs: the paper's formula (equation 1) T = Nu·Cu + Nv·Cv + Co.
//!
//! Nu and Nv are [counted](crate::counters); Cu, Cv and Co are calibrated here.

pub mod calibrate;
mod fit;
pub mod predict;

use serde::Serialize;

use crate::counters::VolumeCounters;

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

#[cfg(test)]
mod tests {
    use super::*;

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
