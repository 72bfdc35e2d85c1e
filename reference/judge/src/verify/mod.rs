//! Judges our culler: in each configuration ([`run`]), over rounds of seeds and hard cases
//! ([`rounds`]), and as a subject like any other program ([`subject`]).

pub mod ledger;
pub mod rounds;
pub mod run;
pub mod subject;

pub use ledger::{Failure, Ledger, LedgerKey};
pub use run::{RoundError, Run};
