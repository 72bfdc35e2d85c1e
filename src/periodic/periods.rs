//! The periods of the axes.

use super::PeriodicError;
use crate::rounding::period::{MOST_PERIODS, PERIOD_LIMITS, shifted, wrap};
use crate::rounding::query::largest;
use crate::rounding::up;

/// The names of the axes, for errors.
const NAMES: [char; 3] = ['x', 'y', 'z'];

/// The period of each axis that has one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Periods {
    of_axes: [Option<f64>; 3],
    /// Half of each period; infinite along other axes.
    halves: [f64; 3],
}

impl Default for Periods {
    fn default() -> Self {
        Self { of_axes: [None; 3], halves: [f64::INFINITY; 3] }
    }
}

impl Periods {
    pub fn new(of_axes: [Option<f64>; 3]) -> Result<Self, PeriodicError> {
        let [least, most] = PERIOD_LIMITS;
        let halves = of_axes.map(|period| period.map_or(f64::INFINITY, |period| 0.5 * period));
        let checked = Self { of_axes, halves };
        for (axis, period) in checked.iter() {
            if !(least <= period && period <= most) {
                let axis = NAMES[axis];
                return Err(PeriodicError::Period { axis, period });
            }
        }
        Ok(checked)
    }

    pub fn get(&self) -> [Option<f64>; 3] {
        self.of_axes
    }

    /// The periodic axes and their periods.
    #[inline]
    pub fn iter(&self) -> impl Iterator<Item = (usize, f64)> {
        let axes = self.of_axes.into_iter().enumerate();
        axes.filter_map(|(axis, period)| period.map(|period| (axis, period)))
    }

    /// Whether a box is within one period about the origin, and surely shorter than half of it,
    /// along each periodic axis.
    #[inline]
    pub fn contain(&self, min: &[f64; 3], max: &[f64; 3]) -> bool {
        (0..3).all(|axis| {
            let (half, lo, hi) = (self.halves[axis], min[axis], max[axis]);
            -half <= lo && hi <= half && hi - lo < half
        })
    }

    /// Whether a place is more than half of a period away from another along an axis.
    #[inline]
    pub fn is_jump(&self, from: &[f64; 3], to: &[f64; 3]) -> bool {
        let is_far = |axis: usize| (to[axis] - from[axis]).abs() > self.halves[axis];
        is_far(0) | is_far(1) | is_far(2)
    }

    /// A position moved by whole periods, and a bound of the error on each axis. Coordinates that
    /// are not moved stay as they are.
    #[inline]
    pub fn moved(&self, position: [f64; 3], by: [i32; 3]) -> ([f64; 3], [f64; 3]) {
        let (mut moved, mut errors) = (position, [0.0; 3]);
        if by == [0; 3] {
            return (moved, errors); // of most bodies
        }
        for (axis, period) in self.iter().filter(|&(axis, _)| by[axis] != 0) {
            let (rest, n) = wrap(position[axis], period);
            (moved[axis], errors[axis]) = shifted(rest, n + by[axis], period);
        }
        (moved, errors)
    }

    /// Checks that a body is less than [`MOST_PERIODS`] away.
    pub fn check_position(
        &self,
        body: usize,
        axis: usize,
        position: f64,
    ) -> Result<(), PeriodicError> {
        match self.of_axes[axis] {
            Some(period) if !(position.abs() <= MOST_PERIODS * period) => {
                Err(PeriodicError::Far { body, axis: NAMES[axis], position, period })
            }
            _ => Ok(()),
        }
    }

    /// The error of a body that is too large.
    pub fn size_error(&self, body: usize, axis: usize, size: f64) -> PeriodicError {
        PeriodicError::Size {
            body,
            axis: NAMES[axis],
            size,
            period: self.of_axes[axis].unwrap_or(f64::INFINITY),
        }
    }
}

/// A bound of the distance between two points, from one on each axis.
#[inline]
pub fn distance(errors: [f64; 3]) -> f64 {
    2.0 * largest(errors) // above √3 times that
}

/// A margin that covers the errors of a translation as well.
#[inline]
pub fn margin_about(margin: f32, errors: [f64; 3]) -> f32 {
    let error = distance(errors);
    if error > 0.0 { up(f64::from(margin) + error) } else { margin }
}
