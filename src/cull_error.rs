//! The errors of a culler.

use thiserror::Error;

use crate::bodies::contract::ContractError;
use crate::pairs::PairList;
use crate::settings::SettingsError;
use crate::threads::ThreadsError;

/// Why a culler can't be built or a frame can't be culled.
#[derive(Clone, PartialEq, Error)]
pub enum CullError {
    /// A body or shape that breaks the contract.
    #[error(transparent)]
    Contract(#[from] ContractError),
    /// A shape that can't be culled, or not together with those before it.
    #[error("shape `{shape}` {problem}; {help}", help = self.help())]
    Shape {
        /// The shape's name.
        shape: String,
        /// What is wrong with it.
        problem: String,
        /// How to mend it.
        hint: &'static str,
    },
    /// Invalid settings.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// Threads that the system refuses to start.
    #[error(transparent)]
    Threads(#[from] ThreadsError),
    /// The system refuses memory for the frame's pairs.
    #[error("there is no memory for the frame's pairs; {help}", help = self.help())]
    OutOfMemory,
    /// More pairs than the caller allows.
    #[error("the frame has {pairs} pairs, but at most {limit} are allowed; {help}", help = self.help())]
    TooManyPairs {
        /// How many pairs the frame has.
        pairs: u64,
        /// How many it may have.
        limit: usize,
    },
    /// A different set of bodies from the one that the culler was built for.
    #[error("{what}: a culler keeps the set of bodies that it was made for; {help}", help = self.help())]
    Changed {
        /// What has changed.
        what: String,
    },
}

crate::problem::errors!(CullError);

impl CullError {
    /// Whether a frame's list has all pairs. If not, it gives its memory back.
    pub(crate) fn check_memory(list: &mut PairList) -> Result<(), Self> {
        if !list.is_lost() {
            return Ok(());
        }
        *list = PairList::default();
        Err(Self::OutOfMemory)
    }

    /// How to mend it.
    #[must_use]
    pub fn help(&self) -> &str {
        match self {
            Self::Contract(error) => error.help(),
            Self::Shape { hint, .. } => hint,
            Self::Settings(error) => error.help(),
            Self::Threads(error) => error.help(),
            Self::OutOfMemory => {
                "limit their number with `cull_up_to`, or take them in portions with `cull_in_portions`"
            }
            Self::TooManyPairs { .. } => {
                "raise the limit, or take the pairs in portions with `cull_in_portions`"
            }
            Self::Changed { .. } => {
                "call `Culler::refresh` after a change of the set or of a shape, or keep the bodies in a `World`"
            }
        }
    }
}
