//! The formula as a prediction: counts of a run times prices from other runs.
//!
//! > T = Co + Nu·Cu + F + Nv·Cv, summed over a variant's volumes
//!
//! is the paper's equation 1 with F, pair finding, as a separate stage. F has a price per frame,
//! per body, per body that has hits, and per pair that is passed to a second test. (Such a pair is
//! listed; with an object of interest it is also selected and merged.) Cv has separate prices for
//! hits and for misses, and for world-aligned volumes a third, for slabs after the first.

use serde::{Deserialize, Serialize};

use super::expected;
use super::level::CacheLevel;
use super::terms::Terms;
use super::{PRICES, VolumeCosts};
use crate::measure::counts::{Counts, Volume};

/// Prices of one volume.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Price {
    /// The volume.
    #[serde(rename = "name")]
    pub volume: Volume,
    /// Its prices.
    #[serde(flatten)]
    pub costs: VolumeCosts,
}

/// Prices of one variant's volumes, in the order of its tests.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Prices {
    /// The variant's name.
    pub variant: String,
    /// The level of the working set for which they hold.
    pub level: CacheLevel,
    /// Lanes of a vector of the tier for which they hold.
    pub lanes: usize,
    /// The prices of each volume.
    pub volumes: Vec<Price>,
}

/// The quantities per frame that determine the time of a first test.
#[derive(Clone, Copy, Debug)]
pub(super) struct FirstTest {
    bodies: f64,
    rows: f64,
    tests: f64,
    hits: f64,
    /// Whether it compares world-aligned slabs one after the other.
    is_aligned: bool,
}

impl FirstTest {
    /// The counts of a volume in `frames` frames of `bodies` bodies.
    pub fn of(volume: Volume, counts: &Counts, frames: f64, bodies: f64) -> Self {
        let counters = counts.of(volume);
        let [moving, tests, hits] =
            [counters.updates, counters.tests, counters.hits].map(|count| count as f64 / frames);
        // Oriented volumes have no first test: each candidate is listed. World-aligned ones list as
        // spheres do, which is lost among their slabs: times don't tell its price.
        let (lists_hits, is_aligned) = match volume {
            Volume::Sphere => (true, false),
            Volume::Aabb | Volume::KDop => (false, true),
            Volume::OrDop | Volume::Obb | Volume::Hull => (false, false),
        };
        Self {
            bodies,
            rows: if lists_hits { expected::rows(moving, bodies, tests, hits) } else { 0.0 },
            tests,
            hits,
            is_aligned,
        }
    }

    /// Frames, bodies, bodies with hits, misses, hits, further slabs.
    pub fn counts(&self, lanes: usize) -> [f64; 6] {
        let further = if self.is_aligned {
            self.tests * expected::further(self.tests, self.hits, lanes)
        } else {
            0.0
        };
        let misses = self.tests - self.hits;
        [1.0, self.bodies, self.rows, misses, self.hits, further]
    }
}

impl Prices {
    /// Predicts the terms of each volume for a run of `frames` frames of `bodies` bodies from its
    /// counts.
    #[must_use]
    pub fn predict(&self, counts: &Counts, frames: u32, bodies: usize) -> Vec<Terms> {
        let (frames, bodies) = (f64::from(frames), bodies as f64);
        let terms = |(place, price): (usize, &Price)| {
            let (costs, counters) = (&price.costs, counts.of(price.volume));
            let first = FirstTest::of(price.volume, counts, frames, bodies);
            let [_, _, rows, misses, hits, further] = first.counts(self.lanes);
            // All pairs that pass the test before, whether they are then tested or not.
            let before = place.checked_sub(1).and_then(|before| self.volumes.get(before));
            let handed_on = before.map_or(0, |before| counts.of(before.volume).hits);
            let idle = match (place, price.volume) {
                (1.., Volume::OrDop) => expected::idle(first.tests, self.lanes),
                _ => 0.0,
            };
            Terms {
                volume: price.volume,
                updates: counters.updates as f64 / frames,
                tests: first.tests,
                hits,
                rows,
                further,
                construct: costs.construct + bodies * costs.construct_body,
                update: costs.update * counters.updates as f64 / frames,
                finding: costs.frame
                    + bodies * costs.body
                    + rows * costs.row
                    + handed_on as f64 / frames * costs.handle
                    + idle * costs.miss,
                test: hits * costs.hit + misses * costs.miss + further * costs.further,
            }
        };
        self.volumes.iter().enumerate().map(terms).collect()
    }

    /// The mean of several rounds' prices. `None` without rounds.
    #[must_use]
    pub fn mean<'a>(rounds: impl Iterator<Item = &'a Self> + Clone) -> Option<Self> {
        let mut mean = rounds.clone().next()?.clone();
        let n = rounds.clone().count() as f64;
        for (at, price) in mean.volumes.iter_mut().enumerate() {
            for kind in PRICES {
                let sum: f64 =
                    rounds.clone().map(|round| kind.value(round.volumes[at].costs)).sum();
                *(kind.of)(&mut price.costs) = sum / n;
            }
        }
        Some(mean)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sdop::counters::{Counters, VolumeCounters};

    /// S dop pays for both volumes and finds pairs once.
    #[test]
    fn s_dop_pays_for_both_volumes() {
        let costs = |frame, hit, handle| VolumeCosts {
            construct: 100.0,
            construct_body: 1.0,
            update: 2.0,
            frame,
            body: 0.5 * frame,
            handle,
            hit,
            miss: 1.0,
            ..VolumeCosts::default()
        };
        let price = |volume, costs| Price { volume, costs };
        let prices = Prices {
            variant: String::new(),
            level: CacheLevel::L1,
            lanes: 1,
            volumes: vec![
                price(Volume::Sphere, costs(10.0, 1.0, 0.0)),
                price(Volume::OrDop, costs(0.0, 7.0, 3.0)),
            ],
        };
        let volume = |updates, tests, hits| VolumeCounters { updates, tests, hits };
        let counts = Counts {
            culler: Counters {
                sphere: volume(8, 12, 4),
                ordop: volume(8, 4, 3),
                ..Counters::default()
            },
            hulls: VolumeCounters::default(),
        };
        let terms = prices.predict(&counts, 2, 4);
        let parts: Vec<_> =
            terms.iter().map(|t| [t.construct, t.update, t.finding, t.test]).collect();
        // Each frame has two of the four listed pairs: 10 + 4·5, and 2·3 for the second test.
        assert_eq!(parts, [[104.0, 8.0, 30.0, 6.0], [104.0, 8.0, 6.0, 11.0]]);
        assert_eq!(terms[0].recurring(), 44.0);
        assert_eq!(terms[0].in_paper(), 14.0);
        let none = Prices { volumes: Vec::new(), ..prices.clone() };
        assert!(none.predict(&counts, 2, 4).is_empty());
    }

    /// Each price is multiplied by its own count and by no other.
    #[test]
    fn every_price_has_one_count() {
        let counters = VolumeCounters { updates: 300, tests: 9000, hits: 700 };
        let counts = Counts {
            culler: Counters { sphere: counters, aabb: counters, ..Counters::default() },
            hulls: VolumeCounters::default(),
        };
        let seconds = |volume, costs| {
            let prices = Prices {
                variant: String::new(),
                level: CacheLevel::L1,
                lanes: 16,
                volumes: vec![Price { volume, costs }],
            };
            let terms = prices.predict(&counts, 10, 40);
            terms.iter().map(Terms::recurring).sum::<f64>()
        };
        let price = |set: fn(&mut VolumeCosts)| {
            let mut costs = VolumeCosts::default();
            set(&mut costs);
            costs
        };
        let rows = expected::rows(30.0, 40.0, 900.0, 70.0);
        let further = 900.0 * expected::further(900.0, 70.0, 16);
        for (costs, of_spheres, of_boxes) in [
            (price(|c| c.update = 1.0), 30.0, 30.0),
            (price(|c| c.frame = 1.0), 1.0, 1.0),
            (price(|c| c.body = 1.0), 40.0, 40.0),
            (price(|c| c.hit = 1.0), 70.0, 70.0),
            (price(|c| c.miss = 1.0), 830.0, 830.0),
            (price(|c| c.row = 1.0), rows, 0.0),
            (price(|c| c.further = 1.0), 0.0, further),
        ] {
            for (volume, count) in [(Volume::Sphere, of_spheres), (Volume::Aabb, of_boxes)] {
                assert!((seconds(volume, costs) - count).abs() < 1e-9, "{volume} {costs:?}");
            }
        }
    }
}
