//! Errors of compounds.

use crate::bodies::contract::ContractError;
use crate::mesh::MeshError;
use crate::volume::VolumeError;

/// Why a compound can't be built or its parts can't be culled.
#[derive(thiserror::Error)]
pub enum CompoundError {
    /// A compound without parts.
    #[error("compound `{compound}` has no parts; {help}", help = self.help())]
    NoParts {
        /// The compound's name.
        compound: String,
    },
    /// The shape or the pose of a part is invalid.
    #[error("part {} of compound `{compound}`: {} {}; {help}", .source.body, .source.quantity, .source.value, help = self.help())]
    Part {
        /// The compound's name.
        compound: String,
        /// What is wrong; its body is the number of the part.
        source: ContractError,
    },
    /// The parts reach farther from the body's origin than 2⁶⁰.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The parts reach farther from the body's origin than 2⁶⁰.
    #[error(transparent)]
    Volume(#[from] VolumeError),
    /// The world's pairs are not those of its present bodies.
    #[error("the world has changed since its last cull, or was culled in portions; {help}", help = self.help())]
    NotCulled,
    /// The system refuses memory for the pairs of parts.
    #[error("there is no memory for the pairs of parts; {help}", help = self.help())]
    OutOfMemory,
    /// The world has another shape under the number, or none.
    #[error("shape {shape} of the world is not the shape of compound `{compound}`; {help}", help = self.help())]
    OtherShape {
        /// The number of the shape.
        shape: u32,
        /// The compound's name.
        compound: String,
    },
}

crate::problem::errors!(CompoundError);

impl CompoundError {
    /// How to mend it.
    #[must_use]
    pub fn help(&self) -> String {
        let help = match self {
            Self::NoParts { .. } => "give it one part at least",
            Self::Part { source, .. } => source.help(),
            Self::Mesh(error) => return error.help(),
            Self::Volume(error) => error.help(),
            Self::NotCulled => {
                "call `World::cull` first: before the first call, and after each change, `restore` and `cull_in_portions`"
            }
            Self::OutOfMemory => "put fewer compounds into one another, or give them fewer parts",
            Self::OtherShape { .. } => {
                "give the world `compound.shape()` under this number, or call `remove_parts`, or `set_parts` with the new compound"
            }
        };
        help.to_owned()
    }
}
