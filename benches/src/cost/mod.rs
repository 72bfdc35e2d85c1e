//! What culling costs: the paper's formula (equation 1) T = Nu·Cu + Nv·Cv + Co.
//!
//! Nu and Nv are [counted](crate::measure::counts); Cu, Cv and Co are [calibrated](calibrate) in
//! the same [`pass`](mod@pass) as the frames that they predict, on other scenes.

pub mod calibrate;
mod explain;
mod fit;
pub mod pass;
pub mod predict;
pub mod study;
pub mod table;

use serde::{Deserialize, Serialize};

use sdop::counters::VolumeCounters;

/// The prices of one volume, in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct VolumeCosts {
    /// Co: building the volume of every shape and an empty culler, once.
    pub construct: f64,
    /// Cu: one update.
    pub update: f64,
    /// Co: what each body adds to building the culler.
    pub construct_body: f64,
    /// Per frame, whatever the number of bodies.
    pub frame: f64,
    /// Pair finding, per body and frame: arranging it for the finder and running over its
    /// candidates.
    pub body: f64,
    /// Pair finding, per pair that the first of two tests lets through: listing it for the second,
    /// and with an object of interest selecting and merging it.
    pub handle: f64,
    /// Cv of a pair that survives.
    pub hit: f64,
    /// Cv of a pair that is culled; it may leave at its first separating axis.
    pub miss: f64,
}

impl VolumeCosts {
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
        assert_eq!(costs.update(&counters), 20.0);
        assert_eq!(costs.test(&counters), 15.0 + 12.0);
    }
}
