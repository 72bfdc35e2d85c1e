//! The same predicates decided in exact real arithmetic.

pub mod polytope;
