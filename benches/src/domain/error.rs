//! Errors on one of many ranks, and how they are sent to the others.

use miette::Diagnostic;
use thiserror::Error;

use crate::network::{Network, tell_all};
use crate::simulate::SimulationError;

/// Why a scene can't be run, or run on, on many ranks.
#[derive(Debug, Error, Diagnostic)]
pub enum DomainError {
    /// What depends on the whole scene at once.
    #[error("{what} on {ranks} ranks")]
    Unsupported {
        /// What the scene needs.
        what: String,
        /// How many ranks there are.
        ranks: usize,
        /// How to mend it.
        #[help]
        hint: &'static str,
    },
    /// As in one process.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Simulation(#[from] SimulationError),
    /// Another rank's trouble.
    #[error("rank {rank}: {message}")]
    Elsewhere {
        /// The first rank in trouble.
        rank: usize,
        /// Its message.
        message: String,
    },
}

/// The outcome on which all ranks agree (an error of one is an error of all), and the largest
/// `number` of all ranks. All ranks have to call it.
pub(super) fn agree<T>(
    network: &impl Network,
    outcome: Result<T, DomainError>,
    number: u64,
) -> Result<(T, u64), DomainError> {
    let mut numbers = [u64::from(outcome.is_err()), number];
    network.max(&mut numbers);
    if numbers[0] == 0
        && let Ok(value) = outcome
    {
        return Ok((value, numbers[1]));
    }
    let message = outcome.as_ref().err().map(ToString::to_string);
    let messages = tell_all(network, message.unwrap_or_default().as_bytes());
    outcome.and_then(|_| {
        let rank = messages.iter().position(|message| !message.is_empty());
        let rank = rank.unwrap_or_default();
        let message = String::from_utf8_lossy(&messages[rank]).into_owned();
        Err(DomainError::Elsewhere { rank, message })
    })
}
