//! Studies: what is counted, predicted, estimated and reproduced.

mod accounts;
mod cost;
#[path = "support/drawn_pairs.rs"]
mod drawn_pairs;
mod known_answers;
mod reproduce;
mod tradeoff;
