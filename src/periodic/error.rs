//! Errors of periodic worlds.

use thiserror::Error;

use crate::bodies::contract::ContractError;
use crate::living::WorldError;
use crate::rounding::period::MOST_PERIODS;

/// The error of a request that a periodic world can't carry out. The world stays unchanged.
#[derive(Clone, PartialEq, Error)]
pub enum PeriodicError {
    /// A period that is not a length, or is out of range.
    #[error("the period along {axis} is {period}; {help}", help = self.help())]
    Period {
        /// The axis: x, y or z.
        axis: char,
        /// The invalid period.
        period: f64,
    },
    /// A body of half of a period or more, which might meet two images of another.
    #[error(
        "body {body} measures {size} along {axis}, but less than {} is allowed, half of the period; {help}", 0.5 * .period, help = self.help()
    )]
    Size {
        /// The body's slot.
        body: usize,
        /// The axis: x, y or z.
        axis: char,
        /// The length of the box, or the diameter of the ball about the mesh with its margin.
        size: f64,
        /// The period along the axis.
        period: f64,
    },
    /// A body too many periods away from the origin.
    #[error(
        "body {body} is at {position} along {axis}, farther away than {MOST_PERIODS} periods of {period}; {help}", help = self.help()
    )]
    Far {
        /// The body's slot.
        body: usize,
        /// The axis: x, y or z.
        axis: char,
        /// Its position.
        position: f64,
        /// The period along the axis.
        period: f64,
    },
    /// The body has been removed, or it is outside of the contract.
    #[error(transparent)]
    World(#[from] WorldError),
}

crate::problem::errors!(PeriodicError);

impl From<ContractError> for PeriodicError {
    fn from(error: ContractError) -> Self {
        Self::World(error.into())
    }
}

impl PeriodicError {
    /// How to mend it.
    #[must_use]
    pub fn help(&self) -> &str {
        match self {
            Self::Period { .. } => {
                "give a length from 2^-56 to 2^56, or `None` for an axis without a period"
            }
            Self::Size { .. } => {
                "make the body, its margin or its cutoff smaller, or cull several periods as one"
            }
            Self::Far { .. } => "add a whole number of periods, which changes no pair",
            Self::World(error) => error.help(),
        }
    }
}
