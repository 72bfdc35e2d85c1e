//! The terms of the formula for one volume, and the half-widths of their intervals.

use serde::{Deserialize, Serialize};

use crate::measure::counts::Volume;
use crate::measure::estimate::{Estimate, or_infinite};

/// The terms of the formula for one volume: seconds per frame, except `construct`, which is paid
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
    /// Tests that hit, per frame.
    pub hits: f64,
    /// Bodies that have a hit, per frame, as expected from the counts.
    #[serde(default)]
    pub rows: f64,
    /// Slabs after the first on which tests are compared, per frame, as expected from the counts.
    #[serde(default)]
    pub further: f64,
    /// Bodies that a world queries, per frame; these terms are those of its first volume.
    #[serde(default)]
    pub queried: f64,
    /// Those among them that it didn't query in the frame before.
    #[serde(default)]
    pub thawed: f64,
    /// Bodies that it keeps.
    #[serde(default)]
    pub kept: f64,
    /// Co: its part of the construction, in seconds, once.
    pub construct: f64,
    /// Nu·Cu.
    pub update: f64,
    /// F: pair finding.
    pub finding: f64,
    /// Nv·Cv.
    pub test: f64,
}

/// Half-widths of the intervals of one volume's [`Terms`] over passes, in the same units; infinite
/// for one pass.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TermWidths {
    /// The volume.
    #[serde(rename = "name")]
    pub volume: Volume,
    /// Half-width of Nu per frame.
    #[serde(deserialize_with = "or_infinite")]
    pub updates: f64,
    /// Half-width of Nv per frame.
    #[serde(deserialize_with = "or_infinite")]
    pub tests: f64,
    /// Half-width of the hits per frame.
    #[serde(deserialize_with = "or_infinite")]
    pub hits: f64,
    /// Half-width of Co.
    #[serde(deserialize_with = "or_infinite")]
    pub construct: f64,
    /// Half-width of Nu·Cu.
    #[serde(deserialize_with = "or_infinite")]
    pub update: f64,
    /// Half-width of F.
    #[serde(deserialize_with = "or_infinite")]
    pub finding: f64,
    /// Half-width of Nv·Cv.
    #[serde(deserialize_with = "or_infinite")]
    pub test: f64,
}

impl TermWidths {
    /// The half-widths of one volume's terms, given pass by pass in the order of time. `None`
    /// without passes.
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

    /// Adds the half-widths of another, independent cause.
    #[must_use]
    pub fn joined(&self, other: &Self) -> Self {
        let both = |width: fn(&Self) -> f64| width(self).hypot(width(other));
        Self {
            volume: self.volume,
            updates: both(|w| w.updates),
            tests: both(|w| w.tests),
            hits: both(|w| w.hits),
            construct: both(|w| w.construct),
            update: both(|w| w.update),
            finding: both(|w| w.finding),
            test: both(|w| w.test),
        }
    }
}

impl Terms {
    /// The part that recurs each frame: all but the construction.
    #[must_use]
    pub fn recurring(&self) -> f64 {
        self.update + self.finding + self.test
    }

    /// The part in the paper's equation: without F.
    #[must_use]
    pub fn in_paper(&self) -> f64 {
        self.update + self.test
    }

    /// The mean of one volume's terms over passes. `None` without passes.
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
            rows: over(|t| t.rows),
            further: over(|t| t.further),
            queried: over(|t| t.queried),
            thawed: over(|t| t.thawed),
            kept: over(|t| t.kept),
            construct: over(|t| t.construct),
            update: over(|t| t.update),
            finding: over(|t| t.finding),
            test: over(|t| t.test),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Widths are those of intervals over passes.
    #[test]
    fn widths_match_intervals_over_passes() {
        let pass = |update: f64| Terms {
            volume: Volume::Sphere,
            updates: 3.0,
            tests: 4.0,
            hits: 1.0,
            rows: 0.0,
            further: 0.0,
            queried: 0.0,
            thawed: 0.0,
            kept: 0.0,
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
        assert_eq!(serde_json::from_str::<Option<TermWidths>>(&text).ok(), Some(one));
    }
}
