//! The periods of the axes.

use super::PeriodicError;
use crate::rounding::period::{MOST_PERIODS, PERIOD_LIMITS};

/// The names of the axes, for errors.
const NAMES: [char; 3] = ['x', 'y', 'z'];

/// The period of each axis that has one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Periods([Option<f64>; 3]);

impl Periods {
    pub fn new(periods: [Option<f64>; 3]) -> Result<Self, PeriodicError> {
        let [least, most] = PERIOD_LIMITS;
        let checked = Self(periods);
        for (axis, period) in checked.iter() {
            if !(least <= period && period <= most) {
                let axis = NAMES[axis];
                return Err(PeriodicError::Period { axis, period });
            }
        }
        Ok(checked)
    }

    pub fn get(&self) -> [Option<f64>; 3] {
        self.0
    }

    /// The periodic axes and their periods.
    #[inline]
    pub fn iter(&self) -> impl Iterator<Item = (usize, f64)> {
        let axes = self.0.into_iter().enumerate();
        axes.filter_map(|(axis, period)| period.map(|period| (axis, period)))
    }

    /// Checks that a body is less than [`MOST_PERIODS`] away.
    pub fn check_position(
        &self,
        body: usize,
        axis: usize,
        position: f64,
    ) -> Result<(), PeriodicError> {
        match self.0[axis] {
            Some(period) if !(position.abs() <= MOST_PERIODS * period) => Err(PeriodicError::Far {
                body,
                axis: NAMES[axis],
                position,
                period,
            }),
            _ => Ok(()),
        }
    }

    /// The error of a body that is too large.
    pub fn size_error(&self, body: usize, axis: usize, size: f64) -> PeriodicError {
        PeriodicError::Size {
            body,
            axis: NAMES[axis],
            size,
            period: self.0[axis].unwrap_or(f64::INFINITY),
        }
    }
}
