//! Prices from measurements: least squares without negative prices.
//!
//! A measured stage took Σ countⱼ·priceⱼ. Each row is divided by the seconds of its stage, so that
//! the fit minimises the sum of squared *relative* residuals: a scene of fifty bodies weighs as
//! much as one of six hundred. Prices can't be negative. There are at most six, so every subset of
//! them is fitted without constraint, and the best fit with positive prices is used.

use faer::Mat;
use faer::linalg::solvers::SolveLstsq;

use crate::measure::turns::median;

/// Rows whose residual is this many times the median residual are left out.
const OUTLIER_RATIO: f64 = 4.0;

/// One measurement: the counts of the priced operations, and their seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement<const N: usize> {
    /// Counts.
    pub counts: [f64; N],
    /// Seconds to be explained.
    pub seconds: f64,
    /// Seconds of the whole, of which they are a part. Residuals are relative to it; rows with 0
    /// are left out.
    pub whole: f64,
}

impl<const N: usize> Measurement<N> {
    /// A measurement whose seconds are the whole.
    #[must_use]
    pub fn of(counts: [f64; N], seconds: f64) -> Self {
        Self { counts, seconds, whole: seconds }
    }
}

/// The prices ≥ 0 that explain `rows` best; all 0 if nothing was measured. Rows with large
/// residuals (the machine had other load) are left out of a second fit.
#[must_use]
pub fn prices<const N: usize>(rows: &[Measurement<N>]) -> [f64; N] {
    let rows: Vec<&Measurement<N>> = rows.iter().filter(|row| row.whole > 0.0).collect();
    let first = positive_fit(&rows);
    let off = |row: &&Measurement<N>| relative_residual(row, &first).abs();
    let limit = OUTLIER_RATIO * median(rows.iter().map(off).collect());
    let near: Vec<&Measurement<N>> = rows.iter().copied().filter(|row| off(row) <= limit).collect();
    if near.len() == rows.len() || near.len() <= N {
        return first;
    }
    positive_fit(&near)
}

/// The best fit over all subsets of prices whose result is positive.
fn positive_fit<const N: usize>(rows: &[&Measurement<N>]) -> [f64; N] {
    let mut best = ([0.0; N], f64::INFINITY);
    for subset in 1..1_u32 << N {
        let used: Vec<usize> = (0..N).filter(|j| subset >> j & 1 == 1).collect();
        let Some(prices) = free_fit(rows, &used) else {
            continue;
        };
        let residual = rows.iter().map(|row| relative_residual(row, &prices).powi(2)).sum();
        if prices.iter().all(|&price| price >= 0.0) && residual < best.1 {
            best = (prices, residual);
        }
    }
    best.0
}

/// (explained − measured)/whole.
fn relative_residual<const N: usize>(row: &Measurement<N>, prices: &[f64; N]) -> f64 {
    let explained: f64 = row.counts.iter().zip(prices).map(|(count, price)| count * price).sum();
    (explained - row.seconds) / row.whole
}

/// Ordinary least squares in the columns `used`; `None` if these are linearly dependent.
fn free_fit<const N: usize>(rows: &[&Measurement<N>], used: &[usize]) -> Option<[f64; N]> {
    // Columns scaled to their largest entry: a count of tests is a million times one of frames.
    let scale: Vec<f64> = used
        .iter()
        .map(|&j| rows.iter().map(|row| row.counts[j] / row.whole).fold(0.0, f64::max))
        .collect();
    if rows.len() < used.len() || scale.contains(&0.0) {
        return None;
    }
    let matrix = Mat::from_fn(rows.len(), used.len(), |i, j| {
        rows[i].counts[used[j]] / rows[i].whole / scale[j]
    });
    let seconds = Mat::from_fn(rows.len(), 1, |i, _| rows[i].seconds / rows[i].whole);
    let solution = matrix.col_piv_qr().solve_lstsq(&seconds);
    let mut prices = [0.0; N];
    for (j, &column) in used.iter().enumerate() {
        prices[column] = solution[(j, 0)] / scale[j];
    }
    prices.iter().all(|price| price.is_finite()).then_some(prices)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(counts: [f64; 3], prices: [f64; 3]) -> Measurement<3> {
        let seconds = counts.iter().zip(prices).map(|(c, p)| c * p).sum();
        Measurement::of(counts, seconds)
    }

    /// Prices are found again whatever their scale.
    #[test]
    fn prices_are_recovered_at_any_scale() {
        let truth = [4e-9, 7e-11, 3e-8];
        let counts = [
            [50.0, 1225.0, 12.0],
            [500.0, 124_000.0, 1300.0],
            [500.0, 118_000.0, 7000.0],
            [90.0, 4005.0, 0.0],
        ];
        let found = prices(&counts.map(|counts| row(counts, truth)));
        for (found, truth) in found.iter().zip(truth) {
            assert!((found / truth - 1.0).abs() < 1e-9, "{found} for {truth}");
        }
    }

    /// What lies far off is left out.
    #[test]
    fn outliers_are_left_out() {
        let truth = [4e-9, 7e-11, 3e-8];
        let mut rows: Vec<_> = (1..=12)
            .map(|i| {
                let n = 40.0 * f64::from(i);
                let mut row = row([n, 0.5 * n * n, (i * i % 7) as f64 * n], truth);
                row.seconds *= 1.0 + 0.001 * f64::from(i % 3 - 1);
                row.whole = row.seconds;
                row
            })
            .collect();
        rows[4].seconds *= 3.0;
        rows[4].whole *= 3.0;
        for (found, truth) in prices(&rows).iter().zip(truth) {
            assert!((found / truth - 1.0).abs() < 0.02, "{found} for {truth}");
        }
    }

    #[test]
    fn a_price_is_never_negative() {
        // Unconstrained, the third price would be −1.
        let rows = [
            row([1.0, 0.0, 0.5], [2.0, 3.0, -1.0]),
            row([0.0, 1.0, 0.5], [2.0, 3.0, -1.0]),
            row([1.0, 1.0, 1.0], [2.0, 3.0, -1.0]),
        ];
        let found = prices(&rows);
        assert_eq!(found[2], 0.0);
        assert!(found[0] > 1.0 && found[1] > 2.0, "{found:?}");
    }

    #[test]
    fn nothing_measured_costs_nothing() {
        assert_eq!(prices::<2>(&[]), [0.0; 2]);
        assert_eq!(prices(&[Measurement::of([1.0, 2.0], 0.0)]), [0.0; 2]);
    }
}
