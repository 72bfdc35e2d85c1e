//! Percentiles of the times of single frames. A mean would hide a frame that stutters visibly.

use serde::Serialize;

/// The median, the 99th percentile and the maximum of the frames' seconds. All are zero without
/// frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Percentiles {
    /// The median frame, the earlier of the two middle ones.
    pub p50: f64,
    /// 99 in 100 frames take no longer.
    pub p99: f64,
    /// The longest frame.
    pub most: f64,
}

impl Percentiles {
    /// By nearest rank: each is one of the values.
    #[must_use]
    pub fn of(mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        // The smallest value that at least this many percent of the values don't exceed.
        let at = |hundredths: usize| {
            let rank = (values.len() * hundredths).div_ceil(100);
            values.get(rank.saturating_sub(1)).copied().unwrap_or(0.0)
        };
        Self { p50: at(50), p99: at(99), most: at(100) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each percentile is the least value that its share of the values does not exceed.
    #[test]
    fn percentiles_use_nearest_rank() {
        for (values, [p50, p99, most]) in [
            (0, [0.0; 3]),
            (1, [1.0; 3]),
            (2, [1.0, 2.0, 2.0]),
            (5, [3.0, 5.0, 5.0]),
            (100, [50.0, 99.0, 100.0]),
            (101, [51.0, 100.0, 101.0]),
            (200, [100.0, 198.0, 200.0]),
        ] {
            let falling = (1..=values).rev().map(f64::from).collect();
            let found = Percentiles::of(falling);
            assert_eq!([found.p50, found.p99, found.most], [p50, p99, most]);
        }
    }
}
