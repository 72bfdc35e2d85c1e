//! Studies: what is counted, predicted, estimated and reproduced.

mod accounts;
mod cost;
mod known_answers;
mod reproduce;
