//! The contract: what bodies have to satisfy so that no strategy misses a pair.
//!
//! It is checked when bodies enter, and again in every step of a simulation. A NaN is therefore
//! reported with its body's number in the step that produced it, and not as a wrong pair list
//! frames later.

mod poses;

use thiserror::Error;

use crate::simd::{MAX_WIDTH, MOST_QUADS};

pub(crate) use poses::{
    balls_are_within_limit, check_columns, check_numbers, is_within_limit, refuse_number,
};
pub use poses::{check_pose, check_poses, check_vectors};

/// The error for a body that breaks the contract.
#[derive(Clone, PartialEq, Error)]
#[error("body {body}: {quantity} {value}; {help}", help = self.help())]
pub struct ContractError {
    /// The body's index.
    pub body: usize,
    /// The invalid quantity: a column of [`Bodies`](super::Bodies).
    pub quantity: &'static str,
    /// The invalid value.
    pub value: String,
    /// How to mend it.
    pub hint: &'static str,
}

crate::problem::errors!(ContractError);

impl ContractError {
    /// How to mend it.
    #[must_use]
    pub fn help(&self) -> &str {
        self.hint
    }
}

/// The most bodies that a culler can hold. Its table of balls has one quad per body and one vector
/// of padding.
pub const MOST_BODIES: usize = MOST_QUADS - MAX_WIDTH;

/// Checks that there are at most [`MOST_BODIES`] bodies.
pub(crate) fn check_number(bodies: usize) -> Result<(), ContractError> {
    if bodies <= MOST_BODIES {
        return Ok(());
    }
    let value = format!("{bodies} of {MOST_BODIES} at most");
    let hint = "keep separate cullers for what can't meet";
    refuse(MOST_BODIES, "number", value, hint)
}

/// Checks that a column has one entry per body.
#[doc(hidden)]
pub fn check_column(name: &'static str, length: usize, bodies: usize) -> Result<(), ContractError> {
    if length == bodies {
        return Ok(());
    }
    let value = format!("has {length} entries for {bodies} bodies");
    let hint = "give every column one entry per body";
    refuse(length.min(bodies), name, value, hint)
}

pub(crate) fn refuse(
    body: usize,
    quantity: &'static str,
    value: String,
    hint: &'static str,
) -> Result<(), ContractError> {
    Err(ContractError { body, quantity, value, hint })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The limit is the number of bodies that can be numbered.
    #[test]
    fn body_limit_is_enforced() {
        assert_eq!(check_number(0), Ok(()));
        assert_eq!(check_number(MOST_BODIES), Ok(()));
        let told = check_number(MOST_BODIES + 1).map_err(|error| error.problem());
        let [more, most] = [MOST_BODIES + 1, MOST_BODIES];
        assert_eq!(told, Err(format!("body {most}: number {more} of {most} at most")));
    }
}
