//! The formula as a prediction: counts of a run times prices from other runs.
//!
//! > T = Co + Nu·Cu + F + Nv·Cv, summed over a variant's volumes
//!
//! is the paper's equation 1 with F, pair finding, as a stage of its own: a price per frame, one
//! per body and frame, and one per pair that goes on to a second test: it is listed, and with an
//! object of interest selected and merged. Cv is two prices, for hits and for misses.

use serde::{Deserialize, Serialize};

use super::VolumeCosts;
use crate::measure::counts::{Counts, Volume};
use crate::measure::estimate::{Estimate, or_infinite};

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
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Prices {
    /// The variant's name.
    pub variant: String,
    /// A price a volume.
    pub volumes: Vec<Price>,
}

/// The terms of the formula for one volume: seconds per frame, but for `construct`, which is paid
/// once.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Terms {
    /// The volume.
    #[serde(rename = "name")]
    pub volume: Volume,
    /// Nu per frame.
    pub updates: f64,
    /// Nv per frame.
    pub tests: f64,
    /// Of which so many hit, per frame.
    pub hits: f64,
    /// Co: its part of the construction, in seconds, once.
    pub construct: f64,
    /// Nu·Cu.
    pub update: f64,
    /// F: pair finding.
    pub finding: f64,
    /// Nv·Cv.
    pub test: f64,
}

/// Half-widths of the intervals over passes of one volume's [`Terms`], in the same units; infinite
/// for one pass.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TermWidths {
    /// The volume.
    #[serde(rename = "name")]
    pub volume: Volume,
    /// Of Nu per frame.
    #[serde(deserialize_with = "or_infinite")]
    pub updates: f64,
    /// Of Nv per frame.
    #[serde(deserialize_with = "or_infinite")]
    pub tests: f64,
    /// Of the hits per frame.
    #[serde(deserialize_with = "or_infinite")]
    pub hits: f64,
    /// Of Co.
    #[serde(deserialize_with = "or_infinite")]
    pub construct: f64,
    /// Of Nu·Cu.
    #[serde(deserialize_with = "or_infinite")]
    pub update: f64,
    /// Of F.
    #[serde(deserialize_with = "or_infinite")]
    pub finding: f64,
    /// Of Nv·Cv.
    #[serde(deserialize_with = "or_infinite")]
    pub test: f64,
}

impl TermWidths {
    /// Of one volume's terms, pass by pass in the order of time; `None` of none.
    #[must_use]
    pub fn of(passes: &[Terms]) -> Option<Self> {
        let volume = passes.first()?.volume;
        let over = |term: fn(&Terms) -> f64| {
            let values: Vec<f64> = passes.iter().map(term).collect();
            Estimate::in_order(&values).half_width
        };
        Some(Self {
            volume,
            updates: over(|t| t.updates),
            tests: over(|t| t.tests),
            hits: over(|t| t.hits),
            construct: over(|t| t.construct),
            update: over(|t| t.update),
            finding: over(|t| t.finding),
            test: over(|t| t.test),
        })
    }
}

impl Terms {
    /// What recurs each frame: all but the construction.
    #[must_use]
    pub fn recurring(&self) -> f64 {
        self.update + self.finding + self.test
    }

    /// What the paper's equation has of it: without F.
    #[must_use]
    pub fn in_paper(&self) -> f64 {
        self.update + self.test
    }

    /// The mean of one volume's terms over passes; `None` of none.
    #[must_use]
    pub fn mean(passes: &[Self]) -> Option<Self> {
        let volume = passes.first()?.volume;
        let over =
            |term: fn(&Self) -> f64| passes.iter().map(term).sum::<f64>() / passes.len() as f64;
        Some(Self {
            volume,
            updates: over(|t| t.updates),
            tests: over(|t| t.tests),
            hits: over(|t| t.hits),
            construct: over(|t| t.construct),
            update: over(|t| t.update),
            finding: over(|t| t.finding),
            test: over(|t| t.test),
        })
    }
}

impl Prices {
    /// Predicts a run of `frames` frames of `bodies` bodies from what it counted: the terms of each
    /// volume.
    #[must_use]
    pub fn predict(&self, counts: &Counts, frames: u32, bodies: usize) -> Vec<Terms> {
        let (frames, bodies) = (f64::from(frames), bodies as f64);
        let refines = self.volumes.len() > 1;
        let terms = |(place, price): (usize, &Price)| {
            let (costs, counters) = (&price.costs, counts.of(price.volume));
            // All that the first test lets through, whether the second then tests it or not.
            let handed_on = if place == 0 && refines {
                counters.hits as f64 / frames
            } else {
                0.0
            };
            Terms {
                volume: price.volume,
                updates: counters.updates as f64 / frames,
                tests: counters.tests as f64 / frames,
                hits: counters.hits as f64 / frames,
                construct: costs.construct + bodies * costs.construct_body,
                update: costs.update(&counters) / frames,
                finding: costs.frame + bodies * costs.body + handed_on * costs.handle,
                test: costs.test(&counters) / frames,
            }
        };
        self.volumes.iter().enumerate().map(terms).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sdop::counters::{Counters, VolumeCounters};

    #[test]
    fn widths_are_those_of_intervals_over_passes() {
        let pass = |update: f64| Terms {
            volume: Volume::Sphere,
            updates: 3.0,
            tests: 4.0,
            hits: 1.0,
            construct: 9.0,
            update,
            finding: 0.0,
            test: 5.0,
        };
        // Student's quantile for one degree of freedom is 12.706; the standard error of 1 and 3 is
        // 1.
        let widths = TermWidths::of(&[pass(1.0), pass(3.0)]).map(|w| [w.update, w.test]);
        let [update, test] = widths.unwrap_or_default();
        assert!((update - 12.706).abs() < 1e-3 && test == 0.0, "{widths:?}");
        assert!(TermWidths::of(&[]).is_none());
        // JSON has no infinity: one pass reads back.
        let one = TermWidths::of(&[pass(1.0)]);
        let text = serde_json::to_string(&one).unwrap_or_default();
        assert_eq!(
            serde_json::from_str::<Option<TermWidths>>(&text).ok(),
            Some(one)
        );
    }

    #[test]
    fn s_dop_pays_for_both_volumes_and_finds_pairs_once() {
        let costs = |frame, hit, handle| VolumeCosts {
            construct: 100.0,
            construct_body: 1.0,
            update: 2.0,
            frame,
            body: 0.5 * frame,
            handle,
            hit,
            miss: 1.0,
        };
        let price = |volume, costs| Price { volume, costs };
        let prices = Prices {
            variant: String::new(),
            volumes: vec![
                price(Volume::Sphere, costs(10.0, 1.0, 3.0)),
                price(Volume::OrDop, costs(0.0, 7.0, 0.0)),
            ],
        };
        let volume = |updates, tests, hits| VolumeCounters {
            updates,
            tests,
            hits,
        };
        let counts = Counts {
            culler: Counters {
                sphere: volume(8, 12, 4),
                ordop: volume(8, 4, 3),
                ..Counters::default()
            },
            hulls: VolumeCounters::default(),
        };
        let terms = prices.predict(&counts, 2, 4);
        let parts: Vec<_> = terms
            .iter()
            .map(|t| [t.construct, t.update, t.finding, t.test])
            .collect();
        // Two of the four listed pairs are of each frame: 10 + 4·5 + 2·3.
        assert_eq!(parts, [[104.0, 8.0, 36.0, 6.0], [104.0, 8.0, 0.0, 11.0]]);
        assert_eq!(terms[0].recurring(), 50.0);
        assert_eq!(terms[0].in_paper(), 14.0);
        assert!(Prices::default().predict(&counts, 2, 4).is_empty());
    }
}
