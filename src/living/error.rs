//! The errors of worlds.

use thiserror::Error;

use super::BodyId;
use crate::bodies::contract::ContractError;
use crate::cull_error::CullError;

/// The error of a request that a world can't carry out. The world stays unchanged.
#[derive(Clone, PartialEq, Error)]
pub enum WorldError {
    /// The body has been removed.
    #[error("body {0} is no longer in this world; {help}", help = self.help())]
    Gone(BodyId),
    /// A number of the body is outside of the contract.
    #[error(transparent)]
    Contract(#[from] ContractError),
    /// The culler can't be built.
    #[error(transparent)]
    Cull(#[from] CullError),
    /// Bodies are too far from each other to be culled about one origin.
    #[error("bodies lie farther apart than 2^60: {0} is out of reach of the others; {help}", help = self.help())]
    Apart(BodyId),
    /// A shape that a body uses can't be removed.
    #[error("shape {shape} (`{name}`) is the shape of body {body}; {help}", help = self.help())]
    ShapeInUse {
        /// The shape's number.
        shape: u32,
        /// Its name.
        name: String,
        /// A body that uses it.
        body: BodyId,
    },
    /// No shape has this number.
    #[error("no shape of this world has the number {0}; {help}", help = self.help())]
    NoShape(u32),
}

crate::problem::errors!(WorldError);

impl WorldError {
    /// How to mend it.
    #[must_use]
    pub fn help(&self) -> &str {
        match self {
            Self::Gone(_) => "it was removed; ids are never given again",
            Self::Contract(error) => error.help(),
            Self::Cull(error) => error.help(),
            Self::Apart(_) => "keep separate worlds for what can't meet",
            Self::ShapeInUse { .. } => {
                "remove the bodies that have it first, or give them another shape"
            }
            Self::NoShape(_) => {
                "numbers come from `World::add_shape`, or count the shapes that the world began with"
            }
        }
    }
}
