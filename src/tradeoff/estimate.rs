//! Means with confidence intervals over seeds.
//!
//! Frames of one run are correlated, so a run counts as one observation, and intervals are Student's over the runs.

use serde::{Deserialize, Deserializer, Serialize};
use special::Beta as _;

/// How often an interval covers the truth.
pub const CONFIDENCE: f64 = 0.95;

/// A mean over seeds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The mean.
    #[serde(deserialize_with = "or_infinite")]
    pub mean: f64,
    /// Half the width of the [`CONFIDENCE`] interval; infinite for one seed.
    #[serde(deserialize_with = "or_infinite")]
    pub half_width: f64,
}

impl Estimate {
    /// From one value a seed.
    #[must_use]
    pub fn of(values: &[f64]) -> Self {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let error = (squares / (n - 1.0) / n).sqrt();
        Self {
            mean,
            half_width: if values.len() < 2 {
                f64::INFINITY
            } else {
                quantile(n - 1.0) * error
            },
        }
    }

    /// Whether the interval covers a value.
    #[must_use]
    pub fn covers(&self, value: f64) -> bool {
        (value - self.mean).abs() <= self.half_width
    }
}

/// JSON has no infinity and writes `null`.
pub(super) fn or_infinite<'de, D: Deserializer<'de>>(number: D) -> Result<f64, D::Error> {
    Option::deserialize(number).map(|number| number.unwrap_or(f64::INFINITY))
}

/// Half-width of the two-sided Student interval in standard errors: t = √(ν(1/x − 1)) with I_x(ν/2, ½) = 1 − confidence.
fn quantile(freedom: f64) -> f64 {
    let (a, b) = (0.5 * freedom, 0.5_f64);
    let x = (1.0 - CONFIDENCE).inv_inc_beta(a, b, a.ln_beta(b));
    (freedom * (1.0 / x - 1.0)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_student_s() {
        // t at .975: 12.706 for one degree of freedom, 2.776 for four (any table).
        let two = Estimate::of(&[1.0, 3.0]);
        assert!((two.half_width - 12.706).abs() < 1e-3, "{two:?}");
        let five = Estimate::of(&[1.0, 2.0, 3.0, 4.0, 5.0]);
        assert!((five.half_width - 2.776 * (2.5_f64 / 5.0).sqrt()).abs() < 1e-3);
        assert!(five.covers(1.1) && !five.covers(1.0));
        assert_eq!(Estimate::of(&[2.0]).half_width, f64::INFINITY);
    }
}
