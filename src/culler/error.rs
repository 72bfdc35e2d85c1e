//! What a culler refuses.

use thiserror::Error;

use crate::bodies::contract::ContractError;
#[cfg(feature = "shapes")]
use crate::settings::SettingsError;
use crate::threads::ThreadsError;

/// A culler that can't be made, or a frame that can't be culled.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum CullError {
    /// A body or shape outside of the contract.
    #[error(transparent)]
    Contract(#[from] ContractError),
    /// A shape that can't be culled together with those before it, or at all.
    #[error("shape `{shape}` {problem}")]
    Shape {
        /// The shape's name.
        shape: String,
        /// What is wrong with it.
        problem: String,
        /// How to mend it.
        hint: &'static str,
    },
    /// Settings that can't be carried out.
    #[cfg(feature = "shapes")]
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// Threads that the system refuses to start.
    #[error(transparent)]
    Threads(#[from] ThreadsError),
    /// More pairs than the caller allows.
    #[error("{pairs} pairs, and at most {limit} are allowed")]
    TooManyPairs {
        /// How many pairs the frame has.
        pairs: u64,
        /// How many it may have.
        limit: usize,
    },
    /// Another set of bodies than the culler was made for.
    #[error("{what}: a culler keeps the set of bodies that it was made for")]
    Changed {
        /// What has changed.
        what: String,
    },
}

impl CullError {
    /// How to mend it.
    #[must_use]
    pub fn help(&self) -> &str {
        match self {
            Self::Contract(error) => error.help(),
            Self::Shape { hint, .. } => hint,
            #[cfg(feature = "shapes")]
            Self::Settings(error) => error.help(),
            Self::Threads(error) => error.help(),
            Self::TooManyPairs { .. } => {
                "raise the limit, or take the pairs in portions with `cull_in_portions`"
            }
            Self::Changed { .. } => {
                "call `Culler::refresh` after a change of the set, or keep the bodies in a `World`"
            }
        }
    }
}
