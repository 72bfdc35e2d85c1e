//! The arithmetic: error bounds hold on all inputs of small formats, and on the worst that a search
//! finds.

mod arithmetic;
#[path = "support/limit.rs"]
mod limit;
mod worst_case;
