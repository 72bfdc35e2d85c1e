//! The terms of the formula for one volume, and the half-widths of their intervals.

use serde::{Deserialize, Serialize};

use crate::measure::counts::Volume;
use crate::measure::estimate::{Estimate, or_infinite};

/// The terms of the formula for one volume, or the half-widths of their intervals: seconds per
/// frame, except `construct`, which is paid once.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Terms {
    /// The volume.
    #[serde(rename = "name")]
    pub volume: Volume,
    /// Nu per frame.
    #[serde(deserialize_with = "or_infinite")]
    pub updates: f64,
    /// Nv per frame.
    #[serde(deserialize_with = "or_infinite")]
    pub tests: f64,
    /// Tests that hit, per frame.
    #[serde(deserialize_with = "or_infinite")]
    pub hits: f64,
    /// Bodies that have a hit, per frame, as expected from the counts.
    #[serde(default, deserialize_with = "or_infinite")]
    pub rows: f64,
    /// Slabs after the first on which tests are compared, per frame, as expected from the counts.
    #[serde(default, deserialize_with = "or_infinite")]
    pub further: f64,
    /// Co: its part of the construction, in seconds, once.
    #[serde(deserialize_with = "or_infinite")]
    pub construct: f64,
    /// Nu·Cu.
    #[serde(deserialize_with = "or_infinite")]
    pub update: f64,
    /// F: pair finding.
    #[serde(deserialize_with = "or_infinite")]
    pub finding: f64,
    /// Nv·Cv.
    #[serde(deserialize_with = "or_infinite")]
    pub test: f64,
}

/// One number of some terms.
type Number = fn(&mut Terms) -> &mut f64;

/// All of them.
const NUMBERS: [Number; 9] = [
    |t| &mut t.updates,
    |t| &mut t.tests,
    |t| &mut t.hits,
    |t| &mut t.rows,
    |t| &mut t.further,
    |t| &mut t.construct,
    |t| &mut t.update,
    |t| &mut t.finding,
    |t| &mut t.test,
];

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
        Self::over(passes, |values| values.iter().sum::<f64>() / values.len() as f64)
    }

    /// The half-widths of one volume's terms, given pass by pass in the order of time; infinite for
    /// one pass. `None` without passes.
    #[must_use]
    pub fn widths(passes: &[Self]) -> Option<Self> {
        Self::over(passes, |values| Estimate::in_order(values).half_width)
    }

    fn over(passes: &[Self], statistic: fn(&[f64]) -> f64) -> Option<Self> {
        let mut result = *passes.first()?;
        for number in NUMBERS {
            let values: Vec<f64> = passes.iter().map(|pass| *number(&mut { *pass })).collect();
            *number(&mut result) = statistic(&values);
        }
        Some(result)
    }

    /// These half-widths with those of another, independent cause.
    #[must_use]
    pub fn joined(mut self, mut other: Self) -> Self {
        for number in NUMBERS {
            let own = number(&mut self);
            *own = own.hypot(*number(&mut other));
        }
        self
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
            construct: 9.0,
            update,
            finding: 0.0,
            test: 5.0,
        };
        // Student's quantile for one degree of freedom is 12.706; the standard error of 1 and 3 is
        // 1.
        let widths = Terms::widths(&[pass(1.0), pass(3.0)]).map(|w| [w.update, w.test]);
        let [update, test] = widths.unwrap_or_default();
        assert!((update - 12.706).abs() < 1e-3 && test == 0.0, "{widths:?}");
        assert!(Terms::widths(&[]).is_none());
        // JSON has no infinity: one pass reads back.
        let one = Terms::widths(&[pass(1.0)]);
        let text = serde_json::to_string(&one).unwrap_or_default();
        assert_eq!(serde_json::from_str::<Option<Terms>>(&text).ok(), Some(one));
    }
}
