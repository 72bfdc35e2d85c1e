//! The promise: the culler reports every pair that the reference finds, in every configuration.

mod against_reference;
mod crowds;
mod finders;
mod fp_mode;
mod hard_cases;
mod misuse;
mod naive_margins;
mod near_misses;
mod settings;
mod support;
