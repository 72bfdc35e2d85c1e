//! One world on many ranks, each a process that holds a part of the bodies, for worlds that exceed
//! one machine.
//!
//! Space is cut into one cell per rank (`cut`). A rank owns the bodies whose ball's centre lies in
//! its cell. It has copies of the other ranks' bodies that these may meet, its ghosts (`ghosts`, by
//! the reach of [`rounding::border`](sdop::rounding::border)), and culls both with the library's
//! [`Culler`](sdop::Culler). A pair is reported by the owner of the body with the smaller reach, or
//! with the lower number if both reaches are equal; both ranks have these numbers to the bit. Every
//! verdict is a function of the two bodies alone, the lower number first, so any number of ranks
//! together reports the pairs of one process.
//!
//! Owners, ghosts and the culler's set of bodies stay while no body has drifted by more than a
//! skin; in between, only ghosts' poses travel. Then bodies migrate to their new owners, and if
//! ranks have too unequal numbers of bodies, space is cut again.
//!
//! ```text
//!  step ──▶ drift? ──▶ poses of ghosts ──────────────▶ cull ──▶ own pairs
//!              │                                         ▲
//!              ╰─▶ cut where unequal ─▶ migrate ─▶ ghosts ╯
//! ```
//!
//! Ranks reach one another by a [`Network`](crate::network::Network): MPI, or threads of one
//! process, which tests use.

mod body_columns;
mod cut;
mod error;
mod float_key;
mod ghosts;
mod rank;
mod renew;
mod run;

pub use cut::Cuts;
pub use error::DomainError;
pub use rank::BorderSeconds;
pub use rank::{Rank, RankFrame};
pub use run::{DomainSummary, RankLine, RankSeconds, run};
