//! What a culler refuses.

use miette::Diagnostic;
use thiserror::Error;

use crate::bodies::contract::ContractError;
use crate::settings::SettingsError;
use crate::threads::ThreadsError;

/// A culler that can't be made, or a frame that can't be culled.
#[derive(Clone, Debug, PartialEq, Error, Diagnostic)]
pub enum CullError {
    /// A body or shape outside of the contract.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Contract(#[from] ContractError),
    /// Settings that can't be carried out.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Settings(#[from] SettingsError),
    /// Threads that the system refuses to start.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Threads(#[from] ThreadsError),
    /// More pairs than the caller allows.
    #[error("{pairs} pairs, and at most {limit} are allowed")]
    #[diagnostic(help("raise the limit, or take the pairs in portions with `cull_in_portions`"))]
    TooManyPairs {
        /// How many pairs the frame has.
        pairs: u64,
        /// How many it may have.
        limit: usize,
    },
    /// Another set of bodies than the culler was made for.
    #[error("{what}: a culler keeps the set of bodies that it was made for")]
    #[diagnostic(help(
        "call `Culler::refresh` after a change of the set, or keep the bodies in a `World`"
    ))]
    Changed {
        /// What has changed.
        what: String,
    },
}
