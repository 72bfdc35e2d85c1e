//! The paper's own numbers, for comparison with ours, and what they imply about each other.

use sdop::settings::Strategy;

use crate::measure::estimate::chi_squared_p;

/// Numbers of objects in Table 1. The paper's text says 350 in the third place.
pub const TABLE_1_BODIES: [usize; 4] = [50, 150, 300, 500];

/// Table 1: collisions detected in percent of the tests made.
pub const TABLE_1: [(Strategy, [f64; 4]); 4] = [
    (Strategy::Sphere, [0.76, 0.82, 0.94, 1.06]),
    (Strategy::OrDop, [0.42, 0.65, 1.23, 2.87]),
    (Strategy::SDopSequential, [43.31, 44.31, 48.82, 52.34]),
    (Strategy::SDopBatch, [16.88, 17.88, 22.28, 24.82]),
];

/// Table 1's percentages of a strategy.
#[must_use]
pub fn row(strategy: Strategy) -> Option<&'static [f64; 4]> {
    TABLE_1.iter().find(|(of, _)| *of == strategy).map(|(_, row)| row)
}

/// Table 1's percentage of a strategy for a number of objects.
#[must_use]
pub fn percentage(strategy: Strategy, bodies: usize) -> Option<f64> {
    let column = TABLE_1_BODIES.iter().position(|&n| n == bodies)?;
    row(strategy).map(|row| row[column])
}

/// N(N−1)/2 for each column.
#[must_use]
pub fn pairs() -> [f64; 4] {
    TABLE_1_BODIES.map(|n| (n * (n - 1) / 2) as f64)
}

/// Tests whether a row, taken as counts of one frame, has the same percentage in all columns: χ² on
/// three degrees of freedom, its probability, and the pooled percentage. `tests` are the tests per
/// frame in each column.
#[must_use]
pub fn constant_row(row: &[f64; 4], tests: &[f64; 4]) -> (f64, f64, f64) {
    let hits: Vec<f64> =
        row.iter().zip(tests).map(|(percent, tests)| 0.01 * percent * tests).collect();
    let pooled = hits.iter().sum::<f64>() / tests.iter().sum::<f64>();
    let term = |(hits, tests): (&f64, &f64)| {
        let expected = pooled * tests;
        (hits - expected).powi(2) / (expected * (1.0 - pooled))
    };
    let chi_squared = hits.iter().zip(tests).map(term).sum();
    (chi_squared, chi_squared_p(chi_squared, 3.0), 100.0 * pooled)
}

/// Tests a frame, as multiples of N, that the ALL row has beyond tests and list entries, if sphere
/// and sequential rows hold: hits/ALL − 2·tests with hits = pairs × sphere × sequential and tests =
/// pairs × sphere.
#[must_use]
pub fn extra_tests_of_all() -> Option<[f64; 4]> {
    let (sphere, sequential, all) =
        (row(Strategy::Sphere)?, row(Strategy::SDopSequential)?, row(Strategy::SDopBatch)?);
    let pairs = pairs();
    Some(std::array::from_fn(|i| {
        let tests = 0.01 * sphere[i] * pairs[i];
        let hits = 0.01 * sequential[i] * tests;
        (hits / (0.01 * all[i]) - 2.0 * tests) / TABLE_1_BODIES[i] as f64
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The sphere row is hardly constant and the sequential row may be.
    #[test]
    fn sphere_row_is_not_constant() {
        let sphere = &TABLE_1[0].1;
        let (chi_squared, p, pooled) = constant_row(sphere, &pairs());
        assert!((chi_squared - 10.05).abs() < 0.05, "{chi_squared}");
        assert!(p > 0.01 && p < 0.02 && (pooled - 1.01).abs() < 0.01, "{p} {pooled}");
        let listed: [f64; 4] = std::array::from_fn(|i| 0.01 * sphere[i] * pairs()[i]);
        let (chi_squared, p, pooled) = constant_row(&TABLE_1[2].1, &listed);
        assert!((chi_squared - 3.6).abs() < 0.2 && p > 0.2 && (pooled - 51.0).abs() < 0.5);
    }

    /// All's dop has about a quarter n extra tests.
    #[test]
    fn batch_row_has_extra_tests() {
        let extra = extra_tests_of_all().unwrap_or_default();
        assert!(extra[1..].iter().all(|x| (0.26..0.30).contains(x)), "{extra:?}");
    }
}
