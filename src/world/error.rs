//! What a world refuses.

use miette::Diagnostic;
use thiserror::Error;

use super::BodyId;
use crate::bodies::contract::ContractError;
use crate::settings::SettingsError;

/// A request that a world can't carry out. The world is as it was before.
#[derive(Clone, Debug, PartialEq, Error, Diagnostic)]
pub enum WorldError {
    /// The body has been removed.
    #[error("body {0} is no longer in this world")]
    #[diagnostic(help("it was removed; ids are never given again"))]
    Gone(BodyId),
    /// A number of the body is outside of the contract.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Contract(#[from] ContractError),
    /// Culling settings that can't be carried out.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Settings(#[from] SettingsError),
    /// Bodies too far from each other to be culled about one origin.
    #[error("bodies lie farther apart than 2^60: {0} is out of reach of the others")]
    #[diagnostic(help("keep separate worlds for what can't meet"))]
    Apart(BodyId),
}
