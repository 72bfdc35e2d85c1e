//! The formula as a prediction: counts of a run times prices from other runs.
//!
//! > T = Co + Nu·Cu + F + Nv·Cv, summed over a strategy's volumes
//!
//! is the paper's equation 1 with F, pair finding, as a stage of its own: a price a frame and one a body and frame.
//! Cv is two prices, for hits and for misses.

use serde::Serialize;

use super::VolumeCosts;
use crate::choice::choices;
use crate::counters::{Counters, VolumeCounters};
use crate::settings::Strategy;

choices! {
    /// What has prices of its own.
    Volume, "volume", {
        /// Bounding spheres.
        Sphere = "sphere",
        /// or-DOPs as the first test: every candidate pair.
        OrDop = "or-dop",
        /// or-DOPs of pairs whose spheres overlap: nearer pairs, nearly half of them hits.
        Refined = "or-dop after sphere",
        /// World-aligned boxes.
        Aabb = "aabb",
        /// World-aligned k-DOPs.
        KDop = "k-dop",
        /// Oriented boxes.
        Obb = "obb",
    }
}

impl Volume {
    /// The volumes of a strategy, in the order of its tests.
    #[must_use]
    pub fn of(strategy: Strategy) -> &'static [Self] {
        match strategy {
            Strategy::None => &[],
            Strategy::Sphere => &[Self::Sphere],
            Strategy::OrDop => &[Self::OrDop],
            Strategy::SDopSequential
            | Strategy::SDopBatch
            | Strategy::SDopObjectOfInterest
            | Strategy::SDopTimeCritical => &[Self::Sphere, Self::Refined],
            Strategy::Aabb => &[Self::Aabb],
            Strategy::KDop => &[Self::KDop],
            Strategy::Obb => &[Self::Obb],
        }
    }

    /// The volume's counters among those of a run.
    #[must_use]
    pub fn counters(self, run: &Counters) -> VolumeCounters {
        match self {
            Self::Sphere => run.sphere,
            Self::OrDop | Self::Refined => run.ordop,
            Self::Aabb => run.aabb,
            Self::KDop => run.kdop,
            Self::Obb => run.obb,
        }
    }
}

/// Prices of one volume.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Price {
    /// The volume.
    #[serde(rename = "name")]
    pub volume: Volume,
    /// Its prices.
    #[serde(flatten)]
    pub costs: VolumeCosts,
}

/// All prices known.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Prices(pub Vec<Price>);

/// The terms of the formula for one volume in one run, in seconds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Terms {
    /// The volume.
    #[serde(rename = "name")]
    pub volume: Volume,
    /// Co.
    pub construct: f64,
    /// Nu·Cu.
    pub update: f64,
    /// F: pair finding.
    pub finding: f64,
    /// Nv·Cv.
    pub test: f64,
}

impl Terms {
    /// Adds the terms of another run.
    pub fn add(&mut self, other: &Self) {
        self.construct += other.construct;
        self.update += other.update;
        self.finding += other.finding;
        self.test += other.test;
    }

    /// What recurs: all but the construction.
    #[must_use]
    pub fn recurring(&self) -> f64 {
        self.update + self.finding + self.test
    }
}

impl Prices {
    /// The prices of a volume; free when it was not calibrated.
    #[must_use]
    pub fn get(&self, volume: Volume) -> VolumeCosts {
        let found = self.0.iter().find(|price| price.volume == volume);
        found.map_or_else(VolumeCosts::default, |price| price.costs)
    }

    /// Predicts a run of `frames` frames of `bodies` bodies from its counters: the terms of each of the strategy's volumes.
    #[must_use]
    pub fn predict(
        &self,
        strategy: Strategy,
        run: &Counters,
        frames: u32,
        bodies: usize,
    ) -> Vec<Terms> {
        let (frames, bodies) = (f64::from(frames), bodies as f64);
        let terms = |&volume: &Volume| {
            let (costs, counters) = (self.get(volume), volume.counters(run));
            Terms {
                volume,
                construct: costs.construct,
                update: costs.update(&counters),
                finding: frames * (costs.frame + bodies * costs.body),
                test: costs.test(&counters),
            }
        };
        Volume::of(strategy).iter().map(terms).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn s_dop_pays_for_both_volumes_and_finds_pairs_once() {
        let costs = |frame, hit| VolumeCosts {
            construct: 100.0,
            update: 2.0,
            frame,
            body: 0.5 * frame,
            hit,
            miss: 1.0,
        };
        let price = |volume, costs| Price { volume, costs };
        let prices = Prices(vec![
            price(Volume::Sphere, costs(10.0, 1.0)),
            price(Volume::Refined, costs(0.0, 7.0)),
        ]);
        let volume = |updates, tests, hits| VolumeCounters {
            updates,
            tests,
            hits,
        };
        let run = Counters {
            sphere: volume(8, 12, 4),
            ordop: volume(8, 4, 3),
            ..Counters::default()
        };
        let terms = prices.predict(Strategy::SDopSequential, &run, 2, 4);
        let parts: Vec<_> = terms
            .iter()
            .map(|t| [t.construct, t.update, t.finding, t.test])
            .collect();
        assert_eq!(parts, [[100.0, 16.0, 60.0, 12.0], [100.0, 16.0, 0.0, 22.0]]);
        assert_eq!(terms[0].recurring() + terms[1].recurring(), 126.0);
        assert!(prices.predict(Strategy::None, &run, 2, 4).is_empty());
    }
}
