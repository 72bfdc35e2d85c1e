//! Means with confidence intervals over seeds.
//!
//! Frames of one run are correlated: at the paper's speeds a body needs about a hundred frames to
//! travel its own diameter. Therefore a run counts as one observation, whatever its number of
//! frames, and intervals are Student's over the runs' means.

use serde::{Deserialize, Deserializer, Serialize};
use special::{Beta as _, Gamma as _};

/// The probability that an interval covers the true value.
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
    /// The number of seeds.
    pub seeds: usize,
}

impl Estimate {
    /// A value without an interval.
    #[must_use]
    pub const fn alone(mean: f64) -> Self {
        Self { mean, half_width: f64::INFINITY, seeds: 0 }
    }

    /// The estimate from one value per seed.
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
                quantile(CONFIDENCE, n - 1.0) * error
            },
            seeds: values.len(),
        }
    }

    /// The estimate from values in the order of time, such as medians of separate runs. Values that
    /// are close in time share the machine's load: with the correlation ρ of consecutive values, n
    /// values have the information of n(1 − ρ)/(1 + ρ) independent ones.
    #[must_use]
    pub fn in_order(values: &[f64]) -> Self {
        let plain = Self::of(values);
        let correlation = lag_1(values).clamp(0.0, 0.9);
        Self {
            half_width: plain.half_width * ((1.0 + correlation) / (1.0 - correlation)).sqrt(),
            ..plain
        }
    }

    /// Half the interval's width as a share of the mean.
    #[must_use]
    pub fn relative(&self) -> f64 {
        self.half_width / self.mean.abs()
    }

    /// The interval's ends.
    #[must_use]
    pub fn interval(&self) -> [f64; 2] {
        [self.mean - self.half_width, self.mean + self.half_width]
    }

    /// Whether the interval covers a value.
    #[must_use]
    pub fn covers(&self, value: f64) -> bool {
        (value - self.mean).abs() <= self.half_width
    }

    /// Probability of a mean at least this far from `truth`, if that were the truth; 1 for one
    /// seed.
    #[must_use]
    pub fn p_value(&self, truth: f64) -> f64 {
        if self.seeds < 2 {
            return 1.0;
        }
        let freedom = self.seeds as f64 - 1.0;
        let error = self.half_width / quantile(CONFIDENCE, freedom);
        if error == 0.0 {
            return f64::from(u8::from(self.mean == truth));
        }
        let t = (self.mean - truth) / error;
        // Two tails: I_x(ν/2, ½) at x = ν/(ν + t²).
        let (a, b) = (0.5 * freedom, 0.5_f64);
        (freedom / (freedom + t * t)).inc_beta(a, b, a.ln_beta(b))
    }

    /// The estimate in another unit.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self { mean: factor * self.mean, half_width: factor.abs() * self.half_width, ..*self }
    }
}

/// The correlation of each value with the next; 0 of fewer than four values or of equal ones.
#[must_use]
pub fn lag_1(values: &[f64]) -> f64 {
    let n = values.len();
    let mean = values.iter().sum::<f64>() / n as f64;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    if n < 4 || squares == 0.0 {
        return 0.0;
    }
    let products = values.windows(2).map(|w| (w[0] - mean) * (w[1] - mean));
    // A series of independent values shows −1/n on average.
    products.sum::<f64>() / squares + 1.0 / n as f64
}

/// JSON has no infinity and writes `null`.
pub(crate) fn or_infinite<'de, D: Deserializer<'de>>(number: D) -> Result<f64, D::Error> {
    Option::deserialize(number).map(|number| number.unwrap_or(f64::INFINITY))
}

/// The probability that χ² with `freedom` degrees of freedom exceeds `chi_squared`.
#[must_use]
pub fn chi_squared_p(chi_squared: f64, freedom: f64) -> f64 {
    1.0 - (0.5 * chi_squared).inc_gamma(0.5 * freedom)
}

/// Half-width of a two-sided Student interval in standard errors: t = √(ν(1/x − 1)) with I_x(ν/2,
/// ½) = 1 − confidence.
fn quantile(confidence: f64, freedom: f64) -> f64 {
    let (a, b) = (0.5 * freedom, 0.5_f64);
    let x = (1.0 - confidence).inv_inc_beta(a, b, a.ln_beta(b));
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

    /// Drifting values have less information than scattered ones.
    #[test]
    fn drift_widens_the_interval() {
        let drift: Vec<f64> = (0..20).map(f64::from).collect();
        let mut scatter = drift.clone();
        (0..20).for_each(|i| scatter.swap(i, (7 * i + 3) % 20));
        assert!(lag_1(&drift) > 0.8 && lag_1(&scatter) < 0.4);
        let [plain, drift, scatter] =
            [Estimate::of(&drift), Estimate::in_order(&drift), Estimate::in_order(&scatter)];
        assert_eq!(drift.mean, plain.mean);
        assert!(drift.half_width > 3.0 * plain.half_width, "{drift:?}");
        assert!(scatter.half_width < drift.half_width, "{scatter:?}");
        let jumping = [1.0, 2.0, 1.0, 2.0, 1.0, 2.0];
        assert_eq!(Estimate::in_order(&jumping), Estimate::of(&jumping));
    }

    /// The p value crosses five percent at the interval's end.
    #[test]
    fn p_value_matches_interval_end() {
        let estimate = Estimate::of(&[1.0, 2.0, 3.0, 4.0, 5.0, 9.0]);
        let [lo, hi] = estimate.interval();
        for end in [lo, hi] {
            assert!((estimate.p_value(end) - 0.05).abs() < 1e-9);
        }
        assert!((estimate.p_value(estimate.mean) - 1.0).abs() < 1e-12);
    }

    /// Chi squared tail is the table's.
    #[test]
    fn chi_squared_tail_matches_table() {
        assert!((chi_squared_p(7.815, 3.0) - 0.05).abs() < 1e-4);
    }
}
